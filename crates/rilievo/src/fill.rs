//! Scan conversion of triangles on fixed-point coordinates.
//!
//! Used wherever triangles become texels or pixels: the renderer in screen space, the baking of maps in UV space.
//! Vertices are snapped to 1/256 of a pixel; from there on everything is exact integer arithmetic, so two triangles
//! that share an edge own every pixel centre on it exactly once (top-left rule).

use std::ops::Range;

use glam::DVec2;

/// Fractional bits of a coordinate.
pub const SUBPIXEL_BITS: u32 = 8;
const ONE: i64 = 1 << SUBPIXEL_BITS;

/// The farthest from the origin a coordinate may lie, in pixels, for edge products to fit 64 bits with room to spare.
pub const MAX_COORDINATE: f64 = (1u64 << 20) as f64;

/// From this width of its bounding box on, a row's run is computed instead of searched for: three divisions cost as much
/// as looking at a few dozen pixels.
const WIDE_ROW: i64 = 32;

/// A triangle snapped to the sub-pixel grid, oriented so that its area is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    vertices: [[i64; 2]; 3],
    /// Twice the area, in sub-pixels squared; positive.
    area2: i64,
    /// Whether the vertices had to change places (1 and 2) to make the area positive.
    flipped: bool,
}

impl Triangle {
    /// Snaps three corners in pixels (x right, y down; pixel (x, y) has its centre at (x + ½, y + ½)).
    ///
    /// `None` if the snapped triangle has no area, or a corner is not within [`MAX_COORDINATE`] (or NaN).
    pub fn new(corners: [DVec2; 3]) -> Option<Self> {
        let inside = |p: &DVec2| p.x.abs() <= MAX_COORDINATE && p.y.abs() <= MAX_COORDINATE;
        if !corners.iter().all(inside) {
            return None;
        }
        let snap = |c: f64| (c * ONE as f64).round_ties_even() as i64;
        let mut vertices = corners.map(|p| [snap(p.x), snap(p.y)]);
        let area2 = cross(vertices[0], vertices[1], vertices[2]);
        if area2 == 0 {
            return None;
        }
        let flipped = area2 < 0;
        if flipped {
            vertices.swap(1, 2);
        }
        Some(Self { vertices, area2: area2.abs(), flipped })
    }

    /// Whether the corners run clockwise as seen on the screen (y down), before reordering.
    pub fn is_clockwise(&self) -> bool {
        !self.flipped
    }

    /// The snapped corners as they were given, in 1/2⁸ of a pixel.
    pub(crate) fn snapped(&self) -> [[i64; 2]; 3] {
        let [a, b, c] = self.vertices;
        if self.flipped { [a, c, b] } else { [a, b, c] }
    }

    /// The snapped corners as they were given, in pixels.
    pub(crate) fn corners(&self) -> [DVec2; 3] {
        self.snapped().map(|[x, y]| DVec2::new(x as f64, y as f64) / ONE as f64)
    }

    /// Calls `visit(x, y, weights)` for every pixel centre the triangle owns inside `columns` × `rows`, row by row.
    ///
    /// The weights are the barycentric coordinates of the pixel centre for the corners as they were given; they are
    /// quotients of integers, each within an ulp or two, and sum to 1 within the same.
    pub fn for_each_pixel(&self, columns: Range<u32>, rows: Range<u32>, mut visit: impl FnMut(u32, u32, [f64; 3])) {
        let bounds = |axis: usize, range: &Range<u32>| {
            let low = self.vertices.iter().map(|v| v[axis]).min().expect("invariant: three corners");
            let high = self.vertices.iter().map(|v| v[axis]).max().expect("invariant: three corners");
            // Centres lie at (i + ½): the first at or after `low`, the last at or before `high`.
            let first = (low - ONE / 2 + ONE - 1).div_euclid(ONE).max(i64::from(range.start));
            let last = (high - ONE / 2).div_euclid(ONE).min(i64::from(range.end) - 1);
            first..last + 1
        };
        let (xs, ys) = (bounds(0, &columns), bounds(1, &rows));
        let [a, b, c] = self.vertices;
        // Edge i lies opposite to corner i.
        let edges = [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)];
        let scale = 1.0 / self.area2 as f64;
        let wide = xs.end - xs.start > WIDE_ROW;
        for y in ys {
            let mut run = xs.clone();
            if wide {
                edges.iter().for_each(|edge| edge.narrow(y, &mut run));
            }
            for x in run {
                let centre = [x * ONE + ONE / 2, y * ONE + ONE / 2];
                let e = edges.each_ref().map(|edge| edge.at(centre));
                if edges.iter().zip(e).all(|(edge, value)| value + edge.bias >= 0) {
                    let mut w = e.map(|v| v as f64 * scale);
                    if self.flipped {
                        w.swap(1, 2);
                    }
                    visit(x as u32, y as u32, w);
                }
            }
        }
    }
}

/// Twice the signed area of a, b, c: positive if they run clockwise on the screen (y down).
fn cross(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A directed edge of a positively oriented triangle.
struct Edge {
    from: [i64; 2],
    to: [i64; 2],
    /// 0 if pixel centres exactly on the edge belong to the triangle (a top or a left edge), −1 otherwise.
    bias: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        // Clockwise with y down: the inside is to the right of the direction of travel. Left edges go up, top edges
        // go right.
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        Self { from, to, bias: if top_left { 0 } else { -1 } }
    }

    fn at(&self, p: [i64; 2]) -> i64 {
        cross(self.from, self.to, p)
    }

    /// Takes from a run of pixels in row `y` those that lie outside.
    fn narrow(&self, y: i64, run: &mut Range<i64>) {
        // Inside is value + i · step + bias ≥ 0 for the i-th pixel of the run, solved by division with rounding down: exact.
        let value = self.at([run.start * ONE + ONE / 2, y * ONE + ONE / 2]) + self.bias;
        match (self.from[1] - self.to[1]) * ONE {
            0 if value < 0 => run.end = run.start,
            0 => {}
            step if step > 0 => run.start += (-value.div_euclid(step)).max(0),
            step => run.end = run.end.min(run.start + value.div_euclid(-step) + 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(corners: [[f64; 2]; 3]) -> Vec<(u32, u32)> {
        let mut out = vec![];
        if let Some(t) = Triangle::new(corners.map(DVec2::from)) {
            t.for_each_pixel(0..16, 0..16, |x, y, w| {
                assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-12 && w.iter().all(|&w| w >= 0.0));
                out.push((x, y));
            });
        }
        out
    }

    #[test]
    fn top_left_rule_on_pixel_centres() {
        // A square whose edges run through pixel centres owns its top and left, not its bottom and right.
        let (a, b, c, d) = ([1.5, 1.5], [3.5, 1.5], [3.5, 3.5], [1.5, 3.5]);
        let mut owned = pixels([a, b, c]);
        owned.extend(pixels([a, c, d]));
        owned.sort_unstable();
        assert_eq!(owned, [(1, 1), (1, 2), (2, 1), (2, 2)]);
    }

    #[test]
    fn both_windings_own_the_same_pixels_and_weights_follow_the_corners() {
        let t = [[0.2, 0.7], [13.1, 2.0], [4.4, 11.9]];
        assert_eq!(pixels(t), pixels([t[0], t[2], t[1]]));
        for order in [[0, 1, 2], [0, 2, 1], [2, 1, 0]] {
            let corners = order.map(|i: usize| DVec2::from(t[i]));
            Triangle::new(corners).unwrap().for_each_pixel(0..16, 0..16, |x, y, w| {
                let p = corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
                assert!((p - DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).length() < 0.01);
            });
        }
    }

    #[test]
    fn no_area_nan_and_far_away_are_refused() {
        let p = |x, y| DVec2::new(x, y);
        assert_eq!(Triangle::new([p(1.0, 1.0), p(2.0, 2.0), p(3.0, 3.0)]), None);
        assert_eq!(Triangle::new([p(f64::NAN, 1.0), p(2.0, 2.0), p(3.0, 1.0)]), None);
        assert_eq!(Triangle::new([p(1e9, 1.0), p(2.0, 2.0), p(3.0, 1.0)]), None);
    }
}
