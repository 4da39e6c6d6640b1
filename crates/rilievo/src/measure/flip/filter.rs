//! The two sets of filters of ꟻLIP: what the eye resolves of colours, and its detectors of edges and points.

use std::f64::consts::PI;

use super::color::hunt_lab;
use crate::grid::{Edges, Grid};
use crate::par;

/// Weights of a Gaussian `exp(−π² x² / b)`, x in degrees: the paper's fit of contrast sensitivity.
/// Luminance and red-green have one, blue-yellow is a sum of two.
const Y: [[f64; 2]; 1] = [[1.0, 0.0047]];
const CX: [[f64; 2]; 1] = [[1.0, 0.0053]];
const CZ: [[f64; 2]; 2] = [[34.1, 0.04], [13.5, 0.025]];

/// Width of the feature detectors, in degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// The parts a channel's filter is the sum of. Each is separable with the same weights along x and y.
struct Sum(Vec<Vec<f32>>);

impl Sum {
    /// A sum of Gaussians `a · √(π / b) · exp(−π² r² / b)` over the square ±`radius`, scaled to sum 1.
    fn of_gaussians(parts: &[[f64; 2]], radius: i32, pixels_per_degree: f64) -> Self {
        let gaussian =
            |b: f64| (-radius..=radius).map(move |i| (-(PI * f64::from(i) / pixels_per_degree).powi(2) / b).exp());
        let amplitude = |[a, b]: [f64; 2]| a * (PI / b).sqrt();
        let total: f64 = parts.iter().map(|&p| amplitude(p) * gaussian(p[1]).sum::<f64>().powi(2)).sum();
        // Both passes apply the weights, so each has the root of the amplitude.
        let weights = |&p: &[f64; 2]| gaussian(p[1]).map(|g| ((amplitude(p) / total).sqrt() * g) as f32).collect();
        Self(parts.iter().map(weights).collect())
    }

    fn apply(&self, plane: &Grid<f32>) -> Grid<f32> {
        let mut parts = self.0.iter().map(|weights| convolve(plane, weights, weights));
        let mut sum = parts.next().expect("invariant: a filter has a part");
        for part in parts {
            for (sum, part) in sum.texels_mut().iter_mut().zip(part.texels()) {
                *sum += part;
            }
        }
        sum
    }
}

/// What the eye resolves of each channel of YCxCz.
pub(super) struct SpatialFilters([Sum; 3]);

impl SpatialFilters {
    pub(super) fn new(pixels_per_degree: f32) -> Self {
        let ppd = f64::from(pixels_per_degree);
        // All filters reach as far as three standard deviations of the widest, √(b / 2π²).
        let widest = CZ[0][1];
        let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * ppd).ceil() as i32;
        Self([&Y[..], &CX, &CZ].map(|parts| Sum::of_gaussians(parts, radius, ppd)))
    }

    /// The filtered picture in Hunt-adjusted L*a*b*.
    pub(super) fn see(&self, y: &Grid<f32>, cx: &Grid<f32>, cz: &Grid<f32>) -> [Grid<f32>; 3] {
        let [fy, fcx, fcz] = &self.0;
        let mut planes = [fy.apply(y), fcx.apply(cx), fcz.apply(cz)];
        let [y, cx, cz] = &mut planes;
        for ((y, cx), cz) in y.texels_mut().iter_mut().zip(cx.texels_mut()).zip(cz.texels_mut()) {
            [*y, *cx, *cz] = hunt_lab([*y, *cx, *cz]);
        }
        planes
    }
}

/// A Gaussian and its first two derivatives.
pub(super) struct FeatureFilters {
    /// Sum 1.
    pub(super) smooth: Vec<f32>,
    /// Edges: the negative weights sum to −1, the positive ones to 1.
    pub(super) first: Vec<f32>,
    /// Points: likewise.
    pub(super) second: Vec<f32>,
}

impl FeatureFilters {
    pub(super) fn new(pixels_per_degree: f32) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * f64::from(pixels_per_degree);
        let radius = (3.0 * deviation).ceil() as i32;
        let weights = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (-radius..=radius)
                .map(|i| f(f64::from(i)) * (-f64::from(i).powi(2) / (2.0 * deviation * deviation)).exp())
                .collect()
        };
        Self {
            smooth: balanced(&weights(&|_| 1.0)),
            first: balanced(&weights(&|x| -x)),
            second: balanced(&weights(&|x| (x / deviation).powi(2) - 1.0)),
        }
    }
}

/// Scales the positive weights to sum 1 and the negative ones to sum −1.
fn balanced(weights: &[f64]) -> Vec<f32> {
    let positive: f64 = weights.iter().filter(|w| **w > 0.0).sum();
    let negative: f64 = weights.iter().filter(|w| **w < 0.0).sum();
    weights
        .iter()
        .map(|&w| {
            (if w > 0.0 {
                w / positive
            } else if w < 0.0 {
                -w / negative
            } else {
                0.0
            }) as f32
        })
        .collect()
}

/// The plane filtered with `along_x` in its rows, then with `along_y` in its columns. Odd numbers of weights, centred;
/// the borders are clamped.
pub(super) fn convolve(plane: &Grid<f32>, along_x: &[f32], along_y: &[f32]) -> Grid<f32> {
    let width = plane.width() as usize;
    let mut across = plane.map(|_| 0.0);
    par::for_each_row(across.texels_mut(), width, |y, out| {
        let radius = along_x.len() / 2;
        let row = plane.row(y as u32);
        let mut padded = vec![row[0]; radius];
        padded.extend_from_slice(row);
        padded.resize(width + 2 * radius, row[width - 1]);
        for (shift, &weight) in along_x.iter().enumerate() {
            add_scaled(out, &padded[shift..shift + width], weight);
        }
    });
    let mut down = plane.map(|_| 0.0);
    par::for_each_row(down.texels_mut(), width, |y, out| {
        let top = y as i64 - (along_y.len() / 2) as i64;
        for (shift, &weight) in along_y.iter().enumerate() {
            let y = Edges::Clamp.resolve(top + shift as i64, plane.height());
            add_scaled(out, across.row(y), weight);
        }
    });
    down
}

fn add_scaled(out: &mut [f32], values: &[f32], weight: f32) {
    for (out, value) in out.iter_mut().zip(values) {
        *out += weight * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn convolve_spreads_a_point_into_the_mirrored_weights_and_clamps() {
        let point = Grid::from_fn(5, 3, |x, y| f32::from(u8::from((x, y) == (2, 1)))).unwrap();
        let spread = convolve(&point, &[1.0, 2.0, 4.0], &[1.0, 0.0, 10.0]);
        assert_eq!(spread.row(0), [0.0, 40.0, 20.0, 10.0, 0.0]);
        assert_eq!(spread.row(1), [0.0; 5]);
        assert_eq!(spread.row(2), [0.0, 4.0, 2.0, 1.0, 0.0]);
        let one = Grid::filled(1, 1, 3.0).unwrap();
        assert_eq!(convolve(&one, &[1.0, 1.0, 1.0], &[0.5, 0.25, 0.25]).texels(), [9.0]);
    }

    #[test]
    fn colour_filters_keep_flat_colours() {
        for ppd in [1.0, 7.5, 67.02, 200.0] {
            for filter in SpatialFilters::new(ppd).0 {
                let sum: f64 = filter.0.iter().map(|w| w.iter().map(|&w| f64::from(w)).sum::<f64>().powi(2)).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{ppd} {sum}");
            }
        }
    }

    #[test]
    fn detectors_ignore_flat_ground_and_answer_1_to_a_perfect_match() {
        let f = FeatureFilters::new(67.02);
        let sum = |w: &[f32]| w.iter().sum::<f32>();
        assert!((sum(&f.smooth) - 1.0).abs() < 1e-6);
        assert!(sum(&f.first).abs() < 1e-6 && sum(&f.second).abs() < 1e-6);
        let half = f.first.len() / 2;
        assert!((sum(&f.first[..half]) - 1.0).abs() < 1e-6);
    }
}
