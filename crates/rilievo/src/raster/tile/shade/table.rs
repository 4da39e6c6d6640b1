//! Index map and shade table (Tarini et al. 2000, § 5).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

use super::Finish;
use crate::light::{Blend, ShadeTable};
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::{Look, Texture, footprint, largest, read_shade, shade_words};
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
        self.indices.taps(
            simd,
            &self.look,
            &at,
            #[inline(always)]
            |texel, _| {
                color = gather(simd, &self.colors[usize::from(*back)], self.indices.index(simd, texel));
            },
        );
        color
    }
}

/// Linear shades as lanes read them.
pub(in crate::raster::tile) struct Shades {
    words: Vec<u32>,
    largest: f32,
}

impl Shades {
    pub(in crate::raster::tile) fn new(table: &ShadeTable) -> Self {
        let largest = largest(table.entries().iter());
        Self { words: table.entries().iter().flat_map(|shade| shade_words(shade, largest)).collect(), largest }
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
        self.indices.taps(
            simd,
            &self.look,
            &at,
            #[inline(always)]
            |texel, weight| {
                let shade = read_shade(simd, &shades.words, self.indices.index(simd, texel), shades.largest);
                for k in 0..6 {
                    sums[k] = shade[k].mul_add(weight, sums[k]);
                }
            },
        );
        self.finish.encode(simd, three!(k => sums[k]), three!(k => sums[k + 3]), &at)
    }
}

/// A light map: every texel lit once, long ago.
pub(in crate::raster::tile) struct Static<'a> {
    pub(in crate::raster::tile) shades: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    pub(in crate::raster::tile) finish: Finish<'a>,
}

impl Shader<ATTRIBUTES> for Static<'_> {
    type SetUp = Planes<ATTRIBUTES>;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> Self::SetUp {
        seen.sides.planes(seen.attributes)
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, planes: &Self::SetUp, block: &Block<S>) -> u32x16<S> {
        let at = footprint(simd, planes, 0, block.x, block.y);
        let mut sums = [f32x16::splat(simd, 0.0); 6];
        self.shades.taps(
            simd,
            &self.look,
            &at,
            #[inline(always)]
            |texel, weight| {
                let shade = self.shades.shade(simd, texel);
                for k in 0..6 {
                    sums[k] = shade[k].mul_add(weight, sums[k]);
                }
            },
        );
        self.finish.encode(simd, three!(k => sums[k]), three!(k => sums[k + 3]), &at)
    }
}
