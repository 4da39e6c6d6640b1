//! The vectors of one light over one triangle of the screen.

use glam::{Vec2, Vec3};

use crate::raster::vectors::{
    Corner, Linear, Midpoints, Order, Quadratic, Rotated, Sides, SixSamples, ToNormalized, Viewer,
};

/// How L' and H' get from the corners of a triangle to its pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Linear, and left as short as they become.
    Linear,
    /// Linear, and divided by their length: its square is quadratic, and a pixel costs a reciprocal root per vector.
    Normalized,
    /// Quadratic through six samples, of about unit length without division or root.
    Quadratic {
        /// How the samples between the corners are made.
        midpoints: Midpoints,
        /// Whether triangles may be linear.
        order: Order,
    },
}

/// Linear vectors and the squares of their lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normalized {
    /// The vectors.
    pub vectors: Linear<Rotated>,
    /// The squares of the lengths of L' and of H'.
    pub squares: Quadratic<Vec2>,
}

impl Normalized {
    /// Squares from the vectors: Duff's denominator, over the same coordinates.
    pub fn new(vectors: Linear<Rotated>) -> Self {
        let of = |vector: fn(&Rotated) -> Vec3| {
            let Linear { a, b, c } = &vectors;
            Quadratic::squared_length(&Linear { a: vector(a), b: vector(b), c: vector(c) })
        };
        let (light, half) = (of(|r| r.light), of(|r| r.half));
        let both = |term: fn(&Quadratic<f32>) -> f32| Vec2::new(term(&light), term(&half));
        let squares = Quadratic {
            a: both(|q| q.a),
            b: both(|q| q.b),
            c: both(|q| q.c),
            d: both(|q| q.d),
            e: both(|q| q.e),
            f: both(|q| q.f),
        };
        Self { vectors, squares }
    }

    /// The vectors divided by the roots of `squares`.
    #[inline]
    pub fn normalize(vectors: Rotated, squares: Vec2) -> Rotated {
        Rotated { light: vectors.light * inverse_root(squares.x), half: vectors.half * inverse_root(squares.y) }
    }
}

/// 1/√x; finite where rounding made the square of a length zero or less.
#[inline]
fn inverse_root(x: f32) -> f32 {
    // A comparison and not `max`, which has to look for NaN as well.
    let x = if x > f32::MIN_POSITIVE { x } else { f32::MIN_POSITIVE };
    1.0 / x.sqrt()
}

/// Polynomials over the screen, in pixels from vertex 0 of the triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Field {
    /// Not normalised.
    Linear(Linear<Rotated>),
    /// Linear and normalised.
    Normalized(Normalized),
    /// Quadratic.
    Quadratic(Quadratic<Rotated>),
}

impl Field {
    /// For a triangle with the given corners and the vectors in them; `None` for one without area.
    ///
    /// Slivers are always linear, see [`Sides::is_sliver`]. `shininess` is for [`Order::Auto`].
    ///
    /// - **Determinism:** class A.
    pub fn new<F: Fn(Vec3) -> Option<Vec3>>(
        how: Interpolation,
        (corners, at_corners): (&[Corner; 3], &[Rotated; 3]),
        sides: &Sides,
        viewer: &Viewer<F>,
        shininess: f32,
    ) -> Option<Self> {
        let map = ToNormalized::new(sides)?;
        let linear = || Linear::on_normalized(*at_corners).to_screen(&map);
        Some(match how {
            _ if sides.is_sliver() => Self::Linear(linear()),
            Interpolation::Linear => Self::Linear(linear()),
            Interpolation::Normalized => Self::Normalized(Normalized::new(linear())),
            Interpolation::Quadratic { midpoints, order } if order.is_quadratic(at_corners, shininess) => {
                let between = |i: usize, j: usize| {
                    midpoints.between((&corners[i], &at_corners[i]), (&corners[j], &at_corners[j]), viewer)
                };
                let samples =
                    SixSamples { corners: *at_corners, midpoints: [between(0, 1), between(0, 2), between(1, 2)] };
                Self::Quadratic(Quadratic::on_normalized(&samples).to_screen(&map))
            }
            Interpolation::Quadratic { .. } => Self::Linear(linear()),
        })
    }

    /// The vectors at a point, in pixels from vertex 0.
    pub fn at(&self, x: f32, y: f32) -> Rotated {
        match self {
            Self::Linear(f) => f.at(x, y),
            Self::Normalized(f) => Normalized::normalize(f.vectors.at(x, y), f.squares.at(x, y)),
            Self::Quadratic(f) => f.at(x, y),
        }
    }
}
