//! Angles from IEEE operations alone.
//!
//! Vertex normals and tangents are weighted by angles and end up in baked maps, whose bits must not depend on the
//! platform's mathematical library; `f64::acos` and `atan2` do.

use std::f64::consts::{FRAC_PI_2, PI};

/// The angle of the direction (x, y) with y ≥ 0, in 0 … π; 0 for the origin. Within 1e-15 of the true angle.
pub(super) fn angle_of(y: f64, x: f64) -> f64 {
    if !(y > 0.0 || x < 0.0) {
        return 0.0;
    }
    if x < 0.0 {
        PI - angle_of(y, -x)
    } else if y > x {
        FRAC_PI_2 - atan_small(x / y)
    } else {
        atan_small(y / x)
    }
}

/// acos for −1 … 1, clamped; from the half-angle form that does not lose the small angles.
pub(super) fn acos(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    angle_of(((1.0 - x) * (1.0 + x)).sqrt(), x)
}

/// atan for 0 … 1: halved twice by atan x = 2 atan(x / (1 + √(1 + x²))), then the series, which at x ≤ tan(π/16) ≈ 0.2
/// needs twelve terms to 1e-17.
fn atan_small(x: f64) -> f64 {
    let halved = |x: f64| x / (1.0 + (1.0 + x * x).sqrt());
    let t = halved(halved(x));
    let square = t * t;
    let series = (0..12).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 1) - square * sum);
    4.0 * t * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_agree_with_libm() {
        for i in 0..=100_000 {
            let a = PI * f64::from(i) / 100_000.0;
            for length in [1e-100, 1.0, 1e100] {
                assert!((angle_of(a.sin().abs() * length, a.cos() * length) - a).abs() < 2e-15, "{a}");
            }
            assert!((acos(a.cos()) - a.cos().acos()).abs() < 2e-15, "{a}");
        }
        assert_eq!((angle_of(0.0, 0.0), angle_of(0.0, 1.0), angle_of(0.0, -1.0)), (0.0, 0.0, PI));
        assert_eq!((acos(2.0), acos(-2.0)), (0.0, PI));
    }
}
