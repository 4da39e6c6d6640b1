//! Which triangle is seen where: depth and coverage, before anything is shaded.
//!
//! The words of a tile hold the number of the nearest triangle so far. What is hidden in the end is never shaded, and what
//! the shaders do for a block of pixels they do once, however many triangles meet in it.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, i32x16, u32x16};

use super::buffer::{BLOCK, BLOCKS, Tile};
use super::cover::{COUNT, Edges, columns, pixels};
use super::front::{Chunk, Front, Triangle};
use super::group::Group;
use super::planes::{Plane, Sides};
use super::samples::places;
use crate::fill::SUBPIXEL_BITS;
use crate::simd::{three, two};

/// A triangle that was nearest somewhere in a tile when it was drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Owner {
    /// Which task's triangle.
    pub(super) chunk: u32,
    pub(super) triangle: u32,
    /// From its first corner to the centre of the tile's first pixel, in pixels.
    pub(super) start: [f32; 2],
    pub(super) sides: Sides,
}

/// The owners of the pixels of a tile: owner `i` has the number `i` + 1.
///
/// Numbers stay below the colours of drawn pixels, whose highest byte is 255, and 0 is an empty, transparent one; so a word
/// says itself whether it is shaded.
pub(super) type Owners = Vec<Owner>;

impl Front {
    /// Enters an object's triangles into tile number `number`, whose first pixel is `origin`.
    pub(super) fn cover(&self, level: Level, tile: &mut Tile, owners: &mut Owners, number: usize, origin: [i32; 2]) {
        match tile.samples() {
            1 => dispatch!(level, simd => self.cover_lanes::<_, 1>(simd, tile, owners, number, origin)),
            _ => dispatch!(level, simd => self.cover_lanes::<_, 4>(simd, tile, owners, number, origin)),
        }
    }

    #[inline(always)]
    fn cover_lanes<S: Simd, const SAMPLES: usize>(
        &self,
        simd: S,
        tile: &mut Tile,
        owners: &mut Owners,
        number: usize,
        origin: [i32; 2],
    ) {
        let mut group = Group::<SAMPLES>::default();
        for (which, chunk) in self.chunks.iter().enumerate() {
            for numbers in chunk.of_tile(number).chunks(16) {
                for (lane, &triangle) in numbers.iter().enumerate() {
                    group.set(lane, &self.screen(chunk, &chunk.triangles[triangle as usize]));
                }
                group.set_up(simd, numbers.len(), origin);
                for (lane, &triangle) in numbers.iter().enumerate() {
                    let word = owners.len() as u32 + 1;
                    if cover_triangle(simd, &group, lane, word, tile) {
                        let (start, sides) = (group.start(lane), group.sides(lane));
                        owners.push(Owner { chunk: which as u32, triangle, start, sides });
                    }
                }
            }
        }
    }

    /// The corners of a triangle on the screen.
    #[inline(always)]
    fn screen(&self, chunk: &Chunk, triangle: &Triangle) -> [crate::raster::project::ScreenVertex; 3] {
        three!(i => match Triangle::cut(triangle.corners[i]) {
            None => self.vertices[triangle.corners[i] as usize],
            Some(cut) => chunk.cut[cut].screen,
        })
    }
}

/// Writes `word` and depth wherever a triangle is the nearest so far; whether that is anywhere.
#[inline(always)]
fn cover_triangle<S: Simd, const SAMPLES: usize>(
    simd: S,
    group: &Group<SAMPLES>,
    lane: usize,
    word: u32,
    tile: &mut Tile,
) -> bool {
    let (edges, depth) = (group.edges(lane), group.depth(lane));
    let over_block = edges.over_block(simd);
    let (reach, word) = (BlockReach::new::<SAMPLES>(&depth), u32x16::splat(simd, word));
    let mut pen = Pen { edges, over_block, depth, reach, start: group.start(lane), word, seen: 0 };
    let [x0, x1, y0, y1] = group.bounds(lane).map(|pixel| pixel / BLOCK as i32);
    if x1 - x0 < 2 {
        // Narrow: the one or two blocks of each row, in one loop whose end is easily foreseen.
        let second = x1 - x0;
        for i in 0..(y1 - y0 + 1) << second {
            pen.block(simd, tile, [x0 + (i & second), y0 + (i >> second)], false);
        }
        return pen.seen != 0;
    }
    let in_columns = columns([x0, x1]);
    for by in y0..=y1 {
        let (some, whole) = pen.edges.row(simd, by);
        let mut left = in_columns & some & pen.before(simd, tile, by);
        while left != 0 {
            let bx = left.trailing_zeros() as i32;
            left &= left - 1;
            pen.block(simd, tile, [bx, by], whole >> bx & 1 != 0);
        }
    }
    pen.seen != 0
}

/// A triangle about to be written.
struct Pen<S: Simd, const SAMPLES: usize> {
    edges: Edges<SAMPLES>,
    over_block: [i32x16<S>; 3],
    depth: Plane,
    reach: BlockReach,
    /// See [`Owner::start`].
    start: [f32; 2],
    word: u32x16<S>,
    /// The lanes in which it was the nearest, of all blocks together.
    seen: u64,
}

impl<S: Simd, const SAMPLES: usize> Pen<S, SAMPLES> {
    /// Where the first pixel of a block is, from the triangle's first corner, in pixels.
    #[inline(always)]
    fn place(&self, block: [i32; 2]) -> [f32; 2] {
        two!(k => self.start[k] + (block[k] * BLOCK as i32) as f32)
    }

    /// The blocks of row `by` of which a place may lie in front of what is there, a bit for each.
    #[inline(always)]
    fn before(&self, simd: S, tile: &Tile, by: i32) -> u32 {
        let [x, y] = self.place([0, by]);
        self.reach.before(simd, &self.depth, x, y, tile.farthest(simd, by as usize))
    }

    /// Writes into a block; `whole` if all of it is known to be inside.
    #[inline(always)]
    fn block(&mut self, simd: S, tile: &mut Tile, [bx, by]: [i32; 2], whole: bool) {
        let [x0, y0] = self.place([bx, by]);
        let [lane_x, lane_y] = pixels(simd);
        let [x, y] = [lane_x + x0, lane_y + y0];
        let block = by as usize * BLOCKS + bx as usize;
        let mut filled = 0xffff;
        for (sample, place) in places::<SAMPLES>().into_iter().enumerate() {
            let z = if SAMPLES == 1 {
                self.depth.at(simd, x, y)
            } else {
                let [right, down] = place.map(|p| p as f32 / (1 << SUBPIXEL_BITS) as f32);
                self.depth.at(simd, x + right, y + down)
            };
            let at = block * SAMPLES + sample;
            let before = tile.depth(simd, at);
            let mut visible = z.simd_lt(before);
            if !whole {
                visible &= self.edges.inside(simd, &self.over_block, sample, [bx, by]);
            }
            let bits = visible.to_bitmask();
            (self.seen, filled) = (self.seen | bits, filled & bits);
            // Written even if nothing changes: that is cheaper than to foresee it.
            tile.set_depth(at, visible.select(z, before));
            tile.set_word(at, visible.select(self.word, tile.word(simd, at)));
        }
        if filled == 0xffff {
            tile.set_farthest(block, self.reach.farthest(&self.depth, x0, y0));
        }
    }
}

/// How far depth reaches within a block from the centre of its first pixel: down and up.
struct BlockReach {
    nearer: f32,
    farther: f32,
}

impl BlockReach {
    #[inline(always)]
    fn new<const SAMPLES: usize>(depth: &Plane) -> Self {
        let side = (BLOCK - 1) as f32;
        // Samples lie within half a pixel of the centre.
        let around = if SAMPLES == 1 { 0.0 } else { 0.5 * (depth.dx.abs() + depth.dy.abs()) };
        Self {
            nearer: side * (depth.dx.min(0.0) + depth.dy.min(0.0)) - around,
            farther: side * (depth.dx.max(0.0) + depth.dy.max(0.0)) + around,
        }
    }

    /// The blocks of a row that have a place in front of what is there, a bit for each; the first pixel is at (x, y).
    #[inline(always)]
    fn before<S: Simd>(&self, simd: S, depth: &Plane, x: f32, y: f32, farthest: f32x16<S>) -> u32 {
        let first = depth.at_corner + depth.dx * x + depth.dy * y + self.nearer;
        let step = depth.dx * BLOCK as f32;
        let lanes = i32x16::load_array_ref(simd, &COUNT).to_float::<f32x16<S>>();
        let nearest = lanes.mul_add(f32x16::splat(simd, step), f32x16::splat(simd, first));
        // Depths are rounded differently by the pixel: some room, so that nothing is passed over that would be seen.
        let room = f32x16::splat(simd, 1e-5);
        (nearest - room).simd_lt(farthest).to_bitmask() as u32
    }

    /// No pixel of the block whose first pixel is at (x, y) is farther.
    #[inline(always)]
    fn farthest(&self, depth: &Plane, x: f32, y: f32) -> f32 {
        depth.at_corner + depth.dx * x + depth.dy * y + self.farther + 1e-5
    }
}
