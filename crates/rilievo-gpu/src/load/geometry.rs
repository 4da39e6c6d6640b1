//! Meshes in the memory of the GPU.

use bytemuck::{Pod, Zeroable};
use rilievo::surface::Mesh;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Texture, TextureFormat};

use crate::device::Gpu;
use crate::error::{Error, Result};
use crate::method::Stages;
use crate::texture;

/// A vertex as the plain vertex stages take it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    uv: [f32; 2],
}

/// A mesh: in buffers, or in textures for stages that need whole triangles.
pub(super) enum Geometry {
    Buffers { vertices: Buffer, indices: Buffer },
    Textures { corners: Texture, triangles: Texture },
}

impl Geometry {
    pub(super) fn new(gpu: &Gpu, mesh: &Mesh, stages: Stages) -> Result<Self> {
        let count = mesh.positions().len();
        let at = |i: usize| Vertex {
            position: mesh.positions()[i].to_array(),
            normal: mesh.normals()[i].to_array(),
            tangent: mesh.tangents().get(i).map_or([0.0; 4], glam::Vec4::to_array),
            uv: mesh.uvs().get(i).map_or([0.0; 2], glam::Vec2::to_array),
        };
        let remedy = "use a mesh of fewer triangles, or the CPU renderer";
        if !stages.pulls_vertices() {
            let vertices: Vec<Vertex> = (0..count).map(at).collect();
            let buffer = |data: &[u8], usage| {
                let (needs, limit) = (data.len() as u64, gpu.device.limits().max_buffer_size);
                if needs > limit {
                    return Err(Error::Limit { what: "a mesh", needs, limit, remedy });
                }
                let usage = usage | BufferUsages::COPY_DST;
                let about = BufferDescriptor { label: None, size: needs.max(4), usage, mapped_at_creation: false };
                let buffer = gpu.device.create_buffer(&about);
                gpu.queue.write_buffer(&buffer, 0, data);
                Ok(buffer)
            };
            return Ok(Self::Buffers {
                vertices: buffer(bytemuck::cast_slice(&vertices), BufferUsages::VERTEX)?,
                indices: buffer(bytemuck::cast_slice(mesh.triangles()), BufferUsages::INDEX)?,
            });
        }
        let row = texture::ROW as usize;
        let rows = |count: usize| count.div_ceil(row).max(1) as u32;
        let mut texels: Vec<[f32; 4]> = Vec::with_capacity(count * 3);
        for v in (0..count).map(at) {
            let ([px, py, pz], [nx, ny, nz], [u, w]) = (v.position, v.normal, v.uv);
            texels.extend([[px, py, pz, u], [nx, ny, nz, w], v.tangent]);
        }
        let vertex_rows = rows(count);
        gpu.expect_side("a mesh", (3 * texture::ROW, vertex_rows), remedy)?;
        texels.resize(vertex_rows as usize * row * 3, [0.0; 4]);
        let corners = texture::create(gpu, (3 * texture::ROW, vertex_rows), 1, TextureFormat::Rgba32Float);
        texture::write(gpu, &corners, 0, (3 * texture::ROW, vertex_rows), bytemuck::cast_slice(&texels));
        let mut numbers: Vec<[u32; 4]> = mesh.triangles().iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        let triangle_rows = rows(numbers.len());
        gpu.expect_side("a mesh", (texture::ROW, triangle_rows), remedy)?;
        numbers.resize(triangle_rows as usize * row, [0; 4]);
        let triangles = texture::create(gpu, (texture::ROW, triangle_rows), 1, TextureFormat::Rgba32Uint);
        texture::write(gpu, &triangles, 0, (texture::ROW, triangle_rows), bytemuck::cast_slice(&numbers));
        Ok(Self::Textures { corners, triangles })
    }
}
