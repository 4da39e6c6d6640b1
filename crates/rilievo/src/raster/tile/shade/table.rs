//! Index map and shade table (Tarini et al. 2000, § 5).

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};

use super::{Finish, mean};
use crate::color::LinearRgb;
use crate::light::{Blend, Shade, ShadeTable};
use crate::raster::texture::TextureFilter;
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::{Footprint, Footprints, Look, Texture, float, largest, read_shade, shade_words};
use crate::simd::{gather, three};

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

    /// Texels, and which pixels are seen from behind.
    type Fetched<S: Simd> = (u32x16<S>, mask32x16<S>);

    #[inline(always)]
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>) -> (u32x16<S>, mask32x16<S>) {
        let (at, behind) = surface(simd, block, &self.look);
        (self.indices.send_for(simd, &self.look, &at), behind)
    }

    #[inline(always)]
    fn shade<S: Simd>(
        &self,
        simd: S,
        _: &Block<'_, S, SetUp>,
        &(texel, behind): &(u32x16<S>, mask32x16<S>),
    ) -> u32x16<S> {
        let entry = self.indices.index(simd, texel);
        gather(simd, &self.colors, behind.select(entry + self.entries, entry))
    }
}

/// Linear shades as lanes read them.
pub(in crate::raster::tile) struct Shades {
    words: Vec<u32>,
    largest: f32,
    /// How many entries the map has; those for back faces follow, if there are any.
    entries: u32,
    /// Without a base colour there is one colour an entry, in one word; else diffuse and specular light, in three.
    plain: bool,
}

/// The largest codes of red, green and blue where a colour is one word.
const CODES: [u32; 3] = [2047, 2047, 1023];
/// Where each begins.
const SHIFTS: [u32; 3] = [0, 11, 22];

impl Shades {
    /// Of the shades of front faces, and of back faces where they are drawn. `plain` is how they become colours, if they do so by
    /// themselves.
    pub(in crate::raster::tile) fn new(front: &ShadeTable, back: Option<&ShadeTable>, plain: Option<Blend>) -> Self {
        let shades = || front.entries().iter().chain(back.into_iter().flat_map(ShadeTable::entries)).copied();
        let entries = front.entries().len() as u32;
        let Some(blend) = plain else {
            let all: Vec<Shade> = shades().collect();
            let largest = largest(all.iter());
            let words = all.iter().flat_map(|shade| shade_words(shade, largest)).collect();
            return Self { words, largest, entries, plain: false };
        };
        let colors = || shades().map(|shade| shade.over(LinearRgb::WHITE, blend));
        let largest = colors().fold(1e-6, |most: f32, c| most.max(c.r).max(c.g).max(c.b));
        // Roots, so that codes lie about as close as the eye's: a quarter of an 8-bit step apart.
        let code = |v: f32, k: usize| (((v.max(0.0) / largest).sqrt() * CODES[k] as f32 + 0.5) as u32) << SHIFTS[k];
        let words = colors().map(|c| code(c.r, 0) | code(c.g, 1) | code(c.b, 2)).collect();
        Self { words, largest, entries, plain: true }
    }

    /// Diffuse red, green and blue of entries, then specular; a plain colour counts as diffuse.
    #[inline(always)]
    fn read<S: Simd>(&self, simd: S, entry: u32x16<S>) -> [f32x16<S>; 6] {
        if !self.plain {
            return read_shade(simd, &self.words, entry, self.largest);
        }
        let word = gather(simd, &self.words, entry);
        let [r, g, b] = three!(k => {
            let root = float((word >> SHIFTS[k]) & CODES[k]) * (self.largest.sqrt() / CODES[k] as f32);
            root * root
        });
        let none = f32x16::splat(simd, 0.0);
        [r, g, b, none, none, none]
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
            |texel| shades.read(simd, self.indices.index(simd, texel) + table),
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
