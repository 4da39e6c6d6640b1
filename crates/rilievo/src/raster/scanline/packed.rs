//! Both vectors of a light in two registers of four lanes.
//!
//! Left to itself, the compiler packs the six components one way or another, or not at all: the same loop then differs by a
//! third from build to build. Four lanes that are there from the start are the same in every build, and on machines
//! without such registers they are the plain scalar code.

use std::ops::{Add, Mul, Sub};

use glam::{Vec2, Vec4};

use crate::raster::scanline::difference::{LinearEdge, LinearRow, OnEdge, OnRow, QuadraticEdge, QuadraticRow, Walk};
use crate::raster::vectors::{Linear, Normalized, Quadratic, Rotated, Value};

/// L' and H', each with a fourth number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Packed {
    pub(super) light: Vec4,
    pub(super) half: Vec4,
}

impl Packed {
    /// The vectors, without the fourth numbers.
    pub(super) fn vectors(self) -> Rotated {
        Rotated { light: self.light.truncate(), half: self.half.truncate() }
    }

    /// Each vector divided by the root of its square.
    #[inline]
    fn normalized(self, squares: Vec2) -> Self {
        let [light, half] = [squares.x, squares.y].map(Normalized::inverse_root);
        Self { light: self.light * light, half: self.half * half }
    }
}

impl From<Rotated> for Packed {
    fn from(r: Rotated) -> Self {
        Self { light: r.light.extend(0.0), half: r.half.extend(0.0) }
    }
}

impl Add for Packed {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { light: self.light + other.light, half: self.half + other.half }
    }
}

impl Sub for Packed {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { light: self.light - other.light, half: self.half - other.half }
    }
}

impl Mul<f32> for Packed {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f32) -> Self {
        Self { light: self.light * factor, half: self.half * factor }
    }
}

impl Value for Packed {}

/// The same linear function.
pub(super) fn linear(f: &Linear<Rotated>) -> Linear<Packed> {
    Linear { a: f.a.into(), b: f.b.into(), c: f.c.into() }
}

/// The same quadratic function.
pub(super) fn quadratic(f: &Quadratic<Rotated>) -> Quadratic<Packed> {
    Quadratic { a: f.a.into(), b: f.b.into(), c: f.c.into(), d: f.d.into(), e: f.e.into(), f: f.f.into() }
}

/// Linear vectors and the squares of their lengths, apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalized {
    vectors: Linear<Packed>,
    squares: Quadratic<Vec2>,
}

impl From<&Normalized> for PackedNormalized {
    fn from(f: &Normalized) -> Self {
        Self { vectors: linear(&f.vectors), squares: f.squares }
    }
}

/// [`PackedNormalized`] on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalizedEdge {
    vectors: LinearEdge<Packed>,
    squares: QuadraticEdge<Vec2>,
}

/// [`PackedNormalized`] along a row: one addition for each vector, two for each square, and a reciprocal root per vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalizedRow {
    vectors: LinearRow<Packed>,
    squares: QuadraticRow<Vec2>,
}

impl Walk for PackedNormalized {
    type Edge = PackedNormalizedEdge;

    fn on_edge(&self, x: f32, y: f32, slope: f32) -> PackedNormalizedEdge {
        PackedNormalizedEdge { vectors: self.vectors.on_edge(x, y, slope), squares: self.squares.on_edge(x, y, slope) }
    }
}

impl OnEdge for PackedNormalizedEdge {
    type Row = PackedNormalizedRow;

    #[inline]
    fn row(&self, ahead: f32) -> PackedNormalizedRow {
        PackedNormalizedRow { vectors: self.vectors.row(ahead), squares: self.squares.row(ahead) }
    }

    #[inline]
    fn down(&mut self) {
        self.vectors.down();
        self.squares.down();
    }
}

impl OnRow for PackedNormalizedRow {
    type Value = Packed;

    #[inline]
    fn value(&self) -> Packed {
        self.vectors.value().normalized(self.squares.value())
    }

    #[inline]
    fn right(&mut self) {
        self.vectors.right();
        self.squares.right();
    }
}
