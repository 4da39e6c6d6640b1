//! LDR-ꟻLIP: the difference a person sees when switching back and forth between two pictures.
//!
//! Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A Difference Evaluator for
//! Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), with all constants as printed there.
//! The filters are applied separably, as `separatedConvolutions.pdf` in the authors' repository shows they may be.

mod color;
mod filter;

use color::{color_distance, max_distance, ycxcz_planes};
use filter::{FeatureFilters, SpatialFilters, convolve};

use super::picture::compared_rgb;
use crate::color::Picture;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::par;

/// A 0.7 m wide monitor of 3840 pixels seen from 0.7 m, the paper's setting: `0.7 · 3840 / 0.7 · π / 180`.
pub const DEFAULT_PIXELS_PER_DEGREE: f32 = 67.020_64;

/// The filters grow with the pixels per degree (their radius is 136 pixels at 1000); no eye resolves more than some 120.
const PIXELS_PER_DEGREE: std::ops::RangeInclusive<f32> = 1.0..=1000.0;

/// Exponent of the colour distance.
const QC: f32 = 0.7;
/// Colour distances up to this fraction of the largest …
const PC: f32 = 0.4;
/// … take this fraction of the scale of errors.
const PT: f32 = 0.95;
/// Exponent of the feature difference.
const QF: f32 = 0.5;

/// The ꟻLIP error of each pixel, 0 (none) … 1.
///
/// `pixels_per_degree` says how large a pixel looks; see [`DEFAULT_PIXELS_PER_DEGREE`]. Pixels are compared as they
/// are seen over black, as in [`super::picture_stats`]. Borders are clamped.
///
/// - **Accuracy:** each pixel within 10⁻⁴ and the mean within 10⁻⁵ of the authors' own program
///   (`dev/testkit/tests/flip_oracle.rs`).
/// - **Determinism:** the same bits for any thread count; the platform's `powf` may differ in its last bit.
///
/// # Errors
/// [`Error::SizeMismatch`] if the sizes differ, [`Error::Parameter`] for pixels per degree outside 1 … 1000.
pub fn flip_map(reference: &Picture, other: &Picture, pixels_per_degree: f32) -> Result<Grid<f32>> {
    reference.expect_same_size("the other picture", other)?;
    if !PIXELS_PER_DEGREE.contains(&pixels_per_degree) {
        return Err(Error::parameter("pixels_per_degree", pixels_per_degree, "1 to 1000"));
    }
    let spatial = SpatialFilters::new(pixels_per_degree);
    let features = FeatureFilters::new(pixels_per_degree);
    let a = Seen::new(reference, &spatial, &features);
    let b = Seen::new(other, &spatial, &features);

    let largest = max_distance(QC);
    let mut errors = a.edges.map(|_| 0.0);
    let width = errors.width() as usize;
    par::for_each_row(errors.texels_mut(), width, |y, row| {
        for (x, error) in row.iter_mut().enumerate() {
            let i = y * width + x;
            let color = compress(color_distance(a.lab(i), b.lab(i)).powf(QC), largest);
            let feature = a.feature_difference(&b, i);
            // The two pipelines meet: a difference in features amplifies the difference in colour.
            *error = color.powf(1.0 - feature);
        }
    });
    Ok(errors)
}

/// The mean of [`flip_map`], the one number its authors recommend.
///
/// # Errors
/// As [`flip_map`].
///
/// ```
/// use rilievo::measure::{DEFAULT_PIXELS_PER_DEGREE, flip_mean};
/// use rilievo::{Grid, Rgba8};
///
/// let black = Grid::filled(8, 8, Rgba8::new(0, 0, 0, 255))?;
/// let white = Grid::filled(8, 8, Rgba8::new(255, 255, 255, 255))?;
/// assert_eq!(flip_mean(&black, &black, DEFAULT_PIXELS_PER_DEGREE)?, 0.0);
/// assert!(flip_mean(&black, &white, DEFAULT_PIXELS_PER_DEGREE)? > 0.95);
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn flip_mean(reference: &Picture, other: &Picture, pixels_per_degree: f32) -> Result<f64> {
    let errors = flip_map(reference, other, pixels_per_degree)?;
    let rows =
        par::map_range(errors.height() as usize, |y| errors.row(y as u32).iter().map(|&e| f64::from(e)).sum::<f64>());
    Ok(rows.iter().sum::<f64>() / errors.texels().len() as f64)
}

/// Maps a colour distance to 0 … 1: small ones to most of the scale, the rare large ones to what is left.
fn compress(distance: f32, largest: f32) -> f32 {
    let knee = PC * largest;
    if distance < knee { distance * PT / knee } else { PT + (distance - knee) / (largest - knee) * (1.0 - PT) }
}

/// What the eye makes of one picture.
struct Seen {
    /// Hunt-adjusted L*a*b* of what the eye resolves, a plane a channel.
    lab: [Grid<f32>; 3],
    /// Strength of edges.
    edges: Grid<f32>,
    /// Strength of points (and lines).
    points: Grid<f32>,
}

impl Seen {
    fn new(picture: &Picture, spatial: &SpatialFilters, features: &FeatureFilters) -> Self {
        let [y, cx, cz] = ycxcz_planes(&picture.map(|p| compared_rgb(*p)));
        // Features are looked for in the unfiltered luminance, normalised to 0 … 1. The constant does not matter to
        // derivatives.
        let luminance = y.map(|y| y / 116.0);
        let FeatureFilters { smooth, first, second } = features;
        let strength = |derivative: &[f32]| {
            length(convolve(&luminance, derivative, smooth), &convolve(&luminance, smooth, derivative))
        };
        let (edges, points) = (strength(first), strength(second));
        Self { lab: spatial.see(&y, &cx, &cz), edges, points }
    }

    fn lab(&self, i: usize) -> [f32; 3] {
        self.lab.each_ref().map(|plane| plane.texels()[i])
    }

    /// How differently the two pictures look in edges or points, whichever is worse: 0 … 1.
    fn feature_difference(&self, other: &Self, i: usize) -> f32 {
        let edges = (self.edges.texels()[i] - other.edges.texels()[i]).abs();
        let points = (self.points.texels()[i] - other.points.texels()[i]).abs();
        (edges.max(points) / 2.0f32.sqrt()).powf(QF)
    }
}

/// The length of the vector (x, y) in each pixel.
fn length(mut x: Grid<f32>, y: &Grid<f32>) -> Grid<f32> {
    for (x, y) in x.texels_mut().iter_mut().zip(y.texels()) {
        *x = (*x * *x + y * y).sqrt();
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgba8;

    fn flat(w: u32, h: u32, rgb: [u8; 3]) -> Picture {
        Grid::filled(w, h, Rgba8::new(rgb[0], rgb[1], rgb[2], 255)).unwrap()
    }

    #[test]
    fn flat_pictures_err_by_their_colours_alone() {
        // No features and no blur: only the colour distance is left. By construction green against blue is the largest.
        let error = |a, b| flip_mean(&flat(5, 3, a), &flat(5, 3, b), DEFAULT_PIXELS_PER_DEGREE).unwrap();
        assert!((error([0, 255, 0], [0, 0, 255]) - 1.0).abs() < 1e-3);
        assert_eq!(error([12, 200, 77], [12, 200, 77]), 0.0);
        // Black to white: HyAB is 100 in lightness and nothing in chroma.
        let (largest, distance) = (max_distance(QC), 100.0f32.powf(QC));
        assert!((error([0; 3], [255; 3]) - f64::from(compress(distance, largest))).abs() < 1e-3);
    }

    #[test]
    fn one_pixel_is_a_picture() {
        let map = flip_map(&flat(1, 1, [0; 3]), &flat(1, 1, [9, 0, 0]), 67.0).unwrap();
        assert!(map[(0, 0)] > 0.0 && map[(0, 0)] < 0.2);
    }

    #[test]
    fn symmetric_in_its_arguments_and_under_mirroring() {
        let a = Grid::from_fn(23, 17, |x, y| Rgba8::new((x * 11) as u8, (y * 15) as u8, (x * y) as u8, 255)).unwrap();
        let b = Grid::from_fn(23, 17, |x, y| Rgba8::new((x * 11) as u8, (y * 14) as u8, (x + y) as u8, 255)).unwrap();
        let mirrored = |p: &Picture| Grid::from_fn(23, 17, |x, y| p[(22 - x, y)]).unwrap();
        let (ab, ba) = (flip_map(&a, &b, 20.0).unwrap(), flip_map(&b, &a, 20.0).unwrap());
        let flipped = flip_map(&mirrored(&a), &mirrored(&b), 20.0).unwrap();
        for y in 0..17 {
            for x in 0..23 {
                assert_eq!(ab[(x, y)], ba[(x, y)]);
                assert!((ab[(x, y)] - flipped[(22 - x, y)]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn impossible_parameters_are_refused() {
        let p = flat(2, 2, [0; 3]);
        for ppd in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e6] {
            assert!(matches!(flip_mean(&p, &p, ppd), Err(Error::Parameter { .. })), "{ppd}");
        }
        assert!(matches!(flip_mean(&p, &flat(2, 3, [0; 3]), 67.0), Err(Error::SizeMismatch { .. })));
    }
}
