//! What portable vectors lack: reciprocal roots, powers, look-ups in tables, the sRGB curve; sixteen lanes at a time.
//!
//! All is generic over the instruction set; where a set has an instruction of its own for it, that is used (the level of
//! a token is known when the code is compiled, so nothing is asked at run time). Results may differ in the last bits
//! from set to set: for pictures, not for files.
//!
//! - **Determinism:** class C; each function says how far it may be off, and the tests hold it to `f64`.

mod gather;
mod power;
mod root;
mod srgb;

pub(crate) use gather::{gather, gather_u16};
pub(crate) use power::{Power, exp2, log2};
pub(crate) use root::{recip, rsqrt};
pub(crate) use srgb::srgb_code;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

/// Lanes of the vectors here.
pub(crate) const LANES: usize = 16;

/// A vector of three components in each lane.
pub(crate) type Vec3x16<S> = [f32x16<S>; 3];

/// The inner product.
#[inline(always)]
pub(crate) fn dot<S: Simd>(a: Vec3x16<S>, b: Vec3x16<S>) -> f32x16<S> {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// `v` times `s`.
#[inline(always)]
pub(crate) fn scale<S: Simd>(v: Vec3x16<S>, s: f32x16<S>) -> Vec3x16<S> {
    v.map(|c| c * s)
}

/// The vector product.
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: Vec3x16<S>, b: Vec3x16<S>) -> Vec3x16<S> {
    let part = |i: usize, j: usize| a[i].mul_sub(b[j], a[j] * b[i]);
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// `v` at unit length. The zero vector becomes no number.
#[inline(always)]
pub(crate) fn normalize<S: Simd>(simd: S, v: Vec3x16<S>) -> Vec3x16<S> {
    scale(v, rsqrt(simd, dot(v, v)))
}

/// One value in all lanes.
#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, value: f32) -> f32x16<S> {
    f32x16::splat(simd, value)
}

/// One vector in all lanes.
#[inline(always)]
pub(crate) fn splat3<S: Simd>(simd: S, value: [f32; 3]) -> Vec3x16<S> {
    value.map(|v| splat(simd, v))
}

/// The token of every instruction set this machine has, the plainest first: what tests run kernels on.
#[cfg(test)]
pub(crate) fn levels() -> Vec<fearless_simd::Level> {
    let best = fearless_simd::Level::new();
    let mut found = vec![fearless_simd::Level::baseline()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use fearless_simd::Level;
        found.extend(best.as_sse4_2().map(Level::Sse4_2));
        found.extend(best.as_avx2().map(Level::Avx2));
        found.extend(best.as_avx512().map(Level::Avx512));
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    found.push(best);
    found
}
