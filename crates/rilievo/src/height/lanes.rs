//! Codes of normals, sixteen texels at a time, to the bit those of the scalar path.
//!
//! The scalar path takes a root and three divisions, which is too slow by three. Here a reciprocal root is estimated and
//! refined, which gives each component to a few units of 2⁻¹⁵ of a code. Where that leaves no doubt about the code, it
//! is the scalar path's; in the few texels whose component lies that close to the border of two codes, the scalar path
//! is asked. So how an instruction set estimates roots, and whether it fuses, is not in the result.

#[cfg(target_arch = "x86_64")]
use fearless_simd::Level;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16, u8x64, u16x16, u32x16};

use super::Filter;
use crate::normal::{Normal, encode_u8};

/// Texels of a vector.
pub(super) const LANES: usize = 16;

/// Scales this small or large go the scalar way: their squares might leave the range of f32.
const SCALES: std::ops::Range<f32> = 1e-12..1e12;

/// Units of a code.
const UNITS: f32 = 32_768.0;
/// The estimate is taken for certain if it is this many units from the border of two codes.
///
/// The scalar path's rounding errors add up to 5½ · 2⁻²⁴ of a component at most: one of the slope, half of five of the
/// squared length, of the root, of the division. Here it is 6, and 2½ more where nothing is fused. 14 · 2⁻²⁴ of 127.5
/// codes are 3.5 units, and the rounding of the sum takes another quarter.
const MARGIN: i32 = 4;
/// The bits of a sum that are all zero if it is less than two margins above a border.
const BORDER: i32 = 0x7fff & !(2 * MARGIN - 1);

/// Three rows of heights: above, here, below.
pub(super) type Rows<'a> = [&'a [u16]; 3];

/// How differences of heights become slopes of a filter, away from clamped borders.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slopes {
    filter: Filter,
    /// From the filter's weighted difference to slope.
    scale: f32,
}

impl Slopes {
    /// `scale` is from height per texel to slope. `None` if it is out of the range that vectors can do.
    pub(super) fn new(filter: Filter, scale: f32) -> Option<Self> {
        // Powers of two: nothing is rounded that the scalar path does not round.
        let weights = match filter {
            Filter::Plane4 | Filter::Plane8 => 2.0,
            Filter::Sobel => 8.0,
            Filter::Scharr => 32.0,
        };
        let vectors = SCALES.contains(&scale.abs()) && cfg!(target_endian = "little");
        vectors.then_some(Self { filter, scale: scale / weights })
    }

    /// Packed codes of all texels of the middle row but the first and the last; `rows` are as long as `out`.
    ///
    /// Says whether it did: rows of less than a vector and two ends it leaves alone.
    #[inline(always)]
    pub(super) fn interior<S: Simd>(self, simd: S, rows: Rows<'_>, out: &mut [[u8; 4]]) -> bool {
        let Some(inside) = out.len().checked_sub(2).filter(|&n| n >= LANES) else { return false };
        let whole = inside - inside % LANES;
        self.vectors(simd, rows, &mut out[1..=whole]);
        if whole < inside {
            // What is left over is done as a last vector that overlaps the one before.
            let start = inside - LANES;
            let [above, here, below] = rows;
            self.vectors(simd, [&above[start..], &here[start..], &below[start..]], &mut out[1 + start..=inside]);
        }
        true
    }

    /// Whole vectors; `rows` begin one texel to the left of `out`.
    #[inline(always)]
    fn vectors<S: Simd>(self, simd: S, rows: Rows<'_>, out: &mut [[u8; 4]]) {
        let out = out.as_flattened_mut();
        match self.filter {
            Filter::Plane4 => self.cross(simd, rows, out),
            Filter::Plane8 => self.product::<S, 0>(simd, rows, out),
            Filter::Sobel => self.product::<S, 1>(simd, rows, out),
            Filter::Scharr => self.product::<S, 2>(simd, rows, out),
        }
    }

    #[inline(always)]
    fn cross<S: Simd>(self, simd: S, [above, here, below]: Rows<'_>, out: &mut [u8]) {
        let along = here.chunks_exact(LANES).zip(here[2..].chunks_exact(LANES));
        let across = above[1..].chunks_exact(LANES).zip(below[1..].chunks_exact(LANES));
        for (((left, right), (up, down)), out) in along.zip(across).zip(out.chunks_exact_mut(LANES * 4)) {
            let [left, right, up, down] = [load(simd, left), load(simd, right), load(simd, up), load(simd, down)];
            self.pack(simd, (right - left).to_float(), (up - down).to_float(), out);
        }
    }

    /// The weights (1 1 1), (1 2 1) or (3 10 3) by `KIND`.
    #[inline(always)]
    fn product<S: Simd, const KIND: u8>(self, simd: S, [above, here, below]: Rows<'_>, out: &mut [u8]) {
        let rows = windows(above).zip(windows(here)).zip(windows(below));
        for (((a, h), b), out) in rows.zip(out.chunks_exact_mut(LANES * 4)) {
            let [a0, a1, a2] = [load(simd, a.0), load(simd, a.1), load(simd, a.2)];
            let [h0, h2] = [load(simd, h.0), load(simd, h.2)];
            let [b0, b1, b2] = [load(simd, b.0), load(simd, b.1), load(simd, b.2)];
            if KIND == 0 {
                // A third is no binary fraction: rounded as the scalar path rounds it.
                let third = f32x16::splat(simd, 1.0 / 3.0);
                let mean = |first: i32x16<S>, middle: i32x16<S>, last: i32x16<S>| -> f32x16<S> {
                    let [first, middle, last]: [f32x16<S>; 3] = [first.to_float(), middle.to_float(), last.to_float()];
                    (first * third + last * third) + middle * third
                };
                let right = mean(a2 - a0, h2 - h0, b2 - b0);
                let up = mean(a0 - b0, a1 - b1, a2 - b2);
                self.pack(simd, right, up, out);
            } else {
                // The two diagonals serve both directions.
                let (falling, rising) = (a0 - b2, a2 - b0);
                let (sides_right, sides_up) = (rising - falling, rising + falling);
                let (middle_right, middle_up) = (h2 - h0, a1 - b1);
                let (right, up) = if KIND == 1 {
                    (sides_right + (middle_right << 1), sides_up + (middle_up << 1))
                } else {
                    (sides_right * 3 + middle_right * 10, sides_up * 3 + middle_up * 10)
                };
                self.pack(simd, right.to_float(), up.to_float(), out);
            }
        }
    }

    /// Writes the codes of normals whose slopes are `right` and `up` times the scale.
    #[inline(always)]
    fn pack<S: Simd>(self, simd: S, right: f32x16<S>, up: f32x16<S>, out: &mut [u8]) {
        let splat = |v: f32| f32x16::splat(simd, v);
        let steepness = up.mul_add(up, right * right);
        let squared = steepness.mul_add(splat(self.scale * self.scale), splat(1.0));
        let root = estimate(simd, squared);
        // One step of Newton, times 127.5 codes: y (3 − q y²) / 2.
        let codes = 127.5 * UNITS;
        let inverse = root * (squared * (root * root)).mul_add(splat(-0.5 * codes), splat(1.5 * codes));
        let turned = inverse * splat(-self.scale);
        let middle = splat(128.0 * UNITS + MARGIN as f32);
        let x: i32x16<S> = right.mul_add(turned, middle).to_int();
        let y: i32x16<S> = up.mul_add(turned, middle).to_int();
        let z: i32x16<S> = (inverse + middle).to_int();
        let alpha = i32x16::splat(simd, 0xff00_0000_u32 as i32);
        let packed = (x >> 15) | ((y >> 7) & 0xff00) | ((z << 1) & 0x00ff_0000) | alpha;
        let bytes: u8x64<S> = packed.bitcast();
        bytes.store_slice(out);
        // No slope at all lies on a border, but there is no doubt about it.
        let doubtful = ((x & BORDER).simd_eq(0) & right.simd_ne(0.0))
            | ((y & BORDER).simd_eq(0) & up.simd_ne(0.0))
            | (z & BORDER).simd_eq(0);
        if doubtful.any_true() {
            let (right, up) = ((right * self.scale).to_array(), (up * self.scale).to_array());
            let mut lanes = doubtful.to_bitmask();
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                out[lane * 4..lane * 4 + 4].copy_from_slice(&code(right[lane], up[lane]));
            }
        }
    }
}

/// The packed code of a normal with these slopes: what everything here is held to.
#[inline(always)]
pub(super) fn code(right: f32, up: f32) -> [u8; 4] {
    let [r, g, b] = encode_u8(Normal::from_slopes(right, up));
    [r, g, b, 255]
}

/// Neighbouring vectors of a row: from the texel before, from the texel itself, from the texel after.
#[inline(always)]
fn windows(row: &[u16]) -> impl Iterator<Item = (&[u16], &[u16], &[u16])> {
    let from = |start: usize| row[start..].chunks_exact(LANES);
    from(0).zip(from(1)).zip(from(2)).map(|((before, here), after)| (before, here, after))
}

#[inline(always)]
fn load<S: Simd>(simd: S, heights: &[u16]) -> i32x16<S> {
    let (low, high) = u16x16::from_slice(simd, heights).widen();
    low.combine(high).bitcast()
}

/// 1/√`a` within 2⁻¹³ for 1 ≤ `a`.
#[inline(always)]
fn estimate<S: Simd>(simd: S, a: f32x16<S>) -> f32x16<S> {
    #[cfg(target_arch = "x86_64")]
    if let Level::Avx512(token) = simd.level() {
        fearless_simd::kernel!(
            #[inline(always)]
            fn estimate(token: Avx512, a: core::arch::x86_64::__m512) -> core::arch::x86_64::__m512 {
                let _ = token;
                core::arch::x86_64::_mm512_rsqrt14_ps(a)
            }
        );
        return estimate(token, a.into()).simd_into(simd);
    }
    // Half the exponent, negated, and a line for the mantissa: within 3.5 %. Then a step of third order.
    let bits: u32x16<S> = a.bitcast();
    let y: f32x16<S> = (u32x16::splat(simd, 0x5f37_5a86) - (bits >> 1)).bitcast();
    let splat = |v: f32| f32x16::splat(simd, v);
    let error = splat(1.0) - a * y * y;
    (y * error).mul_add(error.mul_add(splat(0.375), splat(0.5)), y)
}
