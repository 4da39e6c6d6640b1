//! The scene on the first Vulkan driver that wgpu finds: a software GPU, chosen by the environment of the process.

use super::renderer::{Job, Renderer, Sampling, Shading, unpack};
use super::scene::{self, ENTRIES, MAP_SIDE, REPEAT, SIDE, Size, Subject, View};
use anyhow::{Context, Result, anyhow, bail};
use rilievo::color::Picture;
use std::collections::HashMap;
use wgpu::*;

/// Width of the texture that holds the table; the shader knows it.
const TABLE_WIDTH: u32 = 128;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniforms {
    view_projection: [[f32; 4]; 4],
    eye: [f32; 4],
    light: [f32; 4],
    ambient: [f32; 4],
    diffuse: [f32; 4],
    specular: [f32; 4],
    repeat: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    uv: [f32; 2],
}

/// A subject in the memory of the GPU.
struct Loaded {
    subject: &'static Subject,
    vertices: Buffer,
    indices: Buffer,
    index_count: u32,
    normals: TextureView,
    /// Made for the first frame by table.
    index_map: Option<TextureView>,
}

/// A job for a view, ready to be drawn.
struct Prepared {
    pipeline: RenderPipeline,
    bindings: BindGroup,
    /// Colours are encoded by the target, or come encoded out of the table.
    encode: bool,
}

pub(super) struct Vulkan {
    device: Device,
    queue: Queue,
    shader: ShaderModule,
    name: String,
    /// With and without encoding to sRGB.
    targets: [Texture; 2],
    views: [TextureView; 2],
    depth: TextureView,
    subjects: HashMap<Size, Loaded>,
    prepared: HashMap<(Job, usize), Prepared>,
    last: usize,
}

impl Vulkan {
    pub(super) fn new() -> Result<Self> {
        let mut about = InstanceDescriptor::new_without_display_handle();
        about.backends = Backends::VULKAN;
        about.flags = InstanceFlags::empty();
        let instance = Instance::new(about);
        let adapter = pollster::block_on(instance.request_adapter(&RequestAdapterOptions::default()))?;
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&DeviceDescriptor::default()))?;
        let source = ShaderSource::Wgsl(include_str!("shader.wgsl").into());
        let shader = device.create_shader_module(ShaderModuleDescriptor { label: None, source });
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let targets = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm]
            .map(|format| device.create_texture(&texture((SIDE, SIDE), format, usage)));
        let depth = device.create_texture(&texture((SIDE, SIDE), TextureFormat::Depth32Float, usage));
        Ok(Self {
            name: format!("{} ({} {})", info.name, info.driver, info.driver_info),
            views: targets.each_ref().map(|t| t.create_view(&TextureViewDescriptor::default())),
            depth: depth.create_view(&TextureViewDescriptor::default()),
            device,
            queue,
            shader,
            targets,
            subjects: HashMap::new(),
            prepared: HashMap::new(),
            last: 0,
        })
    }

    /// The adapter and its driver.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    fn buffer(&self, data: &[u8], usage: BufferUsages) -> Buffer {
        let usage = usage | BufferUsages::COPY_DST;
        let about = BufferDescriptor { label: None, size: data.len() as u64, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&about);
        self.queue.write_buffer(&buffer, 0, data);
        buffer
    }

    fn upload(&self, size: (u32, u32), format: TextureFormat, data: &[u8]) -> TextureView {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let made = self.device.create_texture(&texture(size, format, usage));
        let bytes_per_row = Some(data.len() as u32 / size.1);
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        self.queue.write_texture(made.as_image_copy(), data, layout, made.size());
        made.create_view(&TextureViewDescriptor::default())
    }

    fn load(&mut self, size: Size) -> Result<()> {
        if self.subjects.contains_key(&size) {
            return Ok(());
        }
        let subject = Subject::get(size)?;
        let mesh = &subject.mesh;
        let vertices: Vec<Vertex> = (0..mesh.positions().len())
            .map(|i| Vertex {
                position: mesh.positions()[i].to_array(),
                normal: mesh.normals()[i].to_array(),
                tangent: mesh.tangents()[i].to_array(),
                uv: mesh.uvs()[i].to_array(),
            })
            .collect();
        let triangles = mesh.triangles().as_flattened();
        let codes: Vec<[u8; 4]> = subject.maps.codes.texels().iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
        let loaded = Loaded {
            vertices: self.buffer(bytemuck::cast_slice(&vertices), BufferUsages::VERTEX),
            indices: self.buffer(bytemuck::cast_slice(triangles), BufferUsages::INDEX),
            index_count: triangles.len() as u32,
            normals: self.upload((MAP_SIDE, MAP_SIDE), TextureFormat::Rgba8Unorm, codes.as_flattened()),
            index_map: None,
            subject,
        };
        self.subjects.insert(size, loaded);
        Ok(())
    }

    fn load_index_map(&mut self, size: Size) -> Result<()> {
        self.load(size)?;
        let loaded = self.subjects.get(&size).context("not loaded")?;
        if loaded.index_map.is_none() {
            let texels = loaded.subject.indexed()?.base().texels();
            let map = self.upload((MAP_SIDE, MAP_SIDE), TextureFormat::R16Uint, bytemuck::cast_slice(texels));
            self.subjects.get_mut(&size).context("not loaded")?.index_map = Some(map);
        }
        Ok(())
    }

    fn prepare(&mut self, job: Job, number: usize) -> Result<()> {
        if self.prepared.contains_key(&(job, number)) {
            return Ok(());
        }
        if job.shading == Shading::Table {
            self.load_index_map(job.size)?;
        } else {
            self.load(job.size)?;
        }
        let loaded = self.subjects.get(&job.size).context("not loaded")?;
        let view = View::new(number)?;
        let view = if job.dark { view.dark() } else { view };
        let [ambient, diffuse, specular] = scene::light_colors();
        let uniforms = Uniforms {
            view_projection: view.view_projection().to_cols_array_2d(),
            eye: view.camera.eye().extend(1.0).to_array(),
            light: view.light.extend(1.0).to_array(),
            ambient,
            diffuse,
            specular,
            repeat: [REPEAT.x, REPEAT.y, MAP_SIDE as f32, 0.0],
        };
        let (vertex, fragment) = match job.shading {
            Shading::Exact => ("vertex_exact", "fragment_exact"),
            Shading::Normalized => ("vertex_normalized", "fragment_normalized"),
            Shading::Quadratic => bail!("quadratic vectors need the midpoints of triangles, which shaders do not see"),
            Shading::Table => ("vertex_plain", "fragment_index"),
            Shading::Flat => ("vertex_plain", "fragment_flat"),
        };
        let encode = job.shading != Shading::Table;
        let pipeline = self.pipeline((vertex, fragment), self.targets[usize::from(!encode)].format());

        let uniforms = self.buffer(bytemuck::bytes_of(&uniforms), BufferUsages::UNIFORM);
        let mut entries = vec![BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }];
        let filter = match job.sampling {
            Sampling::Nearest => FilterMode::Nearest,
            Sampling::Bilinear => FilterMode::Linear,
        };
        let wrapped = AddressMode::Repeat;
        let sampler = self.device.create_sampler(&SamplerDescriptor {
            address_mode_u: wrapped,
            address_mode_v: wrapped,
            mag_filter: filter,
            min_filter: filter,
            ..SamplerDescriptor::default()
        });
        let colors = if job.shading == Shading::Table {
            let mut colors = loaded.subject.lit_table(&view)?;
            colors.resize(ENTRIES as usize, rilievo::Rgba8::default());
            let size = (TABLE_WIDTH, ENTRIES / TABLE_WIDTH);
            Some(self.upload(size, TextureFormat::Rgba8Unorm, bytemuck::cast_slice(&colors)))
        } else {
            None
        };
        let texture = |binding, view| BindGroupEntry { binding, resource: BindingResource::TextureView(view) };
        match (job.shading, &loaded.index_map, &colors) {
            (Shading::Exact | Shading::Normalized | Shading::Quadratic, ..) => {
                entries.push(texture(1, &loaded.normals));
                entries.push(BindGroupEntry { binding: 2, resource: BindingResource::Sampler(&sampler) });
            }
            (Shading::Table, Some(map), Some(colors)) => {
                entries.extend([texture(3, map), texture(4, colors)]);
            }
            _ => {}
        }
        let layout = &pipeline.get_bind_group_layout(0);
        let bindings = self.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries });
        self.prepared.insert((job, number), Prepared { pipeline, bindings, encode });
        Ok(())
    }

    fn pipeline(&self, (vertex, fragment): (&str, &str), format: TextureFormat) -> RenderPipeline {
        let attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2];
        let buffers = [Some(VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let target = ColorTargetState { format, blend: None, write_mask: ColorWrites::ALL };
        self.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: VertexState {
                module: &self.shader,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: PrimitiveState { cull_mode: Some(Face::Back), ..PrimitiveState::default() },
            depth_stencil: Some(DepthStencilState {
                format: TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(CompareFunction::Less),
                stencil: StencilState::default(),
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &self.shader,
                entry_point: Some(fragment),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn wait(&self) -> Result<()> {
        self.device.poll(PollType::wait_indefinitely())?;
        Ok(())
    }
}

fn texture((width, height): (u32, u32), format: TextureFormat, usage: TextureUsages) -> TextureDescriptor<'static> {
    TextureDescriptor {
        label: None,
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: if format == TextureFormat::Depth32Float { TextureUsages::RENDER_ATTACHMENT } else { usage },
        view_formats: &[],
    }
}

impl Renderer for Vulkan {
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()> {
        self.prepare(job, view)?;
        let prepared = self.prepared.get(&(job, view)).context("not prepared")?;
        let loaded = self.subjects.get(&job.size).context("not loaded")?;
        self.last = usize::from(!prepared.encode);
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
        for _ in 0..frames {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                color_attachments: &[Some(RenderPassColorAttachment {
                    view: &self.views[self.last],
                    depth_slice: None,
                    resolve_target: None,
                    ops: Operations { load: LoadOp::Clear(Color::TRANSPARENT), store: StoreOp::Store },
                })],
                depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                    view: &self.depth,
                    depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Discard }),
                    stencil_ops: None,
                }),
                ..RenderPassDescriptor::default()
            });
            pass.set_pipeline(&prepared.pipeline);
            pass.set_bind_group(0, &prepared.bindings, &[]);
            pass.set_vertex_buffer(0, loaded.vertices.slice(..));
            pass.set_index_buffer(loaded.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..loaded.index_count, 0, 0..1);
        }
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    fn picture(&mut self) -> Result<Picture> {
        let bytes_per_row = SIDE * 4;
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let size = u64::from(bytes_per_row) * u64::from(SIDE);
        let buffer =
            self.device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let target = &self.targets[self.last];
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes_per_row), rows_per_image: None };
        let to = TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(target.as_image_copy(), to, target.size());
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(MapMode::Read, |_| {});
        self.wait()?;
        let bytes = buffer.slice(..).get_mapped_range().map_err(|e| anyhow!("cannot read the picture: {e}"))?;
        let packed: Vec<u32> = bytes.chunks_exact(4).map(|p| u32::from_le_bytes([p[0], p[1], p[2], p[3]])).collect();
        unpack(SIDE, &packed)
    }
}
