//! The colour spaces of ꟻLIP: YCxCz to filter in (linear in light), Hunt-adjusted L*a*b* to measure distances in.

use crate::color::LinearRgb;
use crate::grid::Grid;

/// sRGB primaries with D65 white to XYZ, as the exact fractions that the standard's chromaticities give.
const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// XYZ relative to the white point, so that white is (1, 1, 1): the rows of the matrix scaled to sum 1.
fn white_relative(rgb: [f32; 3]) -> [f32; 3] {
    RGB_TO_XYZ.map(|row| {
        let sum: f64 = row.iter().sum();
        (0..3).map(|c| (row[c] / sum) as f32 * rgb[c]).sum()
    })
}

/// The inverse of [`white_relative`].
///
/// Digits from inverting the matrix above; `white_relative_inverts` holds them.
fn linear_rgb([x, y, z]: [f32; 3]) -> [f32; 3] {
    const XYZ_TO_RGB: [[f32; 3]; 3] = [
        [3.080_342, -1.537_399, -0.542_943],
        [-0.921_178_4, 1.875_93, 0.045_248_41],
        [0.052_881_29, -0.204_011_2, 1.151_13],
    ];
    XYZ_TO_RGB.map(|[a, b, c]| a * x + b * y + c * z)
}

/// The picture in YCxCz, a plane a channel: L*a*b* without its cube root, so that filtering it is filtering light.
pub(super) fn ycxcz_planes(picture: &Grid<[u8; 3]>) -> [Grid<f32>; 3] {
    let decoded: Vec<f32> = (0..=255).map(|v| LinearRgb::from_srgb([v; 3]).r).collect();
    let xyz = picture.map(|rgb| white_relative(rgb.map(|v| decoded[usize::from(v)])));
    [xyz.map(|[_, y, _]| 116.0 * y - 16.0), xyz.map(|[x, y, _]| 500.0 * (x - y)), xyz.map(|[_, y, z]| 200.0 * (y - z))]
}

/// Hunt-adjusted L*a*b* of a colour in YCxCz, clipped to what a monitor can show.
pub(super) fn hunt_lab([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let luminance = (y + 16.0) / 116.0;
    let rgb = linear_rgb([luminance + cx / 500.0, luminance, luminance - cz / 200.0]);
    hunt_lab_of_rgb(rgb.map(|c| c.clamp(0.0, 1.0)))
}

fn hunt_lab_of_rgb(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = white_relative(rgb).map(lab_curve);
    let lightness = 116.0 * y - 16.0;
    // Hunt effect: colours look less colourful where it is dark.
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// CIE 1976: the cube root, with a straight line near black.
fn lab_curve(t: f32) -> f32 {
    const DELTA: f32 = 6.0 / 29.0;
    if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

/// HyAB: city-block in lightness, Euclidean in the chroma plane. Right for large distances too.
pub(super) fn color_distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [l, u, v] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    l.abs() + (u * u + v * v).sqrt()
}

/// The largest distance between two displayable colours, green and blue, to the power `exponent`.
pub(super) fn max_distance(exponent: f32) -> f32 {
    color_distance(hunt_lab_of_rgb([0.0, 1.0, 0.0]), hunt_lab_of_rgb([0.0, 0.0, 1.0])).powf(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_relative_inverts() {
        for rgb in [[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.7, 0.05]] {
            let back = linear_rgb(white_relative(rgb));
            for c in 0..3 {
                assert!((back[c] - rgb[c]).abs() < 2e-6, "{rgb:?} {back:?}");
            }
        }
    }

    #[test]
    fn white_is_light_without_colour() {
        let [l, a, b] = hunt_lab_of_rgb([1.0; 3]);
        assert!((l - 100.0).abs() < 1e-4 && a.abs() < 1e-3 && b.abs() < 1e-3);
        assert_eq!(hunt_lab_of_rgb([0.0; 3]), [0.0; 3]);
    }

    #[test]
    fn no_pair_of_corners_of_the_cube_is_farther_apart_than_green_and_blue() {
        let corners: Vec<_> = (0..8).map(|i| hunt_lab_of_rgb([i & 1, i >> 1 & 1, i >> 2].map(|c| c as f32))).collect();
        for a in &corners {
            for b in &corners {
                assert!(color_distance(*a, *b) <= max_distance(1.0));
            }
        }
    }
}
