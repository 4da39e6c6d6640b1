//! The way without palettes: a light map for each frame.

use rilievo::light::{Blend, Shade, ShadeTable};
use rilievo::{LinearRgb, MipChain, Rgba8};
use wgpu::{Texture, TextureFormat};

use crate::device::Gpu;
use crate::error::Result;
use crate::texture;

/// A light map that the CPU makes anew for each frame.
pub(super) struct Expansion {
    pub(super) diffuse: Texture,
    /// Only where a base colour keeps the two apart.
    pub(super) specular: Option<Texture>,
}

impl Expansion {
    pub(super) fn new(gpu: &Gpu, indices: &MipChain<u16>, split: bool) -> Result<Self> {
        gpu.expect_side("an index map", indices.base().size(), "make the map smaller, or use the CPU renderer")?;
        let levels = indices.levels().len() as u32;
        let make = || texture::create(gpu, indices.base().size(), levels, TextureFormat::Rgba8UnormSrgb);
        Ok(Self { diffuse: make(), specular: split.then(make) })
    }

    /// Looks up every texel, and sends all of them.
    pub(super) fn write(&self, gpu: &Gpu, indices: &MipChain<u16>, table: &ShadeTable, blend: Blend) -> u64 {
        let encoded = |pick: fn(&Shade) -> LinearRgb| table.entries().iter().map(|s| pick(s).to_srgb()).collect();
        let (diffuse, specular): (Vec<Rgba8>, Vec<Rgba8>) = match &self.specular {
            Some(_) => (encoded(|s| s.diffuse), encoded(|s| s.specular)),
            None => (table.to_srgb(blend), Vec::new()),
        };
        let parts = [(Some(&self.diffuse), &diffuse), (self.specular.as_ref(), &specular)];
        let mut bytes = 0;
        for (texture, colors) in parts.into_iter().filter_map(|(t, colors)| Some((t?, colors))) {
            for (i, level) in indices.levels().iter().enumerate() {
                let texels: Vec<Rgba8> = level.texels().iter().map(|&i| colors[usize::from(i)]).collect();
                bytes += texture::write(gpu, texture, i as u32, level.size(), bytemuck::cast_slice(&texels));
            }
        }
        bytes
    }
}
