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

    /// Where pixels look.
    type Fetched<S: Simd>: Copy;

    /// Sends for what is to be looked up in large maps. This is done for a block before the one in front of it is shaded: the light
    /// of one block is computed while the texels of the next are on their way from far-off memory.
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, Self::SetUp>) -> Self::Fetched<S>;

    /// Encoded colours of a block. Lanes that no part has may be anything.
    fn shade<S: Simd>(&self, simd: S, block: &Block<'_, S, Self::SetUp>, fetched: &Self::Fetched<S>) -> u32x16<S>;
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
    triangles: &'a [Placed<U>],
    /// Which of them meet here.
    parts: &'a [u32],
    /// For each pixel, which it is.
    owners: u32x16<S>,
    /// Where the centres of the pixels are in the tile.
    x: f32x16<S>,
    y: f32x16<S>,
}

/// A triangle over a tile; set up when first seen.
struct Placed<U> {
    /// See [`Owner::start`].
    start: [f32; 2],
    set_up: Option<U>,
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
        let owner = self.parts[i];
        let Placed { start: [right, down], set_up } = &self.triangles[owner as usize];
        Part {
            set_up: set_up.as_ref().expect("invariant: what is seen was set up"),
            x: self.x + *right,
            y: self.y + *down,
            lanes: self.owners.simd_eq(u32x16::splat(simd, owner)),
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

/// Pixels of a block whose texels are on their way.
struct Pending<S: Simd, F> {
    number: usize,
    owners: u32x16<S>,
    /// For each sample, the pixels that it is to colour.
    waiting: [mask32x16<S>; 4],
    parts: [u32; LANES],
    count: usize,
    fetched: Option<F>,
}

impl<S: Simd, F> Pending<S, F> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let (owners, waiting) = (u32x16::splat(simd, 0), [mask32x16::splat(simd, false); 4]);
        Self { number: 0, owners, waiting, parts: [0; LANES], count: 0, fetched: None }
    }

    #[inline(always)]
    fn block<'a, U>(&'a self, simd: S, triangles: &'a [Placed<U>]) -> Block<'a, S, U> {
        let [x, y] = pixels(simd);
        Block {
            triangles,
            parts: &self.parts[..self.count],
            owners: self.owners,
            x: x + (self.number % BLOCKS * BLOCK) as f32,
            y: y + (self.number / BLOCKS * BLOCK) as f32,
        }
    }

    /// Finds the pixels of block `number` whose owners are `count` from `first` on; whether there are any.
    ///
    /// The samples of a pixel may have several owners: those of the first now, the others when asked again.
    #[inline(always)]
    fn find(&mut self, simd: S, tile: &mut Tile, number: usize, first: u32, count: u32x16<S>) -> bool {
        let samples = tile.samples();
        let at = number * samples;
        let mut owners = tile.word(simd, at) - first;
        let mut any = owners.simd_lt(count);
        for sample in 1..samples {
            let owner = tile.word(simd, at + sample) - first;
            owners = any.select(owners, owner);
            any |= owner.simd_lt(count);
        }
        let mut left = any.to_bitmask() as u32;
        if left == 0 {
            return false;
        }
        (self.number, self.owners, self.waiting[0], self.count) = (number, owners, any, 0);
        if samples > 1 {
            for (sample, waiting) in self.waiting.iter_mut().enumerate().take(samples) {
                let word = tile.word(simd, at + sample);
                *waiting = any & (word - first).simd_eq(owners);
                tile.set_word(at + sample, waiting.select(u32x16::splat(simd, TAKEN), word));
            }
        }
        let mut of_lane = [0; LANES];
        owners.store_array(&mut of_lane);
        while left != 0 {
            let owner = of_lane[left.trailing_zeros() as usize];
            left &= !(owners.simd_eq(u32x16::splat(simd, owner)).to_bitmask() as u32);
            self.parts[self.count] = owner;
            self.count += 1;
        }
        true
    }
}

/// A word that is no owner's number and no empty pixel: its colour will come.
const TAKEN: u32 = 0xff00_0000;

impl<Sh: Shader<N>, const N: usize> Shaded<'_, Sh, N> {
    #[inline(always)]
    fn shade_lanes<S: Simd>(&self, simd: S, tile: &mut Tile, owners: &[Owner], first: u32) {
        let place = |owner: &Owner| Placed { start: owner.start, set_up: None };
        let mut triangles: Vec<Placed<Sh::SetUp>> = owners.iter().map(place).collect();
        let owner_count = u32x16::splat(simd, owners.len() as u32);
        let samples = tile.samples();
        // One is fetched for while the other is shaded.
        let mut both = [Pending::<S, Sh::Fetched<S>>::new(simd), Pending::new(simd)];
        let (mut turn, mut number) = (0, 0);
        loop {
            let next = &mut both[turn];
            while number < BLOCKS * BLOCKS && !next.find(simd, tile, number, first, owner_count) {
                number += 1;
            }
            let found = number < BLOCKS * BLOCKS;
            if found {
                for &owner in &next.parts[..next.count] {
                    let triangle = &mut triangles[owner as usize];
                    if triangle.set_up.is_none() {
                        triangle.set_up = Some(self.set_up(&owners[owner as usize]));
                    }
                }
                next.fetched = Some(self.shader.fetch(simd, &next.block(simd, &triangles)));
                number += usize::from(samples == 1);
            }
            let ready = &mut both[1 - turn];
            if let Some(fetched) = ready.fetched.take() {
                let color = self.shader.shade(simd, &ready.block(simd, &triangles), &fetched);
                for (sample, waiting) in ready.waiting.iter().enumerate().take(samples) {
                    let at = ready.number * samples + sample;
                    tile.set_word(at, waiting.select(color, tile.word(simd, at)));
                }
            }
            if !found {
                break;
            }
            turn = 1 - turn;
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
        values[at * N..].first_chunk().expect("invariant: every corner has its attributes")
    }
}
