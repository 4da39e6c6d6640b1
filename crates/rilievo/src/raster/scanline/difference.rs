//! Forward differences: polynomials on their way down an edge and along a row.
//!
//! Along the left edge, which moves by its slope `k` from row to row, a polynomial over the screen is one of the same
//! degree in the row, so additions carry its value and its slope along x from row to row. A row begins at the centre of
//! its first pixel, up to a pixel to the right of the edge, with the exact value there.
//!
//! - **Source:** equations (28)-(32) and the pseudo code of section 3 of Hast, Barrera, Bengtsson for the linear case,
//!   whose middle term of (30) must be b·v; the quadratic case follows in the same way. The source begins rows at the edge
//!   itself, an error of up to a pixel.

use glam::Vec2;

use crate::raster::vectors::{Linear, Normalized, Quadratic, Rotated, Value};

/// A polynomial that can be walked.
pub(super) trait Walk: Copy {
    /// It on the left edge.
    type Edge: OnEdge;

    /// On an edge that crosses a row's centre line at (`x`, `y`) and moves by `slope` per row.
    fn on_edge(&self, x: f32, y: f32, slope: f32) -> Self::Edge;
}

/// A polynomial on the left edge.
pub(super) trait OnEdge {
    /// It along a row.
    type Row: OnRow;

    /// Along this row, from a point `ahead` pixels to the right of the edge.
    fn row(&self, ahead: f32) -> Self::Row;

    /// To the next row.
    fn down(&mut self);
}

/// A polynomial along a row.
pub(super) trait OnRow {
    /// What it is a polynomial of.
    type Value;

    /// Here.
    fn value(&self) -> Self::Value;

    /// To the next pixel.
    fn right(&mut self);
}

/// A linear function on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearEdge<T> {
    value: T,
    down: T,
    right: T,
}

/// A linear function along a row: one addition per pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearRow<T> {
    value: T,
    right: T,
}

impl<T: Value> Walk for Linear<T> {
    type Edge = LinearEdge<T>;

    fn on_edge(&self, x: f32, y: f32, slope: f32) -> LinearEdge<T> {
        LinearEdge { value: self.at(x, y), down: self.a * slope + self.b, right: self.a }
    }
}

impl<T: Value> OnEdge for LinearEdge<T> {
    type Row = LinearRow<T>;

    #[inline]
    fn row(&self, ahead: f32) -> LinearRow<T> {
        LinearRow { value: self.value + self.right * ahead, right: self.right }
    }

    #[inline]
    fn down(&mut self) {
        self.value = self.value + self.down;
    }
}

impl<T: Value> OnRow for LinearRow<T> {
    type Value = T;

    #[inline]
    fn value(&self) -> T {
        self.value
    }

    #[inline]
    fn right(&mut self) {
        self.value = self.value + self.right;
    }
}

/// A quadratic function on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadraticEdge<T> {
    value: T,
    /// First and second difference of the value from row to row.
    down: T,
    down2: T,
    /// Derivative along x, and its difference from row to row.
    slope: T,
    slope_down: T,
    /// The coefficient of x².
    a: T,
}

impl QuadraticEdge<f32> {
    /// A sum of all variables, so that none of them can be left out.
    pub(super) fn sum(&self) -> f32 {
        self.value + self.down + self.down2 + self.slope + self.slope_down + self.a
    }
}

/// A quadratic function along a row: two additions per pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadraticRow<T> {
    value: T,
    right: T,
    right2: T,
}

impl<T: Value> Walk for Quadratic<T> {
    type Edge = QuadraticEdge<T>;

    fn on_edge(&self, x: f32, y: f32, k: f32) -> QuadraticEdge<T> {
        let Self { a, b, c, d, e, .. } = *self;
        // Φ(x + k, y + 1) − Φ(x, y), and its own difference.
        let down = a * (k * (2.0 * x + k)) + b * (2.0 * y + 1.0) + c * (x + k * (y + 1.0)) + d * k + e;
        let down2 = (a * (k * k) + b + c * k) * 2.0;
        let slope = a * (2.0 * x) + c * y + d;
        QuadraticEdge { value: self.at(x, y), down, down2, slope, slope_down: a * (2.0 * k) + c, a }
    }
}

impl<T: Value> OnEdge for QuadraticEdge<T> {
    type Row = QuadraticRow<T>;

    #[inline]
    fn row(&self, ahead: f32) -> QuadraticRow<T> {
        QuadraticRow {
            value: self.value + (self.slope + self.a * ahead) * ahead,
            right: self.slope + self.a * (2.0 * ahead + 1.0),
            right2: self.a * 2.0,
        }
    }

    #[inline]
    fn down(&mut self) {
        self.value = self.value + self.down;
        self.down = self.down + self.down2;
        self.slope = self.slope + self.slope_down;
    }
}

impl<T: Value> OnRow for QuadraticRow<T> {
    type Value = T;

    #[inline]
    fn value(&self) -> T {
        self.value
    }

    #[inline]
    fn right(&mut self) {
        self.value = self.value + self.right;
        self.right = self.right + self.right2;
    }
}

/// Linear vectors and the quadratic squares of their lengths: one and two additions, and a reciprocal root per vector.
impl Walk for Normalized {
    type Edge = NormalizedEdge;

    fn on_edge(&self, x: f32, y: f32, slope: f32) -> NormalizedEdge {
        NormalizedEdge { vectors: self.vectors.on_edge(x, y, slope), squares: self.squares.on_edge(x, y, slope) }
    }
}

/// [`Normalized`] on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalizedEdge {
    vectors: LinearEdge<Rotated>,
    squares: QuadraticEdge<Vec2>,
}

/// [`Normalized`] along a row.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalizedRow {
    vectors: LinearRow<Rotated>,
    squares: QuadraticRow<Vec2>,
}

impl OnEdge for NormalizedEdge {
    type Row = NormalizedRow;

    #[inline]
    fn row(&self, ahead: f32) -> NormalizedRow {
        NormalizedRow { vectors: self.vectors.row(ahead), squares: self.squares.row(ahead) }
    }

    #[inline]
    fn down(&mut self) {
        self.vectors.down();
        self.squares.down();
    }
}

impl OnRow for NormalizedRow {
    type Value = Rotated;

    #[inline]
    fn value(&self) -> Rotated {
        Normalized::normalize(self.vectors.value(), self.squares.value())
    }

    #[inline]
    fn right(&mut self) {
        self.vectors.right();
        self.squares.right();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks 500 rows of 500 pixels down an edge; the largest deviation from the direct value, in f64.
    fn worst(polynomial: impl Walk<Edge: OnEdge<Row: OnRow<Value = f32>>>, direct: impl Fn(f64, f64) -> f64) -> f64 {
        let slope = 0.37f32;
        let (x0, y0) = (3.25, 1.5);
        let mut edge = polynomial.on_edge(x0, y0, slope);
        let mut worst = 0.0f64;
        for j in 0..500 {
            let ahead = (j % 7) as f32 / 7.0;
            let mut row = edge.row(ahead);
            for i in 0..500 {
                let x = f64::from(x0) + f64::from(slope) * f64::from(j) + f64::from(ahead) + f64::from(i);
                worst = worst.max((f64::from(row.value()) - direct(x, f64::from(y0) + f64::from(j))).abs());
                row.right();
            }
            edge.down();
        }
        worst
    }

    #[test]
    fn accumulated_error_of_a_linear_function_is_small() {
        let f = Linear { a: 0.0013f32, b: -0.0021, c: 0.7 };
        let found = worst(f, |x, y| f64::from(f.a) * x + f64::from(f.b) * y + f64::from(f.c));
        // A thousand additions of values up to 1, each within half an ulp of 1, which is 6e-8.
        assert!(found < 3e-5, "{found}");
    }

    #[test]
    fn accumulated_error_of_a_quadratic_function_is_small() {
        let f = Quadratic { a: 1.1e-6f32, b: -1.7e-6, c: 0.7e-6, d: -4e-4, e: 1.3e-3, f: 0.3 };
        let found = worst(f, |x, y| {
            let [a, b, c, d, e, f] = [f.a, f.b, f.c, f.d, f.e, f.f].map(f64::from);
            a * x * x + b * y * y + c * x * y + d * x + e * y + f
        });
        // A tenth of a step of an 8-bit picture.
        assert!(found < 4e-4, "{found}");
    }
}
