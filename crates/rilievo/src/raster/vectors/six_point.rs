//! Polynomials through samples of a triangle, over the screen.

use std::ops::{Add, Mul, Sub};

use glam::{Vec2, Vec3};

use crate::raster::vectors::Rotated;

/// What can be interpolated: a number, a vector, or several.
pub trait Value: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self> {}

impl Value for f32 {}
impl Value for Vec2 {}
impl Value for Vec3 {}
impl Value for Rotated {}

/// Samples of a triangle at its vertices and at the middles of its edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SixSamples<T> {
    /// At vertices 0, 1, 2 (L, M, N of the source's figure 1).
    pub corners: [T; 3],
    /// Between vertices 0 and 1, 0 and 2, 1 and 2 (Q, R, S).
    pub midpoints: [T; 3],
}

/// A triangle on the screen, seen from its vertex 0: where vertices 1 and 2 are from there, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// Vertex 1 − vertex 0.
    pub first: Vec2,
    /// Vertex 2 − vertex 0.
    pub second: Vec2,
}

/// A triangle whose height is less than this share of its longest side is a sliver.
const SLIVER: f32 = 1.0 / 1024.0;

impl Sides {
    /// Whether the triangle is too thin for quadratic polynomials in f32.
    ///
    /// Their coefficients grow with the square of length over height, and cancel: at 1/1024 an error of up to 3e-2 is
    /// left. Slivers cover next to nothing, and a linear function is good enough for them.
    pub fn is_sliver(&self) -> bool {
        let longest = self.first.length_squared().max(self.second.length_squared());
        let longest = longest.max(self.first.distance_squared(self.second));
        self.first.perp_dot(self.second).abs() < SLIVER * longest
    }
}

/// From the screen to the ortho-normalised triangle, on which vertices 0, 1, 2 lie at (u, v) = (0, 0), (1, 0), (0, 1).
///
/// u = α_u x + β_u y, v = α_v x + β_v y, with x, y in pixels from vertex 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToNormalized {
    /// α_u, α_v: change of u and of v to the next pixel to the right.
    pub alpha: [f32; 2],
    /// β_u, β_v: change of u and of v to the next pixel below.
    pub beta: [f32; 2],
}

impl ToNormalized {
    /// Equations (12)-(18). `None` for a triangle without area.
    pub fn new(triangle: &Sides) -> Option<Self> {
        let (p1, p2) = (triangle.first, triangle.second);
        let omega = reciprocal(p1.perp_dot(p2))?;
        Some(Self { alpha: [p2.y * omega, -p1.y * omega], beta: [-p2.x * omega, p1.x * omega] })
    }
}

/// `None` for zero, for what is no number, and where the reciprocal is none.
fn reciprocal(x: f32) -> Option<f32> {
    Some(x.recip()).filter(|r| r.is_finite() && *r != 0.0)
}

/// A linear function of two coordinates: `a·x + b·y + c`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear<T> {
    /// Of x: the change to the next pixel to the right.
    pub a: T,
    /// Of y: the change to the next pixel below.
    pub b: T,
    /// At (0, 0), vertex 0.
    pub c: T,
}

impl<T: Value> Linear<T> {
    /// Over (u, v), through the three vertices: equations (24)-(26).
    pub fn on_normalized(corners: [T; 3]) -> Self {
        let [l, m, n] = corners;
        Self { a: m - l, b: n - l, c: l }
    }

    /// The same function over the screen: equation (28).
    pub fn to_screen(self, map: &ToNormalized) -> Self {
        let along = |[u, v]: [f32; 2]| self.a * u + self.b * v;
        Self { a: along([map.alpha[0], map.alpha[1]]), b: along([map.beta[0], map.beta[1]]), c: self.c }
    }

    /// Its value.
    pub fn at(&self, x: f32, y: f32) -> T {
        self.a * x + self.b * y + self.c
    }
}

/// A quadratic function of two coordinates: `a·x² + b·y² + c·xy + d·x + e·y + f`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadratic<T> {
    /// Of x².
    pub a: T,
    /// Of y².
    pub b: T,
    /// Of xy.
    pub c: T,
    /// Of x.
    pub d: T,
    /// Of y.
    pub e: T,
    /// At (0, 0), vertex 0.
    pub f: T,
}

impl<T: Value> Quadratic<T> {
    /// Over (u, v), through all six samples: equations (5)-(10), with M at u = 1 and N at v = 1.
    pub fn on_normalized(samples: &SixSamples<T>) -> Self {
        let [l, m, n] = samples.corners;
        let [q, r, s] = samples.midpoints;
        let a = (l + m - q * 2.0) * 2.0;
        let b = (l + n - r * 2.0) * 2.0;
        Self { a, b, c: (l + s - r - q) * 4.0, d: m - l - a, e: n - l - b, f: l }
    }

    /// The same function over the screen: (12) and (13) put into (11).
    pub fn to_screen(self, map: &ToNormalized) -> Self {
        let ([au, av], [bu, bv]) = (map.alpha, map.beta);
        let Self { a, b, c, d, e, f } = self;
        Self {
            a: a * (au * au) + b * (av * av) + c * (au * av),
            b: a * (bu * bu) + b * (bv * bv) + c * (bu * bv),
            c: a * (2.0 * au * bu) + b * (2.0 * av * bv) + c * (au * bv + av * bu),
            d: d * au + e * av,
            e: d * bu + e * bv,
            f,
        }
    }

    /// Over the screen at once, by solving for the coefficients where the samples lie.
    ///
    /// The middles of the edges part the equations: second differences along the edges have to be those of a, b and c
    /// (three equations), slopes at vertex 0 those of d and e (two). `None` for a triangle without area.
    ///
    /// - **Source:** Abbas et al. 2001: setup on the actual triangle. The same polynomial as [`Self::on_normalized`]
    ///   makes and maps to the screen, to rounding, at a higher price.
    pub fn on_actual(samples: &SixSamples<T>, triangle: &Sides) -> Option<Self> {
        let (Vec2 { x: x1, y: y1 }, Vec2 { x: x2, y: y2 }) = (triangle.first, triangle.second);
        let [l, m, n] = samples.corners;
        let [q, r, s] = samples.midpoints;
        // d·xᵢ + e·yᵢ = slopes: by Cramer's rule.
        let (slope1, slope2) = ((q - l) * 4.0 - (m - l), (r - l) * 4.0 - (n - l));
        let inverse = reciprocal(x1 * y2 - x2 * y1)?;
        let d = (slope1 * y2 - slope2 * y1) * inverse;
        let e = (slope2 * x1 - slope1 * x2) * inverse;
        // Rows of a, b, c: second differences along the edge to vertex 1, to vertex 2, and mixed.
        let rows = [
            [x1 * x1, y1 * y1, x1 * y1],
            [x2 * x2, y2 * y2, x2 * y2],
            [2.0 * x1 * x2, 2.0 * y1 * y2, x1 * y2 + x2 * y1],
        ];
        let right = [(l + m - q * 2.0) * 2.0, (l + n - r * 2.0) * 2.0, (l + s - r - q) * 4.0];
        let cofactor = |i: usize, j: usize| {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            rows[i1][j1] * rows[i2][j2] - rows[i1][j2] * rows[i2][j1]
        };
        let inverse = reciprocal((0..3).map(|j| rows[0][j] * cofactor(0, j)).sum())?;
        let solve =
            |j: usize| (right[0] * cofactor(0, j) + right[1] * cofactor(1, j) + right[2] * cofactor(2, j)) * inverse;
        Some(Self { a: solve(0), b: solve(1), c: solve(2), d, e, f: l })
    }

    /// Its value, by Horner's scheme: what does not depend on x is the same along a row.
    pub fn at(&self, x: f32, y: f32) -> T {
        (self.a * x + (self.c * y + self.d)) * x + ((self.b * y + self.e) * y + self.f)
    }
}

impl Quadratic<f32> {
    /// The square of the length of a linearly interpolated vector, over the same coordinates.
    ///
    /// - **Source:** Duff 1979; equations (37)-(42), whose products are dot products and whose last term is C·C (the
    ///   print has C).
    pub fn squared_length(vector: &Linear<Vec3>) -> Self {
        let Linear { a, b, c } = *vector;
        Self { a: a.dot(a), b: b.dot(b), c: 2.0 * a.dot(b), d: 2.0 * a.dot(c), e: 2.0 * b.dot(c), f: c.dot(c) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles of every shape and winding, none of them thinner than a hundredth of its length.
    fn triangles() -> impl Iterator<Item = Sides> {
        shaped(0.01..1.0).take(500)
    }

    /// Height over longest side.
    fn thinness(t: &Sides) -> f64 {
        let (a, b) = (t.first.as_dvec2(), t.second.as_dvec2());
        a.perp_dot(b).abs() / a.length_squared().max(b.length_squared()).max(a.distance_squared(b))
    }

    /// Triangles of a given range of thinness.
    fn shaped(thin: std::ops::Range<f64>) -> impl Iterator<Item = Sides> {
        let mut random = testkit::Random::new(7);
        std::iter::repeat_with(move || {
            let mut coordinate = || (random.unit() as f32 - 0.5) * 200.0;
            let mut point = || Vec2::new(coordinate(), coordinate());
            Sides { first: point(), second: point() }
        })
        .filter(move |t| thin.contains(&thinness(t)))
    }

    /// A known quadratic in pixels, in f64.
    fn known(x: f64, y: f64) -> f64 {
        3e-5 * x * x - 5e-5 * y * y + 2e-5 * x * y + 0.004 * x - 0.007 * y + 0.6
    }

    fn samples_of(f: impl Fn(f64, f64) -> f64, t: &Sides) -> SixSamples<f32> {
        let at = |p: Vec2| f(f64::from(p.x), f64::from(p.y)) as f32;
        let middle = (t.first + t.second) * 0.5;
        SixSamples {
            corners: [at(Vec2::ZERO), at(t.first), at(t.second)],
            midpoints: [at(t.first * 0.5), at(t.second * 0.5), at(middle)],
        }
    }

    /// Points inside a triangle.
    fn inside(t: &Sides) -> impl Iterator<Item = Vec2> {
        let t = *t;
        (0..=8).flat_map(move |i| (0..=8 - i).map(move |j| (t.first * i as f32 + t.second * j as f32) / 8.0))
    }

    #[test]
    fn six_samples_are_met_on_the_normalised_triangle() {
        let samples = SixSamples { corners: [1.0, -2.0, 5.0], midpoints: [0.5, 3.0, -7.0] };
        let q = Quadratic::on_normalized(&samples);
        let at = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)];
        let found = at.map(|(u, v)| q.at(u, v));
        assert_eq!(found, [1.0, -2.0, 5.0, 0.5, 3.0, -7.0]);
    }

    #[test]
    fn normalised_coordinates_of_the_vertices() {
        for t in triangles() {
            let map = ToNormalized::new(&t).unwrap();
            let uv =
                |p: Vec2| Vec2::new(map.alpha[0] * p.x + map.beta[0] * p.y, map.alpha[1] * p.x + map.beta[1] * p.y);
            assert!((uv(t.first) - Vec2::X).length() < 1e-4 && (uv(t.second) - Vec2::Y).length() < 1e-4, "{t:?}");
        }
    }

    #[test]
    fn both_setups_find_a_known_polynomial() {
        let (mut worst_normalized, mut worst_actual) = (0.0f64, 0.0f64);
        for t in triangles() {
            let samples = samples_of(known, &t);
            let map = ToNormalized::new(&t).unwrap();
            let normalized = Quadratic::on_normalized(&samples).to_screen(&map);
            let actual = Quadratic::on_actual(&samples, &t).unwrap();
            for p in inside(&t) {
                let expected = known(f64::from(p.x), f64::from(p.y));
                worst_normalized = worst_normalized.max((f64::from(normalized.at(p.x, p.y)) - expected).abs());
                worst_actual = worst_actual.max((f64::from(actual.at(p.x, p.y)) - expected).abs());
            }
        }
        // Values up to 2; the actual triangle's determinant is the cube of the area, so rounding grows on thin ones.
        assert!(worst_normalized < 2e-5, "{worst_normalized}");
        assert!(worst_actual < 2e-3, "{worst_actual}");
    }

    #[test]
    fn linear_plane_meets_the_vertices_and_the_quadratic_of_a_plane_is_that_plane() {
        let plane = |x: f64, y: f64| 0.01 * x - 0.02 * y + 0.3;
        for t in triangles() {
            let samples = samples_of(plane, &t);
            let map = ToNormalized::new(&t).unwrap();
            let linear = Linear::on_normalized(samples.corners).to_screen(&map);
            let quadratic = Quadratic::on_normalized(&samples).to_screen(&map);
            for p in inside(&t) {
                let expected = plane(f64::from(p.x), f64::from(p.y));
                assert!((f64::from(linear.at(p.x, p.y)) - expected).abs() < 1e-4, "{t:?}");
                assert!((f64::from(quadratic.at(p.x, p.y)) - expected).abs() < 1e-4, "{t:?}");
            }
        }
    }

    #[test]
    fn squared_length_is_that_of_the_interpolated_vector() {
        let corners = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -0.6, 0.8), Vec3::new(-0.48, 0.64, 0.6)];
        for t in triangles() {
            let vector = Linear::on_normalized(corners).to_screen(&ToNormalized::new(&t).unwrap());
            let square = Quadratic::squared_length(&vector);
            for p in inside(&t) {
                // Weights of the corners, computed without the map.
                let area = t.first.as_dvec2().perp_dot(t.second.as_dvec2());
                let (u, v) = (
                    p.as_dvec2().perp_dot(t.second.as_dvec2()) / area,
                    t.first.as_dvec2().perp_dot(p.as_dvec2()) / area,
                );
                let [l, m, n] = corners.map(Vec3::as_dvec3);
                let expected = (l * (1.0 - u - v) + m * u + n * v).length_squared();
                let error = (f64::from(square.at(p.x, p.y)) - expected).abs();
                // Cancellation, see `Sides::is_sliver`.
                assert!(error < 1e-6 / thinness(&t).powi(2).min(0.1), "{t:?}: {expected}, off by {error}");
            }
        }
    }

    #[test]
    fn thinnest_triangles_that_are_no_slivers_keep_their_polynomial() {
        // Over the normalised triangle, with the second differences of vectors that turn by half a right angle.
        let bent = |u: f64, v: f64| 1.0 - 0.15 * u * u - 0.1 * v * v + 0.2 * u * v + 0.3 * u - 0.5 * v;
        let at = |u, v| bent(u, v) as f32;
        let samples = SixSamples {
            corners: [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)],
            midpoints: [at(0.5, 0.0), at(0.0, 0.5), at(0.5, 0.5)],
        };
        let mut worst = 0.0f64;
        for t in shaped(1.0 / 1024.0..1.0 / 800.0).take(100) {
            assert!(!t.is_sliver());
            let q = Quadratic::on_normalized(&samples).to_screen(&ToNormalized::new(&t).unwrap());
            let area = t.first.as_dvec2().perp_dot(t.second.as_dvec2());
            for p in inside(&t) {
                let (u, v) = (p.as_dvec2().perp_dot(t.second.as_dvec2()), t.first.as_dvec2().perp_dot(p.as_dvec2()));
                worst = worst.max((f64::from(q.at(p.x, p.y)) - bent(u / area, v / area)).abs());
            }
        }
        assert!(worst < 0.04, "{worst}");
        assert!(shaped(0.0..1.0 / 1100.0).take(100).all(|t| t.is_sliver()));
    }

    #[test]
    fn triangles_without_area_and_nan_are_refused() {
        let samples = SixSamples { corners: [0.0f32; 3], midpoints: [0.0; 3] };
        for second in [Vec2::new(2.0, 4.0), Vec2::ZERO, Vec2::NAN, Vec2::INFINITY] {
            let t = Sides { first: Vec2::new(1.0, 2.0), second };
            assert_eq!(ToNormalized::new(&t), None, "{second}");
            assert_eq!(Quadratic::on_actual(&samples, &t), None, "{second}");
        }
    }
}
