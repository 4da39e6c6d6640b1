//! Index map and shade table (Tarini et al. 2000, § 5).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};

use super::Finish;
use crate::light::{Blend, Shade, ShadeTable};
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::{Look, Texture, footprint};
use crate::simd::{gather, three};

/// Texture coordinates and 1/w.
const ATTRIBUTES: usize = 3;

fn attributes(vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
    [vertex.uv.x * inv_w, vertex.uv.y * inv_w, inv_w]
}

/// One look-up a pixel: colours are encoded in the table already.
pub(in crate::raster::tile) struct Nearest<'a> {
    pub(in crate::raster::tile) indices: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    /// Encoded colours of front and back faces.
    pub(in crate::raster::tile) colors: [Vec<u32>; 2],
}

impl<'a> Nearest<'a> {
    /// Of the shades of front faces, and of back faces where they are drawn.
    pub(in crate::raster::tile) fn new(
        indices: &'a Texture,
        look: Look,
        front: &ShadeTable,
        back: Option<&ShadeTable>,
        blend: Blend,
    ) -> Self {
        let encoded = |table: &ShadeTable| {
            let entries = table.entries().iter();
            entries.map(|shade| word(shade.over(crate::LinearRgb::WHITE, blend).to_srgb())).collect()
        };
        Self { indices, look, colors: [encoded(front), back.map_or_else(|| vec![0], encoded)] }
    }
}

impl Shader<ATTRIBUTES> for Nearest<'_> {
    type SetUp = (Planes<ATTRIBUTES>, bool);

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> Self::SetUp {
        (seen.sides.planes(seen.attributes), seen.triangle.back_facing())
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, (planes, back): &Self::SetUp, block: &Block<S>) -> u32x16<S> {
        let at = footprint(simd, planes, 0, block.x, block.y);
        let mut color = u32x16::splat(simd, 0);
        self.indices.taps(simd, &self.look, &at, #[inline(always)] |texel, _| {
            color = gather(simd, &self.colors[usize::from(*back)], self.indices.index(simd, texel));
        });
        color
    }
}

/// Linear shades as lanes read them: 16 bits of their largest value.
pub(in crate::raster::tile) struct Shades {
    /// Three words an entry: diffuse red and green, diffuse blue and specular red, specular green and blue.
    words: Vec<u32>,
    scale: f32,
}

impl Shades {
    pub(in crate::raster::tile) fn new(table: &ShadeTable) -> Self {
        let components = |s: &Shade| [s.diffuse, s.specular].map(|c| [c.r, c.g, c.b]).concat();
        let most = table.entries().iter().flat_map(components).fold(1e-6, f32::max);
        let code = |v: f32| (v / most * 65_535.0 + 0.5) as u32;
        let words = table.entries().iter().flat_map(|s| {
            let c: Vec<u32> = components(s).into_iter().map(code).collect();
            [c[0] | c[1] << 16, c[2] | c[3] << 16, c[4] | c[5] << 16]
        });
        Self { words: words.collect(), scale: most / 65_535.0 }
    }
}

/// Look-ups first, then the filter, then the base colour: indices are never averaged.
pub(in crate::raster::tile) struct Filtered<'a> {
    pub(in crate::raster::tile) indices: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    /// Of front and back faces; without back faces one is enough.
    pub(in crate::raster::tile) shades: [Option<Shades>; 2],
    pub(in crate::raster::tile) finish: Finish<'a>,
}

impl Shader<ATTRIBUTES> for Filtered<'_> {
    type SetUp = (Planes<ATTRIBUTES>, bool);

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> Self::SetUp {
        (seen.sides.planes(seen.attributes), seen.triangle.back_facing())
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, (planes, back): &Self::SetUp, block: &Block<S>) -> u32x16<S> {
        let at = footprint(simd, planes, 0, block.x, block.y);
        let mut sums = [f32x16::splat(simd, 0.0); 6];
        let Some(shades) = &self.shades[usize::from(*back)] else { return u32x16::splat(simd, 0) };
        self.indices.taps(simd, &self.look, &at, #[inline(always)] |texel, weight| {
            let entry = self.indices.index(simd, texel) * 3;
            for k in 0..3 {
                let pair = gather(simd, &shades.words, entry + k as u32);
                let [low, high] = [pair & 0xffff, pair >> 16];
                sums[2 * k] = low.bitcast::<i32x16<S>>().to_float::<f32x16<S>>().mul_add(weight, sums[2 * k]);
                sums[2 * k + 1] = high.bitcast::<i32x16<S>>().to_float::<f32x16<S>>().mul_add(weight, sums[2 * k + 1]);
            }
        });
        let diffuse = three!(k => sums[k] * shades.scale);
        let specular = three!(k => sums[k + 3] * shades.scale);
        self.finish.encode(simd, diffuse, specular, &at)
    }
}
