//! The setup of a triangle for Duff's denominator, in two ways: what Table 1 of the source compares.

use glam::Vec3;

use crate::fill::Triangle;
use crate::raster::scanline::difference::Walk;
use crate::raster::scanline::place::Place;
use crate::raster::vectors::{Linear, Quadratic, Sides, SixSamples, ToNormalized};

/// Where the coefficients of a quadratic polynomial are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Setup {
    /// On the triangle as it lies on the screen, through six samples (Abbas et al. 2001).
    Actual,
    /// On the ortho-normalised triangle, from the linear vector itself, and mapped to the screen.
    Normalized,
}

/// A triangle with its left edges found: what the setup of a polynomial begins with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftEdges {
    sides: Sides,
    /// Where each crosses its first row, and how far it moves per row.
    starts: [Option<([f32; 2], f32)>; 2],
}

impl LeftEdges {
    /// In a picture `height` pixels high.
    pub fn new(triangle: &Triangle, height: u32) -> Self {
        let place = Place::new(triangle);
        let mut left = place.left(height).map(|side| (side.start, side.left.slope));
        Self { sides: place.sides, starts: [left.next(), left.next()] }
    }

    /// How many there are that have rows: none, one or two.
    pub fn count(&self) -> usize {
        self.starts.iter().flatten().count()
    }
}

/// Coefficients of the squared length of a vector that is linear over a triangle with the given `corners`, and all that a
/// scan converter needs of it on the one or two left edges; returned is a sum of the variables.
///
/// Zero for a triangle without rows.
pub fn set_up_denominator(setup: Setup, triangle: &LeftEdges, corners: &[Vec3; 3]) -> f32 {
    let square = match setup {
        Setup::Actual => {
            let [l, m, n] = *corners;
            let midpoints = [l + m, l + n, m + n].map(|sum| sum.length_squared() * 0.25);
            let samples = SixSamples { corners: corners.map(Vec3::length_squared), midpoints };
            Quadratic::on_actual(&samples, &triangle.sides)
        }
        Setup::Normalized => ToNormalized::new(&triangle.sides)
            .map(|map| Quadratic::squared_length(&Linear::on_normalized(*corners)).to_screen(&map)),
    };
    let Some(square) = square else { return 0.0 };
    let variables = |([x, y], slope): &([f32; 2], f32)| square.on_edge(*x, *y, *slope).sum();
    triangle.starts.iter().flatten().map(variables).sum()
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    #[test]
    fn both_ways_set_up_the_same_variables() {
        let corners = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -0.6, 0.8), Vec3::new(-0.48, 0.64, 0.6)];
        // The middle corner on the right, and on the left.
        for (x, count) in [(80.3, 1), (3.1, 2)] {
            let shape = [DVec2::new(20.7, 2.2), DVec2::new(x, 30.9), DVec2::new(31.4, 77.7)];
            let edges = LeftEdges::new(&Triangle::new(shape).unwrap(), 100);
            assert_eq!(edges.count(), count);
            let [actual, normalized] =
                [Setup::Actual, Setup::Normalized].map(|s| set_up_denominator(s, &edges, &corners));
            assert!((actual - normalized).abs() < 1e-4 && actual.abs() > 0.1, "{actual} and {normalized}");
        }
    }
}
