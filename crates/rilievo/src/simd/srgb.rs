//! The sRGB curve.

use super::{Vec3x16, rsqrt, three};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u32x16};

/// Where the curve stops being straight (IEC 61966-2-1).
const TOE: f32 = 0.003_130_8;

/// The 8-bit sRGB code of linear light `c`; what lies outside of 0 … 1 is clipped.
///
/// Rounded codes are those of [`crate::color::srgb_encode`] except within 0.06 codes of a border between two.
#[inline(always)]
pub(crate) fn srgb_code<S: Simd>(simd: S, c: f32x16<S>) -> u32x16<S> {
    // max before min: what is no number becomes 0. Zero itself has no reciprocal root.
    let c = c.max(f32x16::splat(simd, 1e-12)).min(f32x16::splat(simd, 1.0));
    // c^(1/2.4) as a polynomial in c^(1/4), where it is nearly straight.
    let root = c * rsqrt(simd, c);
    let q = root * rsqrt(simd, root);
    let p =
        POLYNOMIAL[1..].iter().fold(f32x16::splat(simd, POLYNOMIAL[0]), |p, &k| p.mul_add(q, f32x16::splat(simd, k)));
    let toe = c.mul_add(f32x16::splat(simd, 12.92 * 255.0), f32x16::splat(simd, 0.5));
    let code = c.simd_lt(f32x16::splat(simd, TOE)).select(toe, p);
    code.to_int::<u32x16<S>>()
}

/// 255 · (1.055 q^(5/3) − 0.055) + ½ for q from the toe's 0.2365 to 1, highest power first: minimax, off by 0.009 codes at most.
const POLYNOMIAL: [f32; 5] = [20.739_137, -85.552_88, 286.283_8, 50.014_65, -15.975_943];

/// Opaque pixels of linear light, encoded, as they lie in memory.
#[inline(always)]
pub(crate) fn srgb_pixel<S: Simd>(simd: S, light: Vec3x16<S>) -> u32x16<S> {
    let [r, g, b] = three!(k => srgb_code(simd, light[k]));
    let opaque = u32x16::splat(simd, u32::from_le_bytes([0, 0, 0, 255]));
    r | (g << 8) | (b << 16) | opaque
}

/// Linear light of an 8-bit sRGB code, off by a seventieth of the distance between two codes at most.
#[inline(always)]
pub(crate) fn srgb_light<S: Simd>(simd: S, code: u32x16<S>) -> f32x16<S> {
    let c = code.bitcast::<i32x16<S>>().to_float::<f32x16<S>>() * (1.0 / 255.0);
    let p = LIGHT[1..].iter().fold(f32x16::splat(simd, LIGHT[0]), |p, &k| p.mul_add(c, f32x16::splat(simd, k)));
    c.simd_lt(f32x16::splat(simd, 0.040_45)).select(c * (1.0 / 12.92), p)
}

/// ((c + 0.055) / 1.055)^2.4 above the toe, highest power first: minimax in codes.
const LIGHT: [f32; 6] = [0.087_300_986, -0.307_418_94, 0.667_193_2, 0.519_371, 0.032_747_58, 0.000_916_827_2];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::srgb_encode;
    use fearless_simd::dispatch;

    #[test]
    fn light_is_that_of_the_code() {
        for level in super::super::levels() {
            for code in 0..=255u32 {
                let found = dispatch!(level, simd => srgb_light(simd, u32x16::splat(simd, code))[3]);
                let back = srgb_encode(found) * 255.0;
                assert!((back - code as f32).abs() < 0.015, "{level:?}: {code} becomes {back}");
            }
        }
    }

    #[test]
    fn codes_are_those_of_the_curve_but_for_borders() {
        for level in super::super::levels() {
            for i in -100..=40_100 {
                let c = i as f32 / 40_000.0;
                let found = dispatch!(level, simd => srgb_code(simd, f32x16::splat(simd, c))[9]);
                let exact = srgb_encode(c.clamp(0.0, 1.0)) * 255.0 + 0.5;
                let borders = [exact - 0.06, exact + 0.06].map(|e| e as u32);
                assert!((borders[0]..=borders[1]).contains(&found), "{level:?}: {c} is {found}, not {exact}");
            }
            for (c, code) in [(f32::NAN, 0), (f32::INFINITY, 255), (-1.0, 0), (f32::MAX, 255)] {
                assert_eq!(dispatch!(level, simd => srgb_code(simd, f32x16::splat(simd, c))[0]), code, "{level:?} {c}");
            }
        }
    }
}
