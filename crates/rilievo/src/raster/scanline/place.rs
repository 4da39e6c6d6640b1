//! Where a triangle is on the screen, and the loop over its rows.

use std::ops::Range;

use crate::fill::{SUBPIXEL_BITS, Triangle};
use crate::raster::scanline::outline::{Edge, Outline};
use crate::raster::vectors::Sides;

use glam::Vec2;

const SUBPIXEL: f64 = 1.0 / (1u32 << SUBPIXEL_BITS) as f64;

/// A triangle on the screen.
pub(super) struct Place {
    corners: [[i64; 2]; 3],
    /// Seen from vertex 0, as all polynomials are.
    pub(super) sides: Sides,
}

impl Place {
    pub(super) fn new(shape: &Triangle) -> Self {
        let corners = shape.snapped();
        let from_first = |i: usize| {
            let [x, y] = [0, 1].map(|axis| (corners[i][axis] - corners[0][axis]) as f64 * SUBPIXEL);
            Vec2::new(x as f32, y as f32)
        };
        Self { corners, sides: Sides { first: from_first(1), second: from_first(2) } }
    }

    /// The left edges, one or two, with their rows of a picture that is `height` rows high.
    pub(super) fn left(&self, height: u32) -> impl Iterator<Item = Side> {
        let outline = Outline::new(self.corners, 0..height);
        let origin = self.corners[0].map(|c| c as f64 * SUBPIXEL);
        outline.left().map(move |(left, rows)| {
            let x = left.column as f64 + 0.5 - f64::from(left.to_centre()) - origin[0];
            let y = rows.start as f64 + 0.5 - origin[1];
            Side { outline, left, rows, start: [x as f32, y as f32] }
        })
    }
}

/// The rows that begin at one left edge.
pub(super) struct Side {
    outline: Outline,
    /// The edge in the first of the rows.
    pub(super) left: Edge,
    rows: Range<i64>,
    /// Where the edge crosses the centre line of the first row, in pixels from vertex 0.
    pub(super) start: [f32; 2],
}

impl Side {
    /// Calls `visit(row, columns, ahead)` for all rows from top to bottom, also for those without a pixel.
    ///
    /// The first column's centre is `ahead` pixels to the right of the left edge.
    pub(super) fn for_each_row(self, width: u32, mut visit: impl FnMut(u32, Range<usize>, f32)) {
        let (mut left, mut right) = (self.left, self.outline.right_at(self.rows.start));
        let turn = self.outline.right_turn();
        for row in self.rows {
            if turn == Some(row) {
                right = self.outline.right_at(row);
            }
            let first = left.column.clamp(0, i64::from(width));
            let end = right.column.clamp(first, i64::from(width));
            let ahead = left.to_centre() + (first - left.column) as f32;
            visit(row as u32, first as usize..end as usize, ahead);
            left.down();
            right.down();
        }
    }
}
