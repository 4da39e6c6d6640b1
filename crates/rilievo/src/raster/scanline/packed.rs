//! Both vectors of a light in two registers of four lanes.
//!
//! Left to itself, the compiler packs the six components one way or another, or not at all: the same loop then differs by a
//! third from build to build. Four lanes that are there from the start are the same in every build, and on machines
//! without such registers they are the plain scalar code.

use std::ops::{Add, Mul, Sub};

use glam::{Vec3, Vec4};

use crate::raster::scanline::difference::{OnEdge, OnRow, QuadraticEdge, QuadraticRow, Walk};
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

    /// Each vector divided by the root of its fourth number.
    #[inline]
    fn normalized(self) -> Self {
        let root = |square: f32| Normalized::inverse_root(square);
        Self { light: self.light * root(self.light.w), half: self.half * root(self.half.w) }
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

/// Linear vectors whose squares of lengths, quadratic, are the fourth numbers: they cost no addition of their own then.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalized(Quadratic<Packed>);

impl From<&Normalized> for PackedNormalized {
    fn from(f: &Normalized) -> Self {
        let term = |vectors: Rotated, squares: glam::Vec2| Packed {
            light: vectors.light.extend(squares.x),
            half: vectors.half.extend(squares.y),
        };
        let none = Rotated { light: Vec3::ZERO, half: Vec3::ZERO };
        let (v, s) = (&f.vectors, &f.squares);
        Self(Quadratic {
            a: term(none, s.a),
            b: term(none, s.b),
            c: term(none, s.c),
            d: term(v.a, s.d),
            e: term(v.b, s.e),
            f: term(v.c, s.f),
        })
    }
}

/// [`PackedNormalized`] on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalizedEdge(QuadraticEdge<Packed>);

/// [`PackedNormalized`] along a row: two additions, and a reciprocal root per vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct PackedNormalizedRow(QuadraticRow<Packed>);

impl Walk for PackedNormalized {
    type Edge = PackedNormalizedEdge;

    fn on_edge(&self, x: f32, y: f32, slope: f32) -> PackedNormalizedEdge {
        PackedNormalizedEdge(self.0.on_edge(x, y, slope))
    }
}

impl OnEdge for PackedNormalizedEdge {
    type Row = PackedNormalizedRow;

    #[inline]
    fn row(&self, ahead: f32) -> PackedNormalizedRow {
        PackedNormalizedRow(self.0.row(ahead))
    }

    #[inline]
    fn down(&mut self) {
        self.0.down();
    }
}

impl OnRow for PackedNormalizedRow {
    type Value = Packed;

    #[inline]
    fn value(&self) -> Packed {
        self.0.value().normalized()
    }

    #[inline]
    fn right(&mut self) {
        self.0.right();
    }
}
