//! The plane of weighted least squares through a texel and its neighbours.
//!
//! For a full 3 × 3 neighbourhood with weights `w(x)·w(y)`, the normal equations separate: the slope along x is the
//! central difference along x, averaged over the three rows with weights w. With w = (1 1 1) that is Prewitt's
//! operator, with (1 2 1) Sobel's, with (3 10 3) Scharr's. Beyond a clamped border whole rows or columns are missing,
//! what is left is still a product, and the same derivation gives: the one-sided difference, averaged over the rows
//! that exist. The weight of the texel itself cancels in the interior but counts at borders; in a corner nothing is
//! determined without it.
//!
//! The cross of the texel and its 4 nearest neighbours is not a product. In the interior it gives central differences,
//! at a clamped border [`cross_axis`]. In a clamped corner only three texels of it are left: the plane would go through
//! all three and take on the rounding of each in full (0.148° on a 16-bit ramp whose interior has 0.110°), so there the
//! diagonal neighbour is fitted as well.

use super::{Filter, HeightMap};
use crate::grid::{Edges, Grid};

/// The neighbours of one position along one axis.
#[derive(Debug, Clone, Copy)]
struct Along {
    /// Position before; the position itself where there is none.
    before: usize,
    /// Position after; the position itself where there is none.
    after: usize,
    /// Whether the neighbour before and the one after are missing; only a clamped border lacks any.
    missing: [bool; 2],
    /// Factor that makes a slope per texel of the difference from before to after.
    per_texel: f32,
    /// Weights of before, here and after in an average across the slope. Sum 1; 0 for what is missing.
    weights: [f32; 3],
}

impl Along {
    fn new(i: usize, len: u32, edges: Edges, filter: Filter) -> Self {
        let at = |position: i64| edges.resolve(position, len) as usize;
        let (before, after) = (at(i as i64 - 1), at(i as i64 + 1));
        let clamped = edges == Edges::Clamp;
        let missing = [clamped && i == 0, clamped && i + 1 == len as usize];
        let [side, here] = match filter {
            Filter::Plane4 => [0.0, 1.0],
            Filter::Plane8 => [1.0, 1.0],
            Filter::Sobel => [1.0, 2.0],
            Filter::Scharr => [3.0, 10.0],
        };
        let [first, last] = missing.map(|m| if m { 0.0 } else { side });
        let sum: f32 = first + here + last;
        let per_texel = match missing {
            [false, false] => 0.5,
            [true, true] => 0.0,
            _ => 1.0,
        };
        Self { before, after, missing, per_texel, weights: [first / sum, here / sum, last / sum] }
    }

    /// Whether exactly one neighbour is missing.
    fn one_sided(&self) -> bool {
        self.missing[0] != self.missing[1]
    }
}

/// Slopes of a map of heights, row by row. Heights are computed with as f32.
pub(super) struct PlaneFit<'a, T = f32> {
    heights: &'a Grid<T>,
    filter: Filter,
    edges: Edges,
    /// From height per texel to slope.
    scale: f32,
}

/// Three texels in a line: before, here, after.
type Line = [f32; 3];

impl<'a> PlaneFit<'a> {
    pub(super) fn new(map: &'a HeightMap, filter: Filter, edges: Edges) -> Self {
        Self::of(map.heights(), map.depth(), filter, edges)
    }
}

impl<'a, T: Copy + Into<f32>> PlaneFit<'a, T> {
    /// `depth` is how far height 1 lies above height 0, as a fraction of the map's width.
    pub(super) fn of(heights: &'a Grid<T>, depth: f32, filter: Filter, edges: Edges) -> Self {
        Self { heights, filter, edges, scale: depth * heights.width() as f32 }
    }

    /// From height per texel to slope.
    pub(super) fn scale(&self) -> f32 {
        self.scale
    }

    /// Calls `put(x, [dh/dx, dh/dy up])` for each texel of row `y`, in an unspecified order.
    pub(super) fn row(&self, y: usize, put: impl FnMut(usize, [f32; 2])) {
        // The branch stays outside the loop over the row, so that the loop is free of any.
        if self.filter == Filter::Plane4 {
            self.row_with::<true>(y, cross, put);
        } else {
            self.row_with::<true>(y, product, put);
        }
    }

    /// As [`Self::row`], for the first and the last texel only.
    pub(super) fn ends(&self, y: usize, put: impl FnMut(usize, [f32; 2])) {
        if self.filter == Filter::Plane4 {
            self.row_with::<false>(y, cross, put);
        } else {
            self.row_with::<false>(y, product, put);
        }
    }

    #[inline(always)]
    fn row_with<const INTERIOR: bool>(
        &self,
        y: usize,
        fit: impl Fn([Line; 3], &Along, &Along) -> [f32; 2],
        mut put: impl FnMut(usize, [f32; 2]),
    ) {
        let (width, height) = self.heights.size();
        let vertical = Along::new(y, height, self.edges, self.filter);
        let [above, here, below] = [vertical.before, y, vertical.after].map(|y| self.heights.row(y as u32));
        let last = width as usize - 1;

        let mut texel = |x: usize, lines: [Line; 3], horizontal: &Along| {
            let [right, up] = fit(lines, horizontal, &vertical);
            put(x, [right * self.scale, up * self.scale]);
        };
        if INTERIOR {
            // Away from the ends of the row all texels have the same neighbours.
            let interior = Along::new(1, 3, self.edges, self.filter);
            let windows = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
            for (i, ((a, h), b)) in windows.enumerate() {
                let line = |w: &[T]| [w[0].into(), w[1].into(), w[2].into()];
                texel(i + 1, [line(a), line(h), line(b)], &interior);
            }
        }
        for x in [0, last] {
            let horizontal = Along::new(x, width, self.edges, self.filter);
            let line = |row: &[T]| [row[horizontal.before].into(), row[x].into(), row[horizontal.after].into()];
            texel(x, [line(above), line(here), line(below)], &horizontal);
        }
    }
}

/// Slopes per texel (right, up) of the plane through the whole neighbourhood, with the weights of a product.
#[inline(always)]
fn product([above, here, below]: [Line; 3], horizontal: &Along, vertical: &Along) -> [f32; 2] {
    // Differences first, averages of them after: a large common height loses nothing. The outer two first: mirrored
    // reliefs get the mirrored bits.
    let average = |d: Line, w: &Line| (d[0] * w[0] + d[2] * w[2]) + d[1] * w[1];
    let right = [above, here, below].map(|line| line[2] - line[0]);
    let up = [above[0] - below[0], above[1] - below[1], above[2] - below[2]];
    [average(right, &vertical.weights) * horizontal.per_texel, average(up, &horizontal.weights) * vertical.per_texel]
}

/// Slopes per texel (right, up) of the plane through the texel and its 4 nearest neighbours.
#[inline(always)]
fn cross([above, here, below]: [Line; 3], horizontal: &Along, vertical: &Along) -> [f32; 2] {
    if horizontal.one_sided() && vertical.one_sided() {
        // The 2 × 2 texels of a corner: the mean of the two differences. The missing line repeats the one here, so the
        // outer lines are the two that exist.
        let right = (above[2] - above[0]) + (below[2] - below[0]);
        let up = (above[0] - below[0]) + (above[2] - below[2]);
        return [right * 0.5, up * 0.5];
    }
    let (row, column) = (here, [above[1], here[1], below[1]]);
    let down = cross_axis(column, row, vertical, horizontal);
    [cross_axis(row, column, horizontal, vertical), 0.0 - down]
}

/// One slope of the cross: along `line`, whose texels have the neighbours `along`; `beside` is the other line.
///
/// At a border with texel c, inner neighbour r and the neighbours u and d beside it, the normal equations give
/// r − (c + u + d) / 3; on a map one texel wide, r − c.
#[inline(always)]
fn cross_axis(line: Line, beside: Line, along: &Along, across: &Along) -> f32 {
    let difference = (line[2] - line[0]) * along.per_texel;
    // Relative to c: nothing is lost to a large common height.
    let correction = || ((beside[0] - line[1]) + (beside[2] - line[1])) / 3.0;
    match (along.missing, across.missing) {
        ([true, false], [false, false]) => difference - correction(),
        ([false, true], [false, false]) => difference + correction(),
        _ => difference,
    }
}
