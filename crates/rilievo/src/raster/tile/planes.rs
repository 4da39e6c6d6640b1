//! Vertex attributes as planes over the screen.
//!
//! Whatever is linear on the screen (attributes divided by w, 1/w, depth) is a plane over each triangle: a value at the first
//! corner and its change along x and y. All attributes of a vertex are one array, so that the planes of all of them are made
//! by a handful of vector operations, when a triangle first meets a pixel of a tile.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use super::batch::Part;
use crate::simd::splat;

/// Two sides of a screen triangle from its first corner, and one over twice its area; pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    pub(super) first: [f32; 2],
    pub(super) second: [f32; 2],
    pub(super) inv_area2: f32,
}

impl Sides {
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

    /// Writes `M` that follow each other, from `first` on, into the pixels of a part.
    #[inline(always)]
    pub(super) fn enter<S: Simd, U, const M: usize>(
        &self,
        simd: S,
        part: &Part<'_, S, U>,
        first: usize,
        values: &mut [f32x16<S>; M],
    ) {
        for (i, value) in values.iter_mut().enumerate() {
            *value = part.lanes.select(self.get(first + i).at(simd, part.x, part.y), *value);
        }
    }
}
