//! Bilinear samples of a map that repeats over the mesh.

use std::ops::{Add, Mul};

use glam::DVec2;

use super::{Deflect, Point};
use crate::grid::Edges;

/// Samples a source map at points of the map being made.
pub(super) struct Bilinear {
    size: (u32, u32),
    edges: Edges,
    /// Source texels per texel of the result. Exactly 1 for the same size and no repetition: samples are then texels.
    ratio: DVec2,
}

impl Bilinear {
    /// For a source of `size` whose copies have `edges`.
    pub(super) fn new(options: &Deflect, size: (u32, u32), edges: Edges) -> Self {
        let ratio = |repeat: f32, source: u32, result: u32| f64::from(repeat) * f64::from(source) / f64::from(result);
        let across = ratio(options.repeat[0], size.0, options.size.0);
        let down = ratio(options.repeat[1], size.1, options.size.1);
        Self { size, edges, ratio: DVec2::new(across, down) }
    }

    /// The weighted mean of the four texels about `point`.
    pub(super) fn sample<T>(&self, point: &Point, texel: impl Fn(u32, u32) -> T) -> T
    where
        T: Mul<f64, Output = T> + Add<Output = T>,
    {
        let at = point.position * self.ratio;
        let (x0, x1, fx) = neighbours(at.x, self.size.0, self.edges);
        let (y0, y1, fy) = neighbours(at.y, self.size.1, self.edges);
        let top = texel(x0, y0) * (1.0 - fx) + texel(x1, y0) * fx;
        let bottom = texel(x0, y1) * (1.0 - fx) + texel(x1, y1) * fx;
        top * (1.0 - fy) + bottom * fy
    }

    /// The texel that `point` lies in.
    pub(super) fn nearest(&self, point: &Point) -> (u32, u32) {
        let at = point.position * self.ratio;
        (nearest(at.x, self.size.0), nearest(at.y, self.size.1))
    }
}

/// The texel of one copy of the map that `position` lies in.
fn nearest(position: f64, len: u32) -> u32 {
    let n = f64::from(len);
    let inside = position - (position / n).floor() * n;
    // A position just below a copy rounds up to its far end.
    (inside as u32).min(len - 1)
}

/// The two texels whose centres (i + ½) enclose `position`, within one copy of the map, and how far towards the second.
fn neighbours(position: f64, len: u32, edges: Edges) -> (u32, u32, f64) {
    let n = f64::from(len);
    let inside = position - (position / n).floor() * n;
    let low = (inside - 0.5).floor();
    let i = low as i64;
    (edges.resolve(i, len), edges.resolve(i + 1, len), inside - 0.5 - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_stays_in_its_copy() {
        for (position, expected) in [(0.0, 0), (0.99, 0), (1.0, 1), (3.5, 3), (4.0, 0), (-0.5, 3), (-1e-300, 3)] {
            assert_eq!(nearest(position, 4), expected, "{position}");
        }
    }

    #[test]
    fn neighbours_meet_over_the_edge_of_a_copy() {
        assert_eq!(neighbours(1.5, 4, Edges::Wrap), (1, 2, 0.0));
        assert_eq!(neighbours(0.25, 4, Edges::Wrap), (3, 0, 0.75));
        assert_eq!(neighbours(-0.25, 4, Edges::Wrap), (3, 0, 0.25));
        assert_eq!(neighbours(4.25, 4, Edges::Clamp), (0, 0, 0.75));
        assert_eq!(neighbours(7.75, 4, Edges::Mirror), (3, 3, 0.25));
        assert_eq!(neighbours(-1e-300, 1, Edges::Wrap).0, 0);
    }
}
