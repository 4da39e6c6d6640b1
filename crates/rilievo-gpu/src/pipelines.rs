//! The shaders, and one pipeline for each method and way of culling.

use std::cell::RefCell;
use std::collections::HashMap;

use crate::device::Gpu;
use crate::load::Vertex;
use crate::method::Stages;
use crate::target::{COLOR, DEPTH};
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BufferBindingType, ColorTargetState,
    ColorWrites, CompareFunction, DepthBiasState, DepthStencilState, Face, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, PrimitiveState, RenderPipeline,
    RenderPipelineDescriptor, SamplerBindingType, ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages,
    StencilState, TextureSampleType, TextureViewDimension, VertexBufferLayout, VertexState, VertexStepMode,
    vertex_attr_array,
};

/// WGSL has no way to include a file: the rooms of the shader, one after the other.
const SHADER: &str = concat!(
    include_str!("shader/scene.wgsl"),
    include_str!("shader/map.wgsl"),
    include_str!("shader/light.wgsl"),
    include_str!("shader/gather.wgsl"),
    include_str!("shader/table.wgsl"),
    include_str!("shader/baked.wgsl"),
    include_str!("shader/exact.wgsl"),
    include_str!("shader/vectors.wgsl"),
    include_str!("shader/polar.wgsl"),
);

/// What a binding of the shader takes; its number is the place in [`BINDINGS`].
#[derive(Clone, Copy)]
enum Binding {
    Uniforms,
    Integers,
    /// 32-bit floats, or such as are only looked up.
    Floats,
    Filtered,
    Sampler,
}

/// The group that all methods share: what one of them does not read is one texel.
const BINDINGS: [(Binding, ShaderStages); 14] = {
    use Binding::{Filtered, Floats, Integers, Sampler, Uniforms};
    const BOTH: ShaderStages = ShaderStages::VERTEX_FRAGMENT;
    const PIXEL: ShaderStages = ShaderStages::FRAGMENT;
    const VERTEX: ShaderStages = ShaderStages::VERTEX;
    [
        (Uniforms, BOTH),
        (Integers, PIXEL),
        (Integers, PIXEL),
        (Floats, BOTH),
        (Floats, PIXEL),
        (Filtered, PIXEL),
        (Filtered, PIXEL),
        (Filtered, PIXEL),
        (Floats, PIXEL),
        (Integers, PIXEL),
        (Floats, PIXEL),
        (Sampler, PIXEL),
        (Floats, VERTEX),
        (Integers, VERTEX),
    ]
};

impl Binding {
    fn kind(self) -> BindingType {
        let texture = |sample_type| BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        match self {
            Self::Uniforms => BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            Self::Integers => texture(TextureSampleType::Uint),
            Self::Floats => texture(TextureSampleType::Float { filterable: false }),
            Self::Filtered => texture(TextureSampleType::Float { filterable: true }),
            Self::Sampler => BindingType::Sampler(SamplerBindingType::Filtering),
        }
    }
}

/// Pipelines, made when they are first asked for.
pub(crate) struct Pipelines {
    module: ShaderModule,
    pub(crate) group: BindGroupLayout,
    layout: PipelineLayout,
    made: RefCell<HashMap<(Stages, bool), RenderPipeline>>,
}

impl Pipelines {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let source = ShaderSource::Wgsl(SHADER.into());
        let module = gpu.device.create_shader_module(ShaderModuleDescriptor { label: Some("rilievo"), source });
        let entries: Vec<BindGroupLayoutEntry> = BINDINGS
            .iter()
            .zip(0..)
            .map(|(&(kind, visibility), binding)| BindGroupLayoutEntry {
                binding,
                visibility,
                ty: kind.kind(),
                count: None,
            })
            .collect();
        let group = gpu.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &entries });
        let layout = gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&group)],
            ..PipelineLayoutDescriptor::default()
        });
        Self { module, group, layout, made: RefCell::default() }
    }

    pub(crate) fn get(&self, gpu: &Gpu, stages: Stages, double_sided: bool) -> RenderPipeline {
        let make = || self.make(gpu, stages, double_sided);
        self.made.borrow_mut().entry((stages, double_sided)).or_insert_with(make).clone()
    }

    fn make(&self, gpu: &Gpu, stages: Stages, double_sided: bool) -> RenderPipeline {
        let (vertex, fragment) = stages.entry_points();
        let attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2];
        let buffer = VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let buffers: &[Option<VertexBufferLayout<'_>>] = if stages.pulls_vertices() { &[] } else { &[Some(buffer)] };
        gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&self.layout),
            vertex: VertexState {
                module: &self.module,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers,
            },
            primitive: PrimitiveState { cull_mode: (!double_sided).then_some(Face::Back), ..PrimitiveState::default() },
            depth_stencil: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                // Of two surfaces at the same depth the first stays, as on the CPU.
                depth_compare: Some(CompareFunction::Less),
                stencil: StencilState::default(),
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(ColorTargetState { format: COLOR, blend: None, write_mask: ColorWrites::ALL })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
