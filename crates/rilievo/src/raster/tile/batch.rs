//! The shading of an object: each block of pixels once, whatever triangles meet in it.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, f32x16, mask32x16, u32x16};

use super::buffer::{BLOCK, BLOCKS, Tile};
use super::cover::pixels;
use super::front::{Chunk, Front, Triangle, Vertex};
use super::planes::Sides;
use super::visible::Owner;
use crate::simd::{LANES, three};

/// A way to shade, over `N` attributes of each vertex.
pub(super) trait Shader<const N: usize>: Sync {
    /// What is the same over a triangle.
    type SetUp;

    /// What is wanted of each vertex. It is interpolated over the screen as it is: divided by w what belongs to the surface.
    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; N];

    /// Prepares a triangle that owns a pixel of a tile.
    fn set_up(&self, triangle: &Seen<'_, N>) -> Self::SetUp;

    /// Encoded colours of a block. Lanes that no part has may be anything.
    fn shade<S: Simd>(&self, simd: S, block: &Block<'_, S, Self::SetUp>) -> u32x16<S>;
}

/// A triangle with a visible pixel.
pub(super) struct Seen<'a, const N: usize> {
    pub(super) triangle: &'a Triangle,
    pub(super) attributes: [&'a [f32; N]; 3],
    pub(super) sides: Sides,
    chunk: &'a Chunk,
}

impl<const N: usize> Seen<'_, N> {
    /// Weights of the corners in the mesh's triangle of these vertices.
    pub(super) fn weights(&self, vertices: [u32; 3]) -> [[f32; 3]; 3] {
        self.triangle.corners.map(|corner| match Triangle::cut(corner) {
            Some(cut) => self.chunk.cut[cut].weights,
            None => vertices.map(|v| f32::from(u8::from(v == corner))),
        })
    }
}

/// Sixteen pixels, each of one triangle.
pub(super) struct Block<'a, S: Simd, U> {
    set_ups: &'a [U],
    owners: &'a [Owner],
    parts: &'a [PartOf],
    /// The numbers of the owners, by pixel.
    words: u32x16<S>,
    /// Where the centres of the pixels are in the tile.
    x: f32x16<S>,
    y: f32x16<S>,
}

/// Which owner, and which set-up is its.
#[derive(Debug, Clone, Copy, Default)]
struct PartOf {
    word: u32,
    owner: u32,
    set_up: u32,
}

/// What one triangle has of a block.
pub(super) struct Part<'a, S: Simd, U> {
    pub(super) set_up: &'a U,
    /// Where pixel centres are, relative to the triangle's first corner, in pixels.
    pub(super) x: f32x16<S>,
    pub(super) y: f32x16<S>,
    /// The pixels that are the triangle's.
    pub(super) lanes: mask32x16<S>,
}

impl<'a, S: Simd, U> Block<'a, S, U> {
    /// How many triangles meet here.
    #[inline(always)]
    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn part(&self, simd: S, i: usize) -> Part<'a, S, U> {
        let part = self.parts[i];
        let [right, down] = self.owners[part.owner as usize].start;
        Part {
            set_up: &self.set_ups[part.set_up as usize],
            x: self.x + right,
            y: self.y + down,
            lanes: self.words.simd_eq(u32x16::splat(simd, part.word)),
        }
    }
}

/// What the picture wants of an object, whatever shades it.
pub(super) trait Batch: Sync {
    /// Its triangles.
    fn front(&self) -> &Front;

    /// Colours the pixels of `tile` whose owners are `owners`, the first of them number `first`.
    fn shade(&self, level: Level, tile: &mut Tile, owners: &[Owner], first: u32);
}

/// An object on the screen and its shader.
pub(super) struct Shaded<'a, Sh, const N: usize> {
    pub(super) front: &'a Front,
    pub(super) shader: Sh,
}

impl<Sh: Shader<N>, const N: usize> Batch for Shaded<'_, Sh, N> {
    fn front(&self) -> &Front {
        self.front
    }

    fn shade(&self, level: Level, tile: &mut Tile, owners: &[Owner], first: u32) {
        // Not `dispatch!`: machines that have SSE4.2 and no AVX2 are rare, and every set is one more kernel for every method.
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(avx512) = level.as_avx512() {
                return avx512.vectorize(
                    #[inline(always)]
                    || self.shade_lanes(avx512, tile, owners, first),
                );
            }
            if let Some(avx2) = level.as_avx2() {
                return avx2.vectorize(
                    #[inline(always)]
                    || self.shade_lanes(avx2, tile, owners, first),
                );
            }
            if let Some(sse2) = level.as_sse2() {
                sse2.vectorize(
                    #[inline(always)]
                    || self.shade_lanes(sse2, tile, owners, first),
                );
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!(level, simd => self.shade_lanes(simd, tile, owners, first));
    }
}

/// No set-up yet.
const NONE: u32 = u32::MAX;

impl<Sh: Shader<N>, const N: usize> Shaded<'_, Sh, N> {
    #[inline(always)]
    fn shade_lanes<S: Simd>(&self, simd: S, tile: &mut Tile, owners: &[Owner], first: u32) {
        let mut set_ups: Vec<Sh::SetUp> = Vec::with_capacity(owners.len());
        let mut set_up_of = vec![NONE; owners.len()];
        let [lane_x, lane_y] = pixels(simd);
        let count = u32x16::splat(simd, owners.len() as u32);
        let samples = tile.samples();
        for block in 0..BLOCKS * BLOCKS {
            // Samples of a pixel may have several owners: one after the other.
            loop {
                // The first sample of each pixel that waits for its colour.
                let mut words = tile.word(simd, block * samples);
                let mut waiting = (words - first).simd_lt(count);
                for sample in 1..samples {
                    let next = tile.word(simd, block * samples + sample);
                    words = waiting.select(words, next);
                    waiting |= (next - first).simd_lt(count);
                }
                let mut left = waiting.to_bitmask() as u32;
                if left == 0 {
                    break;
                }
                let mut numbers = [0; LANES];
                words.store_array(&mut numbers);
                let (mut parts, mut len) = ([PartOf::default(); LANES], 0);
                while left != 0 {
                    let word = numbers[left.trailing_zeros() as usize];
                    left &= !(words.simd_eq(u32x16::splat(simd, word)).to_bitmask() as u32);
                    let owner = (word - first) as usize;
                    if set_up_of[owner] == NONE {
                        set_up_of[owner] = set_ups.len() as u32;
                        set_ups.push(self.set_up(&owners[owner]));
                    }
                    parts[len] = PartOf { word, owner: owner as u32, set_up: set_up_of[owner] };
                    len += 1;
                }
                let color = self.shader.shade(
                    simd,
                    &Block {
                        set_ups: &set_ups,
                        owners,
                        parts: &parts[..len],
                        words,
                        x: lane_x + (block % BLOCKS * BLOCK) as f32,
                        y: lane_y + (block / BLOCKS * BLOCK) as f32,
                    },
                );
                for sample in 0..samples {
                    let at = block * samples + sample;
                    let word = tile.word(simd, at);
                    tile.set_word(at, (waiting & word.simd_eq(words)).select(color, word));
                }
                if samples == 1 {
                    break;
                }
            }
        }
    }

    #[inline(always)]
    fn set_up(&self, owner: &Owner) -> Sh::SetUp {
        let chunk = &self.front.chunks[owner.chunk as usize];
        let triangle = &chunk.triangles[owner.triangle as usize];
        let attributes = three!(i => self.attributes_of(chunk, triangle.corners[i]));
        self.shader.set_up(&Seen { triangle, attributes, sides: owner.sides, chunk })
    }

    #[inline(always)]
    fn attributes_of<'b>(&'b self, chunk: &'b Chunk, corner: u32) -> &'b [f32; N] {
        let (values, at) = match Triangle::cut(corner) {
            None => (&self.front.attributes, corner as usize),
            Some(cut) => (&chunk.cut_attributes, cut),
        };
        &values.as_chunks::<N>().0[at]
    }
}
