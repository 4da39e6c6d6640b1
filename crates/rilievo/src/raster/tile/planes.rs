//! Vertex attributes as planes over the screen.
//!
//! Whatever is linear on the screen (attributes divided by w, 1/w, depth) is a plane over each triangle: a value at the first
//! corner and its change along x and y. All attributes of a vertex are one array, so that the planes of all of them are made
//! by a handful of vector operations, when a triangle first meets a pixel of a tile.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use crate::fill::SUBPIXEL_BITS;
use crate::raster::project::ScreenVertex;
use crate::simd::{splat, three};

/// Two sides of a screen triangle from its first corner, and one over twice its area; pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    first: [f32; 2],
    second: [f32; 2],
    inv_area2: f32,
}

impl Sides {
    /// Of a triangle that has an area.
    pub(super) fn new(corners: &[ScreenVertex; 3]) -> Self {
        let scale = 1.0 / (1 << SUBPIXEL_BITS) as f32;
        let side = |to: usize| {
            [(corners[to].x - corners[0].x) as f32 * scale, (corners[to].y - corners[0].y) as f32 * scale]
        };
        let (first, second) = (side(1), side(2));
        Self { first, second, inv_area2: 1.0 / (first[0] * second[1] - second[0] * first[1]) }
    }

    /// The plane through three values.
    #[inline(always)]
    pub(super) fn plane(&self, [a, b, c]: [f32; 3]) -> Plane {
        let (b, c) = (b - a, c - a);
        Plane {
            at_corner: a,
            dx: (b * self.second[1] - c * self.first[1]) * self.inv_area2,
            dy: (c * self.first[0] - b * self.second[0]) * self.inv_area2,
        }
    }

    /// The planes through `N` values at each corner.
    #[inline(always)]
    pub(super) fn planes<const N: usize>(&self, [a, b, c]: [&[f32; N]; 3]) -> Planes<N> {
        let mut planes = Planes { at_corner: *a, dx: [0.0; N], dy: [0.0; N] };
        for i in 0..N {
            let plane = self.plane([a[i], b[i], c[i]]);
            (planes.dx[i], planes.dy[i]) = (plane.dx, plane.dy);
        }
        planes
    }

    /// Sides as the rooms of interpolated vectors take them.
    pub(super) fn for_vectors(&self) -> crate::raster::vectors::Sides {
        crate::raster::vectors::Sides { first: self.first.into(), second: self.second.into() }
    }
}

/// A linear function over the screen; x and y are relative to the triangle's first corner, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    pub(super) at_corner: f32,
    pub(super) dx: f32,
    pub(super) dy: f32,
}

impl Plane {
    /// Its value at sixteen places.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, x: f32x16<S>, y: f32x16<S>) -> f32x16<S> {
        splat(simd, self.dx).mul_add(x, splat(simd, self.dy).mul_add(y, splat(simd, self.at_corner)))
    }
}

/// `N` planes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Planes<const N: usize> {
    at_corner: [f32; N],
    dx: [f32; N],
    dy: [f32; N],
}

impl<const N: usize> Planes<N> {
    /// One of them.
    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> Plane {
        Plane { at_corner: self.at_corner[i], dx: self.dx[i], dy: self.dy[i] }
    }

    /// Three that follow each other, at sixteen places.
    #[inline(always)]
    pub(super) fn vector<S: Simd>(&self, simd: S, first: usize, x: f32x16<S>, y: f32x16<S>) -> [f32x16<S>; 3] {
        three!(i => self.get(first + i).at(simd, x, y))
    }
}
