//! Sixteen triangles made ready for a tile together.
//!
//! Most triangles of a fine mesh cover a few pixels, and what is done once for each (edges, bounds, the plane of depth) would
//! cost more than their pixels. It is done in lanes, one triangle each.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16};

use super::buffer::TILE;
use super::cover::Edges;
use super::planes::{Plane, Sides};
use super::samples::places;
use crate::fill::SUBPIXEL_BITS;
use crate::raster::project::ScreenVertex;
use crate::simd::{LANES, three, two};

const ONE: i32 = 1 << SUBPIXEL_BITS;

/// How far from the middle of the tile, in sub-pixels, corners may lie for the functions of edges to fit 32 bits: sides are then
/// at most 96 pixels long, distances to the tile's first pixel 80, and the sum of two products stays below 2³⁰.
const NEAR: i32 = 48 * ONE;

/// Triangles over a tile, planar. What is relative to the tile is so to the centre of its first pixel.
#[derive(Debug, Clone)]
pub(super) struct Group<const SAMPLES: usize> {
    /// Corners in sub-pixels, and their depths.
    x: [[i32; LANES]; 3],
    y: [[i32; LANES]; 3],
    z: [[f32; LANES]; 3],
    /// The edges, see [`Edges`].
    a: [[i32; LANES]; 3],
    b: [[i32; LANES]; 3],
    c: [[[i32; LANES]; 3]; SAMPLES],
    /// First and last pixel, along x and along y.
    bounds: [[i32; LANES]; 4],
    /// From the first corner to the tile, in pixels.
    start: [[f32; LANES]; 2],
    first: [[f32; LANES]; 2],
    second: [[f32; LANES]; 2],
    inv_area2: [f32; LANES],
    depth_dx: [f32; LANES],
    depth_dy: [f32; LANES],
}

impl<const SAMPLES: usize> Default for Group<SAMPLES> {
    fn default() -> Self {
        let (whole, real) = ([0; LANES], [0.0; LANES]);
        Self {
            x: [whole; 3],
            y: [whole; 3],
            z: [real; 3],
            a: [whole; 3],
            b: [whole; 3],
            c: [[whole; 3]; SAMPLES],
            bounds: [whole; 4],
            start: [real; 2],
            first: [real; 2],
            second: [real; 2],
            inv_area2: real,
            depth_dx: real,
            depth_dy: real,
        }
    }
}

impl<const SAMPLES: usize> Group<SAMPLES> {
    /// Puts a triangle into a lane. Its corners run clockwise on the screen.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, corners: &[ScreenVertex; 3]) {
        for (i, corner) in corners.iter().enumerate() {
            (self.x[i][lane], self.y[i][lane], self.z[i][lane]) = (corner.x, corner.y, corner.z);
        }
    }

    /// Makes the first `count` triangles ready for the tile whose first pixel is `origin`.
    #[inline(always)]
    pub(super) fn set_up<S: Simd>(&mut self, simd: S, count: usize, origin: [i32; 2]) {
        let centre = origin.map(|o| o * ONE + ONE / 2);
        let x = three!(i => i32x16::load_array_ref(simd, &self.x[i]) - centre[0]);
        let y = three!(i => i32x16::load_array_ref(simd, &self.y[i]) - centre[1]);
        self.set_bounds(simd, 0, x);
        self.set_bounds(simd, 2, y);
        let zero = i32x16::splat(simd, 0);
        for i in 0..3 {
            let (from, to) = ((i + 1) % 3, (i + 2) % 3);
            let (dx, dy) = (x[to] - x[from], y[to] - y[from]);
            // At the tile's first pixel: the same as in `Edges::new`, in 32 bits.
            let value = dy * x[from] - dx * y[from];
            let top_left = dy.simd_lt(zero) | (dy.simd_eq(zero) & dx.simd_gt(zero));
            let value = value - top_left.select(zero, zero + 1);
            (-dy).store_array(&mut self.a[i]);
            dx.store_array(&mut self.b[i]);
            for (c, [right, down]) in self.c.iter_mut().zip(places::<SAMPLES>()) {
                ((value - dy * right + dx * down) >> SUBPIXEL_BITS).store_array(&mut c[i]);
            }
        }
        self.set_planes(simd, x, y);
        let middle = (TILE as i32 / 2) * ONE;
        let off = three!(i => (x[i] - middle).abs().max((y[i] - middle).abs()));
        let far = off[0].max(off[1]).max(off[2]).simd_gt(i32x16::splat(simd, NEAR));
        let mut large = far.to_bitmask() & (u64::MAX >> (64 - count));
        while large != 0 {
            let lane = large.trailing_zeros() as usize;
            large &= large - 1;
            let corner = |i: usize| ScreenVertex { x: self.x[i][lane], y: self.y[i][lane], ..ScreenVertex::default() };
            let edges = Edges::<SAMPLES>::new(&[corner(0), corner(1), corner(2)], origin);
            for (c, values) in self.c.iter_mut().zip(edges.c) {
                for i in 0..3 {
                    c[i][lane] = values[i];
                }
            }
        }
    }

    /// The pixels of the tile whose samples may lie between the corners, along one axis.
    #[inline(always)]
    fn set_bounds<S: Simd>(&mut self, simd: S, axis: usize, v: [i32x16<S>; 3]) {
        let (low, high) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let reach = places::<SAMPLES>().iter().flatten().fold(0, |reach, &p| p.max(reach));
        let first = ((low + (ONE - 1 - reach)) >> SUBPIXEL_BITS).max(i32x16::splat(simd, 0));
        let last = ((high + reach) >> SUBPIXEL_BITS).min(i32x16::splat(simd, TILE as i32 - 1));
        first.store_array(&mut self.bounds[axis]);
        last.store_array(&mut self.bounds[axis + 1]);
    }

    #[inline(always)]
    fn set_planes<S: Simd>(&mut self, simd: S, x: [i32x16<S>; 3], y: [i32x16<S>; 3]) {
        let scale = 1.0 / ONE as f32;
        let start = two!(k => -[x[0], y[0]][k].to_float::<f32x16<S>>() * scale);
        let first = two!(k => [x[1] - x[0], y[1] - y[0]][k].to_float::<f32x16<S>>() * scale);
        let second = two!(k => [x[2] - x[0], y[2] - y[0]][k].to_float::<f32x16<S>>() * scale);
        let inv_area2 = 1.0 / (first[0] * second[1] - second[0] * first[1]);
        let z = three!(i => f32x16::load_array_ref(simd, &self.z[i]));
        let (b, c) = (z[1] - z[0], z[2] - z[0]);
        let (dx, dy) = ((b * second[1] - c * first[1]) * inv_area2, (c * first[0] - b * second[0]) * inv_area2);
        for k in 0..2 {
            start[k].store_array(&mut self.start[k]);
            first[k].store_array(&mut self.first[k]);
            second[k].store_array(&mut self.second[k]);
        }
        inv_area2.store_array(&mut self.inv_area2);
        dx.store_array(&mut self.depth_dx);
        dy.store_array(&mut self.depth_dy);
    }

    /// The edges of a triangle.
    #[inline(always)]
    pub(super) fn edges(&self, lane: usize) -> Edges<SAMPLES> {
        let mut c = [[0; 3]; SAMPLES];
        for (values, lanes) in c.iter_mut().zip(&self.c) {
            *values = three!(i => lanes[i][lane]);
        }
        Edges { a: three!(i => self.a[i][lane]), b: three!(i => self.b[i][lane]), c }
    }

    /// First and last pixel of the tile that a triangle may touch, along x and along y.
    #[inline(always)]
    pub(super) fn bounds(&self, lane: usize) -> [i32; 4] {
        [self.bounds[0][lane], self.bounds[1][lane], self.bounds[2][lane], self.bounds[3][lane]]
    }

    /// From the first corner of a triangle to the centre of the tile's first pixel, in pixels.
    #[inline(always)]
    pub(super) fn start(&self, lane: usize) -> [f32; 2] {
        two!(k => self.start[k][lane])
    }

    /// The plane of depth.
    #[inline(always)]
    pub(super) fn depth(&self, lane: usize) -> Plane {
        Plane { at_corner: self.z[0][lane], dx: self.depth_dx[lane], dy: self.depth_dy[lane] }
    }

    /// The sides of a triangle.
    #[inline(always)]
    pub(super) fn sides(&self, lane: usize) -> Sides {
        Sides {
            first: two!(k => self.first[k][lane]),
            second: two!(k => self.second[k][lane]),
            inv_area2: self.inv_area2[lane],
        }
    }
}
