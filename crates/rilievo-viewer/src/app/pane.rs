//! One of the two pictures that lie side by side.

use std::sync::Arc;

use eframe::egui::{self, TextureHandle, TextureId, TextureOptions};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu::FilterMode;
use rilievo::color::Picture;
use rilievo_gpu::Renderer;
use web_time::{Duration, Instant};

use super::Engine;
use super::pace::Pace;
use crate::canvas::{CpuSide, GpuSide, Set, Times};
use crate::look::{Look, Way};
use crate::subject::Subject;

/// What a picture was drawn of.
#[derive(PartialEq)]
struct Drawn {
    look: Look,
    size: (u32, u32),
    engine: Engine,
}

/// A way of drawing with its picture.
#[derive(Default)]
pub(super) struct Pane {
    set: Option<Arc<Set>>,
    /// Why there is none.
    pub(super) why_not: Option<String>,
    gpu: GpuSide,
    cpu: CpuSide,
    texture: Option<TextureId>,
    handle: Option<TextureHandle>,
    drawn: Option<Drawn>,
    /// What the last frame of each engine took.
    times: [Option<Times>; 2],
    /// Seconds from frame to frame, of each engine.
    paces: [Pace; 2],
}

impl Pane {
    /// Makes what the way needs of the subject, unless it is there.
    pub(super) fn prepare(&mut self, subject: &Arc<Subject>, look: &Look, way: Way, size: (u32, u32)) {
        if self.set.as_ref().is_some_and(|set| set.fits(subject, look, way)) {
            return;
        }
        self.drawn = None;
        self.forget_times();
        match Set::new(subject, look, way, size) {
            Ok(set) => (self.set, self.why_not) = (Some(Arc::new(set)), None),
            Err(why) => (self.set, self.why_not) = (None, Some(why)),
        }
    }

    /// Whether the picture shows something else than it should.
    fn is_stale(&mut self, look: &Look, size: (u32, u32), engine: Engine) -> bool {
        // Where the two pictures meet, and what the other one is, does not matter to this one.
        let look = Look { other: None, ..look.clone() };
        let now = Drawn { look, size, engine };
        if self.drawn.as_ref().is_some_and(|d| d.size != size || d.look.filter != now.look.filter) {
            self.forget_times();
        }
        let stale = self.drawn.as_ref() != Some(&now);
        if !stale {
            self.paces[engine as usize].rested();
        }
        self.drawn = Some(now);
        stale
    }

    /// Draws a frame if need be; says whether it did.
    pub(super) fn draw_on_gpu(
        &mut self,
        renderer: &Renderer,
        state: &RenderState,
        look: &Look,
        size: (u32, u32),
    ) -> Result<bool, rilievo_gpu::Error> {
        renderer.gpu().check()?;
        let Some(set) = self.set.clone() else { return Ok(false) };
        if !self.is_stale(look, size, Engine::Gpu) {
            if let Some(times) = &mut self.times[Engine::Gpu as usize] {
                times.draw = self.gpu.draw_time(renderer);
            }
            return Ok(false);
        }
        let drawn = self.gpu.draw(renderer, &set, look, size);
        let (times, is_new) = match drawn {
            Ok(drawn) => drawn,
            // The GPU is well, but does not do this: the picture stays away and says why.
            Err(error @ (rilievo_gpu::Error::Unsupported { .. } | rilievo_gpu::Error::Limit { .. })) => {
                (self.why_not, self.set) = (Some(error.to_string()), None);
                return Ok(false);
            }
            Err(error) => return Err(error),
        };
        self.took(Engine::Gpu, times);
        if let Some(target) = self.gpu.target().filter(|_| is_new || self.texture.is_none()) {
            let mut shown = state.renderer.write();
            match self.texture {
                Some(id) => {
                    shown.update_egui_texture_from_wgpu_texture(&state.device, target.view(), FilterMode::Nearest, id);
                }
                None => {
                    let id = shown.register_native_texture(&state.device, target.view(), FilterMode::Nearest);
                    self.texture = Some(id);
                }
            }
        }
        self.handle = None;
        Ok(true)
    }

    /// Draws a frame if need be; says whether it did.
    pub(super) fn draw_on_cpu(&mut self, context: &egui::Context, look: &Look, size: (u32, u32)) -> bool {
        let Some(set) = self.set.clone() else { return false };
        if !self.is_stale(look, size, Engine::Cpu) {
            return false;
        }
        match self.cpu.draw(&set, look, size) {
            Ok(times) => self.took(Engine::Cpu, times),
            Err(why) => {
                (self.why_not, self.set) = (Some(why), None);
                return false;
            }
        }
        let Some(picture) = self.cpu.picture() else { return false };
        let bytes = bytemuck::cast_slice(picture.texels());
        let image = egui::ColorImage::from_rgba_unmultiplied([size.0 as usize, size.1 as usize], bytes);
        match &mut self.handle {
            Some(handle) => handle.set(image, TextureOptions::NEAREST),
            None => self.handle = Some(context.load_texture("picture", image, TextureOptions::NEAREST)),
        }
        true
    }

    /// A frame was drawn.
    fn took(&mut self, engine: Engine, times: Times) {
        self.times[engine as usize] = Some(times);
        self.paces[engine as usize].drawn(Instant::now());
    }

    fn forget_times(&mut self) {
        self.times = [None; 2];
        self.paces.iter_mut().for_each(Pace::forget);
    }

    /// What a frame takes an engine, in words; nothing until it has drawn one of this picture.
    pub(super) fn figures(&self, engine: Engine) -> Option<String> {
        let times = self.times[engine as usize].as_ref()?;
        let milliseconds = |time: Duration| format!("{:.2} ms", time.as_secs_f64() * 1e3);
        let mut parts = Vec::new();
        if engine == Engine::Gpu {
            let kilobytes = times.bytes as f64 / 1e3;
            parts.push(format!("table and upload {}, {kilobytes:.1} kB", milliseconds(times.table)));
        }
        parts.extend(times.draw.map(|time| format!("drawn in {}", milliseconds(time))));
        parts.extend(self.paces[engine as usize].frame().map(|time| format!("a frame each {}", milliseconds(time))));
        Some(format!("{}: {}", engine.name(), parts.join(", ")))
    }

    /// What to show.
    pub(super) fn texture(&self) -> Option<TextureId> {
        self.set.as_ref()?;
        self.handle.as_ref().map(TextureHandle::id).or(self.texture)
    }

    /// What is shown, to be read later.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn parts(&self, engine: Engine) -> (Option<rilievo_gpu::Target>, Option<Picture>) {
        match engine {
            Engine::Cpu => (None, self.cpu.picture().cloned()),
            Engine::Gpu => (self.gpu.target().cloned(), None),
        }
    }

    /// The pixels of what is shown.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) async fn picture(&self, engine: Engine) -> Option<Picture> {
        self.set.as_ref()?;
        match engine {
            Engine::Cpu => self.cpu.picture().cloned(),
            Engine::Gpu => self.gpu.picture().await.ok(),
        }
    }
}
