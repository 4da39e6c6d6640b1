//! Which pixels of a tile a triangle owns: exactly those of [`crate::fill::Triangle`].
//!
//! The function of an edge is a whole number at every pixel centre, in units of a sub-pixel squared: 64 bits. From pixel to
//! pixel it changes by multiples of 256, so its sign is that of its value divided by 256 and rounded down; that, relative to
//! a tile, fits 32 bits and is still exact.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, mask32x16};

use super::buffer::{BLOCK, BLOCKS};
use super::samples::places;
use crate::fill::SUBPIXEL_BITS;
use crate::raster::project::ScreenVertex;
use crate::simd::three;

const ONE: i64 = 1 << SUBPIXEL_BITS;

/// Values beyond this cannot change their sign within a tile: sides are below 2²² sub-pixels (the guard band sees to that), and
/// 2 · 63 steps of 2²² stay below it.
const FAR: i64 = 1 << 30;

/// The edges of a triangle over a tile: inside where all of `a` x + `b` y + `c` ≥ 0, x and y pixels from the tile's corner; each
/// sample of a pixel has a `c` of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edges<const SAMPLES: usize> {
    pub(super) a: [i32; 3],
    pub(super) b: [i32; 3],
    pub(super) c: [[i32; 3]; SAMPLES],
}

/// The pixels that a triangle may touch, as a rectangle; the last ones are included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) x: [i32; 2],
    pub(super) y: [i32; 2],
}

impl Bounds {
    /// The pixels with a sample in the box around a triangle, or near to it; `None` if there are none on a picture of `size`.
    /// Samples lie within `reach` sub-pixels of the centre.
    pub(super) fn of(v: &[ScreenVertex; 3], size: [i32; 2], reach: i32) -> Option<Self> {
        let axis = |coordinates: [i32; 3], side: i32| {
            let [a, b, c] = coordinates;
            let (low, high) = (a.min(b).min(c) - reach, a.max(b).max(c) + reach);
            // Centres lie at (i + ½): the first at or after `low`, the last at or before `high`.
            let half = ONE as i32 / 2;
            [((low + half - 1) >> SUBPIXEL_BITS).max(0), ((high - half) >> SUBPIXEL_BITS).min(side - 1)]
        };
        let (x, y) = (axis(v.map(|v| v.x), size[0]), axis(v.map(|v| v.y), size[1]));
        (x[0] <= x[1] && y[0] <= y[1]).then_some(Self { x, y })
    }
}

impl<const SAMPLES: usize> Edges<SAMPLES> {
    /// Of a triangle whose corners run clockwise on the screen, over the tile whose first pixel is `origin`.
    #[inline(always)]
    pub(super) fn new(v: &[ScreenVertex; 3], origin: [i32; 2]) -> Self {
        let mut edges = Self { a: [0; 3], b: [0; 3], c: [[0; 3]; SAMPLES] };
        let centre = origin.map(|o| i64::from(o) * ONE + ONE / 2);
        for i in 0..3 {
            // Edge i lies opposite to corner i.
            let (from, to) = (v[(i + 1) % 3], v[(i + 2) % 3]);
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            let value =
                i64::from(dx) * (centre[1] - i64::from(from.y)) - i64::from(dy) * (centre[0] - i64::from(from.x));
            // Left edges go up, top edges go right; pixel centres on the others belong to the neighbour.
            let top_left = dy < 0 || (dy == 0 && dx > 0);
            (edges.a[i], edges.b[i]) = (-dy, dx);
            for (c, [right, down]) in edges.c.iter_mut().zip(places::<SAMPLES>()) {
                let value = value - i64::from(dy) * i64::from(right) + i64::from(dx) * i64::from(down);
                c[i] = ((value - i64::from(!top_left)) >> SUBPIXEL_BITS).clamp(-FAR, FAR) as i32;
            }
        }
        edges
    }

    /// The values of the three edges in a block of pixels, relative to its first.
    #[inline(always)]
    pub(super) fn over_block<S: Simd>(&self, simd: S) -> [i32x16<S>; 3] {
        let (x, y) = (i32x16::load_array_ref(simd, &COLUMN), i32x16::load_array_ref(simd, &ROW));
        three!(i => x * self.a[i] + y * self.b[i])
    }

    /// Which pixels of the block at column and row (`bx`, `by`) have sample number `sample` inside.
    #[inline(always)]
    pub(super) fn inside<S: Simd>(
        &self,
        simd: S,
        over_block: &[i32x16<S>; 3],
        sample: usize,
        [bx, by]: [i32; 2],
    ) -> mask32x16<S> {
        let (size, c) = (BLOCK as i32, &self.c[sample]);
        let [e0, e1, e2] = three!(i => over_block[i] + (c[i] + size * (bx * self.a[i] + by * self.b[i])));
        // One negative value makes the sign of all negative.
        (e0 | e1 | e2).simd_ge(i32x16::splat(simd, 0))
    }

    /// Of the blocks in row `by` of the tile: which may have samples inside, and which lie inside altogether, a bit for each.
    #[inline(always)]
    pub(super) fn row<S: Simd>(&self, simd: S, by: i32) -> (u32, u32) {
        let size = BLOCK as i32;
        let column = i32x16::load_array_ref(simd, &COUNT);
        let mut some = i32x16::splat(simd, 0);
        let mut all = some;
        for i in 0..3 {
            let values = column * (self.a[i] * size) + size * by * self.b[i];
            // The largest and the smallest value in a block are at corners that only the direction of the edge decides.
            let (mut high, mut low) = (i32::MIN, i32::MAX);
            for c in &self.c {
                (high, low) = (high.max(c[i]), low.min(c[i]));
            }
            let most = high + (size - 1) * (self.a[i].max(0) + self.b[i].max(0));
            let least = low + (size - 1) * (self.a[i].min(0) + self.b[i].min(0));
            some |= values + most;
            all |= values + least;
        }
        let zero = i32x16::splat(simd, 0);
        (some.simd_ge(zero).to_bitmask() as u32, all.simd_ge(zero).to_bitmask() as u32)
    }
}

/// The blocks of a row from number `x[0]` to number `x[1]`, a bit for each.
pub(super) fn columns(x: [i32; 2]) -> u32 {
    let [first, last] = x.map(|x| x as u32);
    (u32::MAX >> (31 - (last - first))) << first
}

/// x and y of the pixels of a block, relative to its first.
#[inline(always)]
pub(super) fn pixels<S: Simd>(simd: S) -> [f32x16<S>; 2] {
    [i32x16::load_array_ref(simd, &COLUMN).to_float(), i32x16::load_array_ref(simd, &ROW).to_float()]
}

/// Column and row of each lane in a block, and the lanes' own numbers.
const COLUMN: [i32; 16] = [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3];
const ROW: [i32; 16] = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3];
pub(super) const COUNT: [i32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

const _: () = assert!(BLOCKS == 16 && BLOCK * BLOCK == 16, "a row of blocks, and a block of pixels, are sixteen lanes");
