//! A triangle as left and right edges, walked row by row in exact integers.
//!
//! Corners are those of [`crate::fill::Triangle`], in 1/256 of a pixel. The first pixel of a row is the first whose centre is at
//! or to the right of the left edge, and the run ends before the first whose centre is at or to the right of the right
//! edge: that is the top-left rule, so the pixels are the same as there.

use std::ops::Range;

use crate::fill::SUBPIXEL_BITS;

const ONE: i64 = 1 << SUBPIXEL_BITS;
const HALF: i64 = ONE / 2;

/// A point in sub-pixels.
type Point = [i64; 2];

/// The first row or column whose centre is at or after `coordinate`.
fn first_centre(coordinate: i64) -> i64 {
    -(HALF - coordinate).div_euclid(ONE)
}

/// An edge on its way down: where its rows begin, by an error term as Bresenham's.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    /// First column whose centre is at or to the right of the edge in this row.
    pub(super) column: i64,
    /// From the edge to that centre, in 1/`denominator` of a pixel; less than a whole.
    remainder: i64,
    denominator: i64,
    /// Change of both from row to row.
    step: [i64; 2],
    /// 1 / `denominator`.
    scale: f32,
    /// How far the edge moves to the right per row, in pixels.
    pub(super) slope: f32,
}

impl Edge {
    /// The edge from `from` down to `to`, at row `row`, which it must cross.
    fn new(from: Point, to: Point, row: i64) -> Self {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        // In units of 1 / (256 · dy) of a pixel the edge crosses the row's centre line at an integer; coordinates have
        // at most 29 bits, products 59.
        let denominator = ONE * dy;
        let crossing = (from[0] - HALF) * dy + (row * ONE + HALF - from[1]) * dx;
        let column = -(-crossing).div_euclid(denominator);
        Self {
            column,
            remainder: column * denominator - crossing,
            denominator,
            step: [dx.div_euclid(dy), dx.rem_euclid(dy) * ONE],
            scale: 1.0 / denominator as f32,
            slope: dx as f32 / dy as f32,
        }
    }

    /// To the next row.
    pub(super) fn down(&mut self) {
        self.column += self.step[0];
        self.remainder -= self.step[1];
        if self.remainder < 0 {
            self.column += 1;
            self.remainder += self.denominator;
        }
    }

    /// From the edge to the centre of its first column, in pixels, 0 … 1.
    pub(super) fn to_centre(self) -> f32 {
        self.remainder as f32 * self.scale
    }
}

/// The edges of a triangle, inside the rows of a picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outline {
    /// Top, middle and bottom corner.
    corners: [Point; 3],
    /// Whether the middle corner is on the left: two edges are there, and one on the right.
    pub(super) two_left: bool,
    /// First row, first row below the middle corner, and the row after the last.
    rows: [i64; 3],
}

impl Outline {
    /// For the corners of a triangle that has an area, in any order.
    pub(super) fn new(mut corners: [Point; 3], rows: Range<u32>) -> Self {
        corners.sort_unstable_by_key(|p| (p[1], p[0]));
        let [top, middle, bottom] = corners;
        let cross = (middle[0] - top[0]) * (bottom[1] - top[1]) - (middle[1] - top[1]) * (bottom[0] - top[0]);
        let inside = |y: i64| first_centre(y).clamp(i64::from(rows.start), i64::from(rows.end));
        Self { corners, two_left: cross < 0, rows: corners.map(|p| inside(p[1])) }
    }

    /// The left edges: one or two, each with its rows. Empty ones may be among them.
    pub(super) fn left(&self) -> impl Iterator<Item = (Edge, Range<i64>)> + use<> {
        let [top, middle, bottom] = self.corners;
        let [first, turn, end] = self.rows;
        let parts = if self.two_left {
            [Some((top, middle, first..turn)), Some((middle, bottom, turn..end))]
        } else {
            [Some((top, bottom, first..end)), None]
        };
        // A flat edge has no rows.
        let parts = parts.into_iter().flatten().filter(|(_, _, rows)| !rows.is_empty());
        parts.map(|(from, to, rows)| (Edge::new(from, to, rows.start), rows))
    }

    /// The right edge at row `row`.
    pub(super) fn right_at(&self, row: i64) -> Edge {
        let [top, middle, bottom] = self.corners;
        match (self.two_left, row < self.rows[1]) {
            (true, _) => Edge::new(top, bottom, row),
            (false, true) => Edge::new(top, middle, row),
            (false, false) => Edge::new(middle, bottom, row),
        }
    }

    /// The row, if any, in which the right edge changes at the middle corner.
    pub(super) fn right_turn(&self) -> Option<i64> {
        (!self.two_left).then_some(self.rows[1])
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::fill::Triangle;

    /// All pixels of a triangle by its outline.
    fn pixels(corners: [Point; 3], size: u32) -> Vec<(u32, u32)> {
        let outline = Outline::new(corners, 0..size);
        let mut out = vec![];
        for (mut left, rows) in outline.left() {
            let mut right = outline.right_at(rows.start);
            for y in rows {
                if outline.right_turn() == Some(y) {
                    right = outline.right_at(y);
                }
                for x in left.column.max(0)..right.column.min(i64::from(size)) {
                    out.push((x as u32, y as u32));
                }
                left.down();
                right.down();
            }
        }
        out
    }

    /// Triangles in and around a picture; half of them with corners on whole or half pixels, where ties are.
    fn triangles() -> impl Iterator<Item = [DVec2; 3]> {
        let mut random = testkit::Random::new(3);
        (0..4000).map(move |i| {
            let span = if i % 3 == 0 { (-40.0, 90.0) } else { (2.0, 14.0) };
            let mut coordinate = || {
                let c = random.range(span.0, span.1);
                if i % 2 == 0 { (c * 2.0).round() / 2.0 } else { c }
            };
            [(); 3].map(|()| DVec2::new(coordinate(), coordinate()))
        })
    }

    #[test]
    fn pixels_are_those_of_the_fill_rule() {
        let mut seen = 0;
        for corners in triangles() {
            let Some(triangle) = Triangle::new(corners) else { continue };
            let mut expected = vec![];
            triangle.for_each_pixel(0..48, 0..48, |x, y, _| expected.push((x, y)));
            assert_eq!(pixels(triangle.snapped(), 48), expected, "{corners:?}");
            seen += expected.len();
        }
        assert!(seen > 100_000, "{seen}");
    }

    #[test]
    fn centre_lies_right_of_the_edge_by_what_it_says() {
        for corners in triangles() {
            let Some(triangle) = Triangle::new(corners) else { continue };
            let outline = Outline::new(triangle.snapped(), 0..48);
            for (mut left, rows) in outline.left() {
                let slope = f64::from(left.slope);
                let start = left.column as f64 - f64::from(left.to_centre());
                for (i, _) in rows.enumerate() {
                    let edge = left.column as f64 - f64::from(left.to_centre());
                    assert!((0.0..=1.0).contains(&left.to_centre()));
                    assert!((edge - (start + slope * i as f64)).abs() < 1e-3, "{corners:?}");
                    left.down();
                }
            }
        }
    }

    #[test]
    fn far_corners_do_not_overflow() {
        let far = crate::fill::MAX_COORDINATE;
        let corners = [DVec2::new(-far, -far), DVec2::new(far, -far + 1.0), DVec2::new(-far, far)];
        let triangle = Triangle::new(corners).unwrap();
        let mut expected = 0;
        triangle.for_each_pixel(0..8, 0..8, |_, _, _| expected += 1);
        assert_eq!(pixels(triangle.snapped(), 8).len(), expected);
    }
}
