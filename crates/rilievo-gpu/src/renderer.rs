//! From a scene to a picture.

use crate::device::Gpu;
use crate::error::{Error, Result};
use crate::load::{Blank, LoadedObject};
use crate::method::Method;
use crate::pipelines::Pipelines;
use crate::target::Target;
use crate::timer::Timer;
use rilievo::Rgba8;
use rilievo::raster::{self, Scene, TextureFilter};
use std::time::Duration;
use wgpu::{
    Color, CommandEncoderDescriptor, LoadOp, Operations, RenderPassColorAttachment, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, StoreOp,
};

/// Draws scenes. One for a device; pipelines are made when a method is first drawn.
pub struct Renderer {
    gpu: Gpu,
    pipelines: Pipelines,
    blank: Blank,
}

/// The objects of a scene in the memory of the GPU, for one method and filter.
///
/// Meshes and maps stay; lights, materials, poses and the camera are those of the last [`Renderer::update`].
pub struct Loaded {
    method: Method,
    filter: TextureFilter,
    objects: Vec<LoadedObject>,
    timer: Option<Timer>,
    ready: bool,
}

impl Loaded {
    /// How it is drawn.
    pub fn method(&self) -> Method {
        self.method
    }

    /// How texels are gathered.
    pub fn filter(&self) -> TextureFilter {
        self.filter
    }
}

/// What a frame sent to the GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Uploaded {
    /// Bytes of all objects together.
    pub bytes: u64,
}

impl Renderer {
    /// A renderer on a device.
    pub fn new(gpu: &Gpu) -> Self {
        Self { gpu: gpu.clone(), pipelines: Pipelines::new(gpu), blank: Blank::new(gpu) }
    }

    /// The device it draws on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Sends the meshes and maps of a scene to the GPU.
    ///
    /// # Errors
    /// As [`raster::prepare`]; [`Error::Unsupported`] for what only the CPU draws; [`Error::Limit`] if a map or mesh is larger
    /// than the device holds.
    pub fn load(&self, scene: &Scene<'_>, method: Method, filter: TextureFilter) -> Result<Loaded> {
        self.gpu.check()?;
        // What is wrong with a scene is wrong on any renderer, and said in the same words.
        raster::prepare(scene, method.on_cpu(), filter)?;
        method.check(scene)?;
        let load = |object| LoadedObject::new(&self.gpu, scene, object, (method, filter));
        let objects = scene.objects.iter().map(load).collect::<Result<_>>()?;
        Ok(Loaded { method, filter, objects, timer: Timer::new(&self.gpu), ready: false })
    }

    /// Lights a frame: tables, lights, materials where they changed, poses and the camera go to the GPU.
    ///
    /// `scene` has the meshes and maps that were loaded, and `size` is that of the picture in pixels.
    ///
    /// # Errors
    /// [`Error::Changed`] if it has others, and as [`Renderer::load`].
    pub fn update(&self, loaded: &mut Loaded, scene: &Scene<'_>, size: (u32, u32)) -> Result<Uploaded> {
        self.gpu.check()?;
        if loaded.objects.len() != scene.objects.len() {
            return Err(Error::Changed("it has another number of objects"));
        }
        loaded.method.check(scene)?;
        let mut uploaded = Uploaded::default();
        let how = (loaded.method, loaded.filter);
        for (loaded, object) in loaded.objects.iter_mut().zip(&scene.objects) {
            let shared = (&self.blank, &self.pipelines.group);
            uploaded.bytes += loaded.update(&self.gpu, shared, (scene, object), how, size)?;
        }
        loaded.ready = true;
        Ok(uploaded)
    }

    /// Draws what was last updated over all of the target; `background`, encoded, shows where there is nothing.
    ///
    /// # Panics
    /// Before the first [`Renderer::update`].
    pub fn draw(&self, loaded: &Loaded, target: &Target, background: Option<Rgba8>) {
        assert!(loaded.ready, "Renderer::update comes before the first frame");
        let channel = |v: u8| f64::from(v) / 255.0;
        let clear = background.map_or(Color::TRANSPARENT, |c| Color {
            r: channel(c.r),
            g: channel(c.g),
            b: channel(c.b),
            a: channel(c.a),
        });
        // One that still waits for its answer measures nothing.
        let timer = loaded.timer.as_ref().filter(|timer| timer.writes().is_some());
        let mut encoder = self.gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &target.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(clear), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &target.depth_view,
                depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: timer.and_then(Timer::writes),
            ..RenderPassDescriptor::default()
        });
        for object in &loaded.objects {
            pass.set_pipeline(&self.pipelines.get(&self.gpu, loaded.method.stages(), object.double_sided));
            object.draw(&mut pass);
        }
        drop(pass);
        if let Some(timer) = timer {
            timer.resolve(&mut encoder);
        }
        self.gpu.queue.submit([encoder.finish()]);
        if let Some(timer) = timer {
            timer.ask();
        }
    }

    /// How long the GPU drew the last frame of a scene that it has told about; none where it cannot tell.
    pub fn draw_time(&self, loaded: &Loaded) -> Option<Duration> {
        let timer = loaded.timer.as_ref()?;
        self.gpu.poll();
        timer.last()
    }
}
