//! Index map and shade table (Tarini et al. 2000, § 5).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, mask32x16, u32x16};

use super::{Finish, mean};
use crate::light::{Blend, ShadeTable};
use crate::raster::texture::TextureFilter;
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::{Footprint, Footprints, Look, Texture, largest, read_shade, shade_words};
use crate::simd::gather;

/// Texture coordinates and 1/w.
const ATTRIBUTES: usize = 3;

fn attributes(vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
    [vertex.uv.x * inv_w, vertex.uv.y * inv_w, inv_w]
}

/// A triangle: where its texels are, and whether it is seen from behind.
type SetUp = (Planes<ATTRIBUTES>, bool);

/// The footprints of a block, and its pixels that are seen from behind.
#[inline(always)]
fn surface<S: Simd>(simd: S, block: &Block<'_, S, SetUp>, look: &Look) -> (Footprint<S>, mask32x16<S>) {
    let mut surface = Footprints::new(simd);
    let mut behind = mask32x16::splat(simd, false);
    for i in 0..block.parts() {
        let part = block.part(simd, i);
        let (planes, back) = part.set_up;
        surface.add(simd, planes, &part, look.filter == TextureFilter::Trilinear);
        if *back {
            behind |= part.lanes;
        }
    }
    (surface.get(), behind)
}

/// One look-up a pixel: colours are encoded in the table already.
pub(in crate::raster::tile) struct Nearest<'a> {
    pub(in crate::raster::tile) indices: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    /// Encoded colours of front faces, and then those of back faces.
    colors: Vec<u32>,
    /// How many entries the map has.
    entries: u32,
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
        let both = std::iter::once(front).chain(back).flat_map(|table| table.to_srgb(blend));
        let colors = both.map(word).collect();
        Self { indices, look, colors, entries: front.entries().len() as u32 }
    }
}

impl Shader<ATTRIBUTES> for Nearest<'_> {
    type SetUp = SetUp;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> SetUp {
        (seen.sides.planes(seen.attributes), seen.triangle.back_facing())
    }

    /// The entries.
    type Fetched<S: Simd> = u32x16<S>;

    #[inline(always)]
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>) -> u32x16<S> {
        let (at, behind) = surface(simd, block, &self.look);
        let mut entry = u32x16::splat(simd, 0);
        self.indices.taps(
            simd,
            &self.look,
            &at,
            #[inline(always)]
            |texel, _| entry = self.indices.index(simd, texel),
        );
        behind.select(entry + self.entries, entry)
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, _: &Block<'_, S, SetUp>, entry: &u32x16<S>) -> u32x16<S> {
        gather(simd, &self.colors, *entry)
    }
}

/// Linear shades as lanes read them.
pub(in crate::raster::tile) struct Shades {
    words: Vec<u32>,
    largest: f32,
    /// How many entries the map has; those for back faces follow, if there are any.
    entries: u32,
}

impl Shades {
    /// Of the shades of front faces, and of back faces where they are drawn.
    pub(in crate::raster::tile) fn new(front: &ShadeTable, back: Option<&ShadeTable>) -> Self {
        let both = || front.entries().iter().chain(back.into_iter().flat_map(ShadeTable::entries));
        let largest = largest(both());
        let words = both().flat_map(|shade| shade_words(shade, largest)).collect();
        Self { words, largest, entries: front.entries().len() as u32 }
    }
}

/// Look-ups first, then the filter, then the base colour: indices are never averaged.
pub(in crate::raster::tile) struct Filtered<'a> {
    pub(in crate::raster::tile) indices: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    pub(in crate::raster::tile) shades: Shades,
    pub(in crate::raster::tile) finish: Finish<'a>,
}

impl Shader<ATTRIBUTES> for Filtered<'_> {
    type SetUp = SetUp;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> SetUp {
        (seen.sides.planes(seen.attributes), seen.triangle.back_facing())
    }

    type Fetched<S: Simd> = (Footprint<S>, mask32x16<S>);

    #[inline(always)]
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>) -> (Footprint<S>, mask32x16<S>) {
        surface(simd, block, &self.look)
    }

    #[inline(always)]
    fn shade<S: Simd>(
        &self,
        simd: S,
        _: &Block<'_, S, SetUp>,
        &(at, behind): &(Footprint<S>, mask32x16<S>),
    ) -> u32x16<S> {
        let shades = &self.shades;
        // Where the table of a pixel begins.
        let table = behind.select(u32x16::splat(simd, shades.entries), u32x16::splat(simd, 0));
        let [r, g, b, sr, sg, sb] = mean(
            simd,
            self.indices,
            &self.look,
            &at,
            #[inline(always)]
            |texel| read_shade(simd, &shades.words, self.indices.index(simd, texel) + table, shades.largest),
        );
        self.finish.encode(simd, [r, g, b], [sr, sg, sb], &at)
    }
}

/// A light map: every texel lit once, long ago.
pub(in crate::raster::tile) struct Static<'a> {
    pub(in crate::raster::tile) shades: &'a Texture,
    pub(in crate::raster::tile) look: Look,
    pub(in crate::raster::tile) finish: Finish<'a>,
}

impl Shader<ATTRIBUTES> for Static<'_> {
    type SetUp = SetUp;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        attributes(vertex, inv_w)
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> SetUp {
        (seen.sides.planes(seen.attributes), false)
    }

    type Fetched<S: Simd> = Footprint<S>;

    #[inline(always)]
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>) -> Footprint<S> {
        surface(simd, block, &self.look).0
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, _: &Block<'_, S, SetUp>, at: &Footprint<S>) -> u32x16<S> {
        let [r, g, b, sr, sg, sb] = mean(
            simd,
            self.shades,
            &self.look,
            at,
            #[inline(always)]
            |texel| self.shades.shade(simd, texel),
        );
        self.finish.encode(simd, [r, g, b], [sr, sg, sb], at)
    }
}
