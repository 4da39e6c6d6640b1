//! One object in one tile: blocks of pixels that its triangles own, shaded by whatever method.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, f32x16, i32x16, mask32x16, u32x16};

use super::buffer::{BLOCK, BLOCKS, Tile};
use super::cover::{COUNT, columns, pixels};
use super::front::{Chunk, Front, Triangle, Vertex};
use super::group::Group;
use super::planes::{Plane, Sides};
use crate::simd::three;

/// A way to shade, over `N` attributes of each vertex.
pub(super) trait Shader<const N: usize>: Sync {
    /// What is the same over a triangle.
    type SetUp;

    /// What is wanted of each vertex. It is interpolated over the screen as it is: divided by w what belongs to the surface.
    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; N];

    /// Prepares a triangle that owns a pixel of a tile.
    fn set_up(&self, triangle: &Seen<'_, N>) -> Self::SetUp;

    /// Encoded colours of a block. Lanes outside of the triangle may be anything.
    fn shade<S: Simd>(&self, simd: S, set_up: &Self::SetUp, block: &Block<S>) -> u32x16<S>;
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

/// Sixteen pixels.
pub(super) struct Block<S: Simd> {
    /// Where their centres are, relative to the triangle's first corner, in pixels.
    pub(super) x: f32x16<S>,
    pub(super) y: f32x16<S>,
    /// The pixels that will be seen.
    pub(super) visible: mask32x16<S>,
}

/// What the picture wants of an object, whatever shades it.
pub(super) trait Batch: Sync {
    /// Whether the object may touch a tile.
    fn touches(&self, number: usize) -> bool;

    /// Draws the part in a tile, given by its number and its first pixel.
    fn draw(&self, level: Level, tile: &mut Tile, number: usize, origin: [i32; 2]);
}

/// An object on the screen and its shader.
pub(super) struct Shaded<'a, Sh, const N: usize> {
    pub(super) front: &'a Front,
    pub(super) shader: Sh,
}

impl<Sh: Shader<N>, const N: usize> Batch for Shaded<'_, Sh, N> {
    fn touches(&self, number: usize) -> bool {
        self.front.chunks.iter().any(|chunk| !chunk.of_tile(number).is_empty())
    }

    fn draw(&self, level: Level, tile: &mut Tile, number: usize, origin: [i32; 2]) {
        // Not `dispatch!`: machines that have SSE4.2 and no AVX2 are rare, and every set is one more kernel for every method.
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(avx512) = level.as_avx512() {
                return avx512.vectorize(
                    #[inline(always)]
                    || self.draw_lanes(avx512, tile, number, origin),
                );
            }
            if let Some(avx2) = level.as_avx2() {
                return avx2.vectorize(
                    #[inline(always)]
                    || self.draw_lanes(avx2, tile, number, origin),
                );
            }
            if let Some(sse2) = level.as_sse2() {
                sse2.vectorize(
                    #[inline(always)]
                    || self.draw_lanes(sse2, tile, number, origin),
                );
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!(level, simd => self.draw_lanes(simd, tile, number, origin));
    }
}

impl<Sh: Shader<N>, const N: usize> Shaded<'_, Sh, N> {
    #[inline(always)]
    fn draw_lanes<S: Simd>(&self, simd: S, tile: &mut Tile, number: usize, origin: [i32; 2]) {
        let mut group = Group::default();
        for chunk in &self.front.chunks {
            for numbers in chunk.of_tile(number).chunks(16) {
                for (lane, &triangle) in numbers.iter().enumerate() {
                    let corners = &chunk.triangles[triangle as usize].corners;
                    group.set(
                        lane,
                        &three!(i => match Triangle::cut(corners[i]) {
                            None => self.front.vertices[corners[i] as usize],
                            Some(cut) => chunk.cut[cut].screen,
                        }),
                    );
                }
                group.set_up(simd, numbers.len(), origin);
                for (lane, &triangle) in numbers.iter().enumerate() {
                    self.draw_triangle(simd, chunk, &chunk.triangles[triangle as usize], &group, lane, tile);
                }
            }
        }
    }

    #[inline(always)]
    fn draw_triangle<S: Simd>(
        &self,
        simd: S,
        chunk: &Chunk,
        triangle: &Triangle,
        group: &Group,
        lane: usize,
        tile: &mut Tile,
    ) {
        let (edges, depth, start) = (group.edges(lane), group.depth(lane), group.start(lane));
        let [x0, x1, y0, y1] = group.bounds(lane);
        let over_block = edges.over_block(simd);
        let [lane_x, lane_y] = pixels(simd);
        let reach = BlockReach::new(&depth);
        let in_columns = columns([x0, x1]);
        // Few blocks are looked at one by one.
        let wide = x1 / BLOCK as i32 > x0 / BLOCK as i32 + 1;
        let mut set_up = None;
        for by in y0 / BLOCK as i32..=y1 / BLOCK as i32 {
            let y0 = start[1] + (by * BLOCK as i32) as f32;
            let (mut left, mut all) = (in_columns, 0);
            if wide {
                let (some, whole) = edges.row(simd, by);
                left &= some & reach.before(simd, &depth, start[0], y0, tile.farthest(simd, by as usize));
                all = whole;
            }
            let y = lane_y + y0;
            while left != 0 {
                let bx = left.trailing_zeros() as i32;
                left &= left - 1;
                let x0 = start[0] + (bx * BLOCK as i32) as f32;
                let x = lane_x + x0;
                let z = depth.at(simd, x, y);
                let block = by as usize * BLOCKS + bx as usize;
                let before = tile.depth(simd, block);
                let mut visible = z.simd_lt(before);
                if all >> bx & 1 == 0 {
                    visible &= edges.inside(simd, &over_block, bx, by);
                }
                let bits = visible.to_bitmask();
                if bits == 0 {
                    continue;
                }
                let farthest = (bits == 0xffff).then(|| reach.farthest(&depth, x0, y0));
                tile.set_depth(block, visible.select(z, before), farthest);
                if set_up.is_none() {
                    let attributes = three!(i => self.attributes_of(chunk, triangle.corners[i]));
                    set_up = Some(self.shader.set_up(&Seen { triangle, attributes, sides: group.sides(lane), chunk }));
                }
                let Some(set_up) = &set_up else { continue };
                let color = self.shader.shade(simd, set_up, &Block { x, y, visible });
                let color = if bits == 0xffff { color } else { visible.select(color, tile.color(simd, block)) };
                tile.set_color(block, color);
            }
        }
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

/// How far depth reaches within a block from its first pixel: down and up.
struct BlockReach {
    nearer: f32,
    farther: f32,
}

impl BlockReach {
    fn new(depth: &Plane) -> Self {
        let side = (BLOCK - 1) as f32;
        Self {
            nearer: side * (depth.dx.min(0.0) + depth.dy.min(0.0)),
            farther: side * (depth.dx.max(0.0) + depth.dy.max(0.0)),
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
    fn farthest(&self, depth: &Plane, x: f32, y: f32) -> f32 {
        depth.at_corner + depth.dx * x + depth.dy * y + self.farther + 1e-5
    }
}
