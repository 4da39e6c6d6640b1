//! The sphere unfolded to a square, and two curves that visit the square.
//!
//! The octahedral map (Meyer et al. 2010, "On floating-point normal vectors") needs only + − × ÷, so both orders are the
//! same on every machine. Morton order makes a quadtree of a sorted list; Hilbert order keeps neighbours in a table
//! neighbours on the sphere, which is what file compression lives on.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, u32x8};

use super::entries::normalized;
use super::points::LANES;

/// Bits of one coordinate in a Morton code.
pub(super) const MORTON_BITS: u32 = 17;
/// Bits of a whole Morton code.
pub(super) const MORTON_CODE_BITS: u32 = 2 * MORTON_BITS;
/// Bits of one coordinate in a Hilbert code.
const HILBERT_BITS: u32 = 16;

/// A non-zero vector as a point of the unit square; its length does not matter.
fn octahedral([x, y, z]: [f32; 3]) -> [f32; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    let (u, v) = (x / sum, y / sum);
    let toward = |c: f32| if c >= 0.0 { 1.0 } else { -1.0 };
    let (u, v) = if z < 0.0 { ((1.0 - v.abs()) * toward(u), (1.0 - u.abs()) * toward(v)) } else { (u, v) };
    [u * 0.5 + 0.5, v * 0.5 + 0.5]
}

/// The unit vector of a point of the square.
pub(super) fn direction(at: [f64; 2]) -> [f64; 3] {
    let [a, b] = at.map(|c| c * 2.0 - 1.0);
    let z = 1.0 - a.abs() - b.abs();
    // The lower half is folded over the edges of the upper one.
    let fold = (-z).max(0.0);
    normalized([a - fold.copysign(a), b - fold.copysign(b), z])
}

/// The square's cell of a vector, with `bits` bits per side.
fn cell(direction: [f32; 3], bits: u32) -> [u32; 2] {
    let side = 1u32 << bits;
    octahedral(direction).map(|c| ((c * side as f32) as u32).min(side - 1))
}

/// Moves bit i to bit 2i.
fn spread(v: u32) -> u64 {
    let mut v = u64::from(v);
    v = (v | v << 16) & 0x0000_ffff_0000_ffff;
    v = (v | v << 8) & 0x00ff_00ff_00ff_00ff;
    v = (v | v << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    v = (v | v << 2) & 0x3333_3333_3333_3333;
    (v | v << 1) & 0x5555_5555_5555_5555
}

/// Where a direction stands in Morton order; below 2³⁴.
pub(super) fn morton(direction: [f32; 3]) -> u64 {
    let [u, v] = cell(direction, MORTON_BITS);
    spread(u) | spread(v) << 1
}

/// [`morton`] of eight directions, to the bit.
#[inline(always)]
pub(super) fn morton_lanes<S: Simd>(simd: S, [x, y, z]: [f32x8<S>; 3]) -> [u64; LANES] {
    let one = f32x8::splat(simd, 1.0);
    let sum = x.abs() + y.abs() + z.abs();
    let (u, v) = (x / sum, y / sum);
    let toward = |c: f32x8<S>| c.simd_ge(0.0).select(one, -one);
    let folded = z.simd_lt(0.0);
    let (u, v) = (folded.select((one - v.abs()) * toward(u), u), folded.select((one - u.abs()) * toward(v), v));
    let top = (1u32 << MORTON_BITS) - 1;
    let cell = |c: f32x8<S>| {
        let cells: u32x8<S> = ((c * 0.5 + 0.5) * (top + 1) as f32).to_int();
        cells.min(top).to_array()
    };
    let (u, v) = (cell(u), cell(v));
    std::array::from_fn(|l| spread(u[l]) | spread(v[l]) << 1)
}

/// Where a direction stands along the Hilbert curve.
pub(super) fn hilbert(direction: [f32; 3]) -> u32 {
    let [mut u, mut v] = cell(direction, HILBERT_BITS);
    let mut code = 0;
    for bit in (0..HILBERT_BITS).rev() {
        let (ru, rv) = (u >> bit & 1, v >> bit & 1);
        code = code << 2 | ((3 * ru) ^ rv);
        // Turn the quadrant so that the curve enters it where it left the last one.
        let low = (1 << bit) - 1;
        u &= low;
        v &= low;
        if rv == 0 {
            if ru == 1 {
                (u, v) = (low - u, low - v);
            }
            (u, v) = (v, u);
        }
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octahedral_puts_the_axes_where_they_belong() {
        assert_eq!(octahedral([0.0, 0.0, 1.0]), [0.5, 0.5]);
        assert_eq!(octahedral([1.0, 0.0, 0.0]), [1.0, 0.5]);
        assert_eq!(octahedral([0.0, -1.0, 0.0]), [0.5, 0.0]);
        assert_eq!(octahedral([0.0, 0.0, -1.0]), [1.0, 1.0]);
    }

    #[test]
    fn morton_interleaves_all_bits() {
        assert_eq!(spread(0b1011), 0b100_0101);
        assert_eq!(spread(u32::MAX), 0x5555_5555_5555_5555);
        assert_eq!(morton([0.0, 0.0, -1.0]), (1 << MORTON_CODE_BITS) - 1);
        assert_eq!(morton([0.0, 0.0, 1.0]), 3 << (MORTON_CODE_BITS - 2));
    }

    /// Walking the curve means: sorted by code, consecutive cells of a coarse raster share an edge.
    #[test]
    fn hilbert_neighbours_are_neighbours() {
        let side = 32u32;
        let mut cells = Vec::new();
        for v in 0..side {
            for u in 0..side {
                let middle = [u, v].map(|c| (f64::from(c) + 0.5) / f64::from(side));
                cells.push((hilbert(direction(middle).map(|c| c as f32)), u, v));
            }
        }
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let ((_, u, v), (_, s, t)) = (pair[0], pair[1]);
            assert_eq!(u.abs_diff(s) + v.abs_diff(t), 1, "{pair:?}");
        }
    }
}
