//! Maps as textures, and how they are sampled.

use rilievo::light::Shade;
use rilievo::raster::TextureFilter;
use rilievo::{Edges, LinearRgb, MipChain, Normal, NormalTable, Space};
use wgpu::{AddressMode, FilterMode, Sampler, SamplerDescriptor, Texture, TextureFormat};

use crate::device::Gpu;
use crate::error::Result;
use crate::texture::{List, float_bytes, light_bytes, upload};

pub(super) fn sampler(gpu: &Gpu, edges: Edges, filter: TextureFilter) -> Sampler {
    let smooth = filter != TextureFilter::Nearest;
    let linear = if smooth { FilterMode::Linear } else { FilterMode::Nearest };
    // Other edges are resolved by the shader: within a copy of the map they end where it does.
    let address = if edges == Edges::Wrap { AddressMode::Repeat } else { AddressMode::ClampToEdge };
    gpu.device.create_sampler(&SamplerDescriptor {
        address_mode_u: address,
        address_mode_v: address,
        mag_filter: linear,
        min_filter: linear,
        ..SamplerDescriptor::default()
    })
}

/// Indices, in bytes where they fit.
pub(super) fn index_texture(gpu: &Gpu, indices: &MipChain<u16>, entries: usize) -> Result<Texture> {
    match entries {
        0..=256 => {
            upload(gpu, "an index map", indices, TextureFormat::R8Uint, |t| t.iter().map(|&i| i as u8).collect())
        }
        _ => upload(gpu, "an index map", indices, TextureFormat::R16Uint, |t| bytemuck::cast_slice(t).to_vec()),
    }
}

pub(super) fn normal_texture<S: Space>(gpu: &Gpu, normals: &MipChain<Normal<S>>) -> Result<Texture> {
    let bytes = |t: &[Normal<S>]| float_bytes(t.iter().map(|n| n.vec().extend(0.0).to_array()));
    upload(gpu, "a normal map", normals, TextureFormat::Rgba16Float, bytes)
}

pub(super) fn kind_texture(gpu: &Gpu, materials: &MipChain<u8>) -> Result<Texture> {
    upload(gpu, "a material map", materials, TextureFormat::R8Uint, <[u8]>::to_vec)
}

/// Normal and material of each entry.
pub(super) fn normal_list<S: Space>(gpu: &Gpu, table: &NormalTable<S>) -> Result<List> {
    let mut list = List::new(gpu, "a table of normals", table.len(), TextureFormat::Rgba32Float)?;
    let spans = table.spans().iter();
    let kinds = spans.flat_map(|s| std::iter::repeat_n(f32::from(s.material), s.entries.len()));
    let texels: Vec<[f32; 4]> =
        table.normals().iter().zip(kinds).map(|(n, kind)| n.vec().extend(kind).to_array()).collect();
    list.write(gpu, bytemuck::cast_slice(&texels));
    Ok(list)
}

/// The words of a bump-vector map.
pub(super) fn word_texture(gpu: &Gpu, words: &MipChain<[u16; 3]>) -> Result<Texture> {
    let bytes = |texels: &[[u16; 3]]| -> Vec<u8> {
        let padded: Vec<[u16; 4]> = texels.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        bytemuck::cast_slice(&padded).to_vec()
    };
    upload(gpu, "a bump-vector map", words, TextureFormat::Rgba16Uint, bytes)
}

/// One of the two lights of a light map.
pub(super) fn shade_texture(gpu: &Gpu, levels: &MipChain<Shade>, pick: fn(&Shade) -> LinearRgb) -> Result<Texture> {
    upload(gpu, "a light map", levels, TextureFormat::Rgba16Float, |t: &[Shade]| light_bytes(t.iter().map(pick)))
}

/// A base colour, in linear light.
pub(super) fn color_texture(gpu: &Gpu, levels: &MipChain<LinearRgb>) -> Result<Texture> {
    upload(gpu, "a base colour", levels, TextureFormat::Rgba16Float, |t: &[LinearRgb]| light_bytes(t.iter().copied()))
}
