//! Powers and logarithms.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16};

/// Bits of the fraction of a float.
const FRACTION_BITS: u32 = 23;
/// The bits of 1.0: exponent 0, fraction 0.
const ONE_BITS: i32 = 127 << FRACTION_BITS;

/// 2^`x` for `x` within ±126, relative error below 4·10⁻⁷ · (1 + |x|). Outside of that range the result is that of its end.
#[inline(always)]
pub(crate) fn exp2<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let x = x.max(f32x16::splat(simd, -126.0)).min(f32x16::splat(simd, 126.0));
    let whole = x.round_ties_even();
    let f = x - whole;
    // Minimax on ±½ (relative error 2·10⁻⁹).
    let p = f.mul_add(f32x16::splat(simd, 1.534_581_2e-4), f32x16::splat(simd, 1.339_993_1e-3));
    let p = f.mul_add(p, f32x16::splat(simd, 9.618_489e-3));
    let p = f.mul_add(p, f32x16::splat(simd, 5.550_328_8e-2));
    let p = f.mul_add(p, f32x16::splat(simd, 0.240_226_47));
    let p = f.mul_add(p, f32x16::splat(simd, 0.693_147_2));
    let p = f.mul_add(p, f32x16::splat(simd, 1.0));
    let exponent: i32x16<S> = (whole.to_int::<i32x16<S>>() << FRACTION_BITS) + ONE_BITS;
    p * exponent.bitcast::<f32x16<S>>()
}

/// log₂ `x` for normal, positive `x`, absolute error below 2·10⁻⁷ · (1 + |log₂ x|).
#[inline(always)]
pub(crate) fn log2<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let bits = x.bitcast::<i32x16<S>>();
    // The fraction is taken from √½ to √2, so that logarithms near 1 lose nothing.
    let shifted = bits - 0x3f35_04f3;
    let whole = shifted >> FRACTION_BITS;
    let fraction = (bits - (whole << FRACTION_BITS)).bitcast::<f32x16<S>>();
    // log₂ m = 2/ln 2 · artanh((m − 1)/(m + 1)).
    let s = (fraction - 1.0) / (fraction + 1.0);
    let s2 = s * s;
    let p = s2.mul_add(f32x16::splat(simd, 0.431_754_66), f32x16::splat(simd, 0.576_713_6));
    let p = s2.mul_add(p, f32x16::splat(simd, 0.961_798_85));
    let p = s2.mul_add(p, f32x16::splat(simd, 2.885_390_1));
    s.mul_add(p, whole.to_float::<f32x16<S>>())
}

/// A fixed exponent, and the way its power is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Power {
    exponent: f32,
    /// The exponent where it is whole and small: squarings are cheaper than a logarithm.
    squarings: Option<u32>,
    /// Bases below this have a power too small to see; taken as they are, they would make denormals, which cost a hundred times
    /// as much as other numbers and turn up in every dark pixel.
    least: f32,
}

/// The largest exponent that is taken by squaring.
const MOST_SQUARED: f32 = 1024.0;

impl Power {
    /// Of an exponent ≥ 0.
    pub(crate) fn new(exponent: f32) -> Self {
        let whole = exponent.fract() == 0.0 && (1.0..=MOST_SQUARED).contains(&exponent);
        // A little above 2^(−126/n), so that no rounding on the way gets below the smallest normal number.
        let least = if exponent > 0.0 { (-120.0 / exponent).exp2().max(f32::MIN_POSITIVE) } else { f32::MIN_POSITIVE };
        Self { exponent, squarings: whole.then_some(exponent as u32), least }
    }

    /// `base` to the power, for bases from 0 to 2; those below 0 count as 0.
    ///
    /// The relative error is below 10⁻⁷ · (8 + 2 · exponent); powers below 2⁻¹²⁰ come out as that (2⁻⁶³ for exponents below 1), not as 0.
    #[inline(always)]
    pub(crate) fn of<S: Simd>(self, simd: S, base: f32x16<S>) -> f32x16<S> {
        let base = base.max(f32x16::splat(simd, self.least));
        let Some(mut left) = self.squarings else { return exp2(simd, log2(simd, base) * self.exponent) };
        // The same for all lanes, so the branches are foreseen.
        let mut square = base;
        while left & 1 == 0 {
            square = square * square;
            left >>= 1;
        }
        let mut power = square;
        left >>= 1;
        while left > 0 {
            square = square * square;
            if left & 1 == 1 {
                power = power * square;
            }
            left >>= 1;
        }
        power
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::dispatch;

    #[test]
    fn exponentials_and_logarithms_are_near_those_of_f64() {
        for level in super::super::levels() {
            for i in -12_500..12_500 {
                let x = i as f32 * 0.01;
                let up = dispatch!(level, simd => exp2(simd, f32x16::splat(simd, x))[0]);
                let off = (f64::from(up) / f64::from(x).exp2() - 1.0).abs();
                assert!(off < 4e-7 * (1.0 + f64::from(x.abs())), "{level:?}: 2^{x} is off by {off:e}");
                let back = dispatch!(level, simd => log2(simd, f32x16::splat(simd, up))[15]);
                let exact = f64::from(up).log2();
                assert!((f64::from(back) - exact).abs() < 2e-7 * (1.0 + exact.abs()), "{level:?}: log2 {up} = {back}");
            }
        }
    }

    #[test]
    fn powers_are_near_those_of_f64_and_never_denormal() {
        for level in super::super::levels() {
            for exponent in [0.0f32, 0.5, 1.0, 2.0, 7.0, 32.0, 33.3, 100.0, 1000.0, 5000.0] {
                for i in 0..=1000 {
                    let base = i as f32 / 1000.0;
                    let found = dispatch!(level, simd => Power::new(exponent).of(simd, f32x16::splat(simd, base))[5]);
                    let exact = f64::from(base).powf(f64::from(exponent));
                    assert!(found.is_normal() && found <= 1.0001, "{base}^{exponent} = {found}");
                    if exact > 1e-30 {
                        let off = (f64::from(found) / exact - 1.0).abs();
                        assert!(off < 1e-7 * (8.0 + 2.0 * f64::from(exponent)), "{base}^{exponent}: {off:e}");
                    } else {
                        assert!(found < 1e-18, "{base}^{exponent} = {found}");
                    }
                }
            }
        }
    }
}
