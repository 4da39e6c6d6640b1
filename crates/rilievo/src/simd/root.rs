//! Reciprocals and reciprocal roots.

#[cfg(target_arch = "x86_64")]
use fearless_simd::Level;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

/// 1/√`a` for normal, positive `a`, within 2⁻¹³ (half an 8-bit code of a highlight of exponent 128); other values give
/// garbage in their lane.
///
/// An estimate, refined by one step of Newton where the instruction has fewer than 14 bits, or a root and a division
/// where there is no estimate.
#[inline(always)]
pub(crate) fn rsqrt<S: Simd>(simd: S, a: f32x16<S>) -> f32x16<S> {
    match simd.level() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn estimate(token: Avx512, a: core::arch::x86_64::__m512) -> core::arch::x86_64::__m512 {
                    let _ = token;
                    core::arch::x86_64::_mm512_rsqrt14_ps(a)
                }
            );
            estimate(token, a.into()).simd_into(simd)
        }
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn estimate(token: Avx2, a: core::arch::x86_64::__m256) -> core::arch::x86_64::__m256 {
                    let _ = token;
                    core::arch::x86_64::_mm256_rsqrt_ps(a)
                }
            );
            let (low, high) = a.split();
            let low: fearless_simd::f32x8<S> = estimate(token, low.into()).simd_into(simd);
            let high: fearless_simd::f32x8<S> = estimate(token, high.into()).simd_into(simd);
            refine(a, low.combine(high))
        }
        _ => 1.0 / a.sqrt(),
    }
}

/// One step of Newton: `r` (3 − a r²) / 2.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn refine<S: Simd>(a: f32x16<S>, r: f32x16<S>) -> f32x16<S> {
    r * (1.5 - a * 0.5 * r * r)
}

/// 1/`a` for normal `a`, within 2⁻²¹: an estimate and one step of Newton.
#[inline(always)]
pub(crate) fn recip<S: Simd>(a: f32x16<S>) -> f32x16<S> {
    let r = a.approximate_recip();
    r * (2.0 - a * r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::dispatch;

    #[test]
    fn roots_and_reciprocals_are_as_near_as_promised() {
        for level in super::super::levels() {
            for i in 0..4000 {
                let a = (f64::from(i) * 0.02 - 40.0).exp2() as f32 * 1.37;
                let [root, inverse] = dispatch!(level, simd => {
                    let v = f32x16::splat(simd, a);
                    [rsqrt(simd, v)[3], recip(v)[7]]
                });
                let off = |found: f32, exact: f64| (f64::from(found) / exact - 1.0).abs();
                assert!(off(root, 1.0 / f64::from(a).sqrt()) < 2f64.powi(-13), "{level:?} {a}");
                assert!(off(inverse, 1.0 / f64::from(a)) < 2f64.powi(-21), "{level:?} {a}");
            }
        }
    }
}
