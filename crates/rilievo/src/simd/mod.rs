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

pub(crate) use gather::{gather, gather_u16, prefetch};
pub(crate) use power::{Power, exp2, log2};
pub(crate) use root::{recip, rsqrt};
pub(crate) use srgb::{srgb_code, srgb_light, srgb_pixel};

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

/// Lanes of the vectors here.
pub(crate) const LANES: usize = 16;

/// `[f(0), f(1), f(2)]` without a closure.
///
/// Instructions of a set are only inlined into functions compiled for that set. A closure in `[T; 3]::map` is a function of its
/// own that is not, and each addition in it becomes a call: twenty times slower, and nothing says so. Hence this; and
/// `#[inline(always)]` on every function and on every closure that has lanes in it.
macro_rules! three {
    ($k:ident => $value:expr) => {
        [
            {
                let $k = 0usize;
                $value
            },
            {
                let $k = 1usize;
                $value
            },
            {
                let $k = 2usize;
                $value
            },
        ]
    };
}

/// `[f(0), f(1)]`, as [`three`].
macro_rules! two {
    ($k:ident => $value:expr) => {
        [
            {
                let $k = 0usize;
                $value
            },
            {
                let $k = 1usize;
                $value
            },
        ]
    };
}

pub(crate) use {three, two};

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
    three!(k => v[k] * s)
}

/// The vector product.
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: Vec3x16<S>, b: Vec3x16<S>) -> Vec3x16<S> {
    [a[1].mul_sub(b[2], a[2] * b[1]), a[2].mul_sub(b[0], a[0] * b[2]), a[0].mul_sub(b[1], a[1] * b[0])]
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
    three!(k => splat(simd, value[k]))
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
