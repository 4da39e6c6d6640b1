//! Objects in the memory of the GPU.

mod expansion;
mod geometry;
mod maps;

use std::sync::Arc;

use rilievo::Edges;
use rilievo::light::{Blend, Environment, Material, ShadeTable};
use rilievo::raster::{self, Detail, LitTables, Object, Scene, TextureFilter};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Buffer, BufferDescriptor,
    BufferUsages, Sampler, Texture, TextureFormat, TextureView,
};

use self::expansion::Expansion;
use self::geometry::Geometry;
pub(crate) use self::geometry::Vertex;
use self::maps::{
    color_texture, index_texture, kind_texture, normal_list, normal_texture, sampler, shade_texture, word_texture,
};
use crate::device::Gpu;
use crate::error::{Error, Result};
use crate::frame::{Uniforms, light_texels, material_texels, polar_words};
use crate::method::{Method, Stages};
use crate::texture::{self, List, view};
use crate::words::pack_all;

/// Stand-ins for what a method does not read: one texel each.
pub(crate) struct Blank {
    integers: TextureView,
    floats: TextureView,
}

impl Blank {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let one = |format, bytes: &[u8]| {
            let made = texture::create(gpu, (1, 1), 1, format);
            texture::write(gpu, &made, 0, (1, 1), bytes);
            view(&made)
        };
        Self { integers: one(TextureFormat::R8Uint, &[0]), floats: one(TextureFormat::Rgba8Unorm, &[0; 4]) }
    }
}

/// One object and everything of it that a frame reads.
pub(crate) struct LoadedObject {
    geometry: Geometry,
    pub(crate) corner_count: u32,
    pub(crate) double_sided: bool,
    /// What the scene must still have.
    shape: Shape,
    uniforms: Buffer,
    sampler: Sampler,
    indices: Option<Texture>,
    relief: Option<Texture>,
    gloss: Option<Texture>,
    base: Option<Texture>,
    kinds: Option<Texture>,
    normals: Option<List>,
    expansion: Option<Expansion>,
    lights: List,
    materials: List,
    table: Option<List>,
    /// The words of the table, kept for their room.
    words: Vec<[u32; 2]>,
    /// What is in `materials` and in a unit's tables.
    known_materials: Vec<Material>,
    known_uniforms: Option<Uniforms>,
    surroundings: Option<(Arc<Environment>, Texture, Vec<[u32; 4]>)>,
    pub(crate) bindings: Option<BindGroup>,
}

/// What tells one loaded object from another.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shape {
    vertices: usize,
    triangles: usize,
    map: (u32, u32),
    entries: usize,
    base: (u32, u32),
    edges: Edges,
    double_sided: bool,
}

impl Shape {
    fn new(object: &Object<'_>) -> Self {
        let (map, entries) = match object.detail {
            Detail::Smooth => ((0, 0), 0),
            Detail::Tangent { normals, .. } => (normals.base().size(), 0),
            Detail::Object { normals, .. } => (normals.base().size(), 0),
            Detail::Indexed(map) => (map.base().size(), map.table().len()),
            Detail::Bump { map, .. } => (map.words().base().size(), 0),
            Detail::Baked(levels) => (levels.base().size(), 0),
        };
        Self {
            vertices: object.mesh.positions().len(),
            triangles: object.mesh.triangles().len(),
            map,
            entries,
            base: object.base_color.map_or((0, 0), |b| b.levels.base().size()),
            edges: object.edges,
            double_sided: object.double_sided,
        }
    }
}

impl LoadedObject {
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &Scene<'_>,
        object: &Object<'_>,
        (method, filter): (Method, TextureFilter),
    ) -> Result<Self> {
        let stages = method.stages();
        let mut indices = None;
        let (mut relief, mut gloss, mut kinds, mut normals, mut expansion) = (None, None, None, None, None);
        match object.detail {
            Detail::Smooth => {}
            Detail::Tangent { normals, materials, .. } => {
                relief = Some(normal_texture(gpu, normals)?);
                kinds = materials.map(|m| kind_texture(gpu, m)).transpose()?;
            }
            Detail::Object { normals, materials } => {
                relief = Some(normal_texture(gpu, normals)?);
                kinds = materials.map(|m| kind_texture(gpu, m)).transpose()?;
            }
            Detail::Bump { map, materials, .. } => {
                indices = Some(word_texture(gpu, map.words())?);
                kinds = materials.map(|m| kind_texture(gpu, m)).transpose()?;
            }
            Detail::Indexed(map) if method == Method::Expanded => {
                let split = object.base_color.is_some() && object.blend != Blend::Material;
                expansion = Some(Expansion::new(gpu, map.indices(), split)?);
            }
            Detail::Indexed(map) => {
                indices = Some(index_texture(gpu, map.indices(), map.table().len())?);
                if stages == Stages::Exact {
                    normals = Some(normal_list(gpu, map.table())?);
                }
            }
            Detail::Baked(levels) => {
                relief = Some(shade_texture(gpu, levels, |s| s.diffuse)?);
                gloss = Some(shade_texture(gpu, levels, |s| s.specular)?);
            }
        }
        let base = object.base_color.map(|b| color_texture(gpu, b.levels)).transpose()?;
        let table = match (stages, object.detail) {
            (Stages::Table, Detail::Indexed(map)) => {
                let sides = if object.double_sided { 2 } else { 1 };
                let entries = map.table().len() * sides;
                Some(List::new(gpu, "a table of shades", entries, TextureFormat::Rg32Uint)?)
            }
            _ => None,
        };
        if method == Method::Expanded && object.double_sided {
            let remedy = "use the table method, or leave back faces out";
            return Err(Error::Unsupported { what: "an expanded light map of both sides".into(), remedy });
        }
        let uniforms = gpu.device.create_buffer(&BufferDescriptor {
            label: None,
            size: size_of::<Uniforms>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Self {
            geometry: Geometry::new(gpu, object.mesh, stages)?,
            corner_count: object.mesh.triangles().len() as u32 * 3,
            double_sided: object.double_sided,
            shape: Shape::new(object),
            uniforms,
            sampler: sampler(gpu, object.edges, filter),
            indices,
            relief,
            gloss,
            base,
            kinds,
            normals,
            expansion,
            lights: light_list(gpu, scene.lighting.lights.len())?,
            materials: List::new(gpu, "materials", 1, TextureFormat::Rgba32Float)?,
            table,
            words: Vec::new(),
            known_materials: Vec::new(),
            known_uniforms: None,
            surroundings: None,
            bindings: None,
        })
    }

    /// Lights the object for a frame; gives the bytes that were sent.
    pub(crate) fn update(
        &mut self,
        gpu: &Gpu,
        (blank, layout): (&Blank, &BindGroupLayout),
        (scene, object): (&Scene<'_>, &Object<'_>),
        (method, filter): (Method, TextureFilter),
        size: (u32, u32),
    ) -> Result<u64> {
        if self.shape != Shape::new(object) {
            return Err(Error::Changed("a mesh, a map or its size is another"));
        }
        let mut bytes = match method.stages() {
            // What is looked up is lit already.
            Stages::Table | Stages::Baked => 0,
            Stages::Exact | Stages::Vectors | Stages::Polar => self.update_lights(gpu, scene, object)?,
        };
        bytes += self.update_materials(gpu, object.materials, method)?;
        bytes += self.update_surroundings(gpu, scene.lighting.environment.as_ref())?;
        let mut first_back = 0;
        if let Detail::Indexed(map) = object.detail
            && (self.table.is_some() || self.expansion.is_some())
        {
            let lit = LitTables::new(object, &scene.lighting, scene.camera.eye())?;
            if let Some(table) = &mut self.table {
                let back = lit.back.as_ref().map_or(&[][..], ShadeTable::entries);
                self.words.clear();
                pack_all(lit.front.entries(), &mut self.words);
                pack_all(back, &mut self.words);
                bytes += table.write(gpu, bytemuck::cast_slice(&self.words));
                first_back = lit.back.as_ref().map_or(0, |_| lit.front.entries().len() as u32);
            }
            if let Some(expansion) = &self.expansion {
                bytes += expansion.write(gpu, map.indices(), &lit.front, object.blend);
            }
        }
        let sky = self.surroundings.as_ref().map_or(&[][..], |s| &s.2);
        let uniforms = Uniforms::new((scene, object), (method, filter), size, first_back, sky)?;
        if self.known_uniforms != Some(uniforms) {
            gpu.queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&uniforms));
            bytes += size_of::<Uniforms>() as u64;
            self.known_uniforms = Some(uniforms);
        }
        if self.bindings.is_none() {
            self.bindings = Some(self.bind(gpu, blank, layout));
        }
        Ok(bytes)
    }

    fn update_lights(&mut self, gpu: &Gpu, scene: &Scene<'_>, object: &Object<'_>) -> Result<u64> {
        let texels = light_texels(&scene.lighting.to_object(&object.pose));
        if !self.lights.holds(texels.len()) {
            self.lights = light_list(gpu, scene.lighting.lights.len())?;
            self.bindings = None;
        }
        Ok(self.lights.write(gpu, bytemuck::cast_slice(&texels)))
    }

    fn update_materials(&mut self, gpu: &Gpu, materials: &[Material], method: Method) -> Result<u64> {
        if self.known_materials == materials {
            return Ok(0);
        }
        let texels = material_texels(materials)?;
        if !self.materials.holds(texels.len()) {
            self.materials = List::new(gpu, "materials", texels.len(), TextureFormat::Rgba32Float)?;
            self.bindings = None;
        }
        let mut bytes = self.materials.write(gpu, bytemuck::cast_slice(&texels));
        if let Method::Scene(raster::Method::Polar { unit, width }) = method {
            let words = polar_words(unit, width, materials);
            let fits = self.table.as_ref().is_some_and(|t| t.holds(words.len()));
            if !fits {
                self.table = Some(List::new(gpu, "a unit's tables", words.len(), TextureFormat::R16Uint)?);
                self.bindings = None;
            }
            bytes += self.table.as_mut().map_or(0, |t| t.write(gpu, bytemuck::cast_slice(&words)));
        }
        self.known_materials = materials.to_vec();
        Ok(bytes)
    }

    fn update_surroundings(&mut self, gpu: &Gpu, environment: Option<&Arc<Environment>>) -> Result<u64> {
        let known = self.surroundings.as_ref().map(|s| &s.0);
        let same = match (known, environment) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        if same {
            return Ok(0);
        }
        self.bindings = None;
        self.surroundings = None;
        let Some(environment) = environment else { return Ok(0) };
        let (texture, places) = texture::surroundings(gpu, environment)?;
        self.surroundings = Some((Arc::clone(environment), texture, places));
        Ok(environment.copies().map(|c| c.texels.len() as u64 * 8).sum())
    }

    fn bind(&self, gpu: &Gpu, blank: &Blank, layout: &BindGroupLayout) -> BindGroup {
        let or = |texture: Option<&Texture>, blank: &TextureView| texture.map_or_else(|| blank.clone(), view);
        let list = |list: Option<&List>, blank: &TextureView| or(list.map(|l| &l.texture), blank);
        let (corners, triangles) = match &self.geometry {
            Geometry::Textures { corners, triangles } => (Some(corners), Some(triangles)),
            Geometry::Buffers { .. } => (None, None),
        };
        let expansion = self.expansion.as_ref();
        let textures = [
            or(self.indices.as_ref(), &blank.integers),
            list(self.table.as_ref(), &blank.integers),
            view(&self.lights.texture),
            view(&self.materials.texture),
            or(self.relief.as_ref().or(expansion.map(|e| &e.diffuse)), &blank.floats),
            or(self.gloss.as_ref().or(expansion.and_then(|e| e.specular.as_ref())), &blank.floats),
            or(self.base.as_ref(), &blank.floats),
            or(self.surroundings.as_ref().map(|s| &s.1), &blank.floats),
            or(self.kinds.as_ref(), &blank.integers),
            list(self.normals.as_ref(), &blank.floats),
        ];
        let texture = |view| BindingResource::TextureView(view);
        let (corners, triangles) = (or(corners, &blank.floats), or(triangles, &blank.integers));
        let mut resources = vec![self.uniforms.as_entire_binding()];
        resources.extend(textures.iter().map(texture));
        resources.extend([BindingResource::Sampler(&self.sampler), texture(&corners), texture(&triangles)]);
        let entries: Vec<_> =
            resources.into_iter().zip(0..).map(|(resource, binding)| BindGroupEntry { binding, resource }).collect();
        gpu.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// Draws it with the pipeline that is set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(0, self.bindings.as_ref(), &[]);
        match &self.geometry {
            Geometry::Buffers { vertices, indices } => {
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..self.corner_count, 0, 0..1);
            }
            Geometry::Textures { .. } => pass.draw(0..self.corner_count, 0..1),
        }
    }
}

fn light_list(gpu: &Gpu, lights: usize) -> Result<List> {
    List::line(gpu, "lights", (lights * 2).max(2) as u32, TextureFormat::Rgba32Float)
}
