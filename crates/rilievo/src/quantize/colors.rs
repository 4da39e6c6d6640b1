//! The distinct ones among 24-bit colours: a bitmap of all there are, and the rank of each bit that is set.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8};

use super::octahedral;
use super::points::{LANES, NO_POINT};
use crate::par;

/// Words of a bitmap of 2²⁴ bits.
const WORDS: usize = 1 << 18;
/// Texels that are looked up together.
const PIECE: usize = 1 << 16;

/// A word of the bitmap and how many bits are set before it. Together, because they are read together.
#[derive(Debug, Clone, Copy, Default)]
struct Word {
    bits: u64,
    before: u32,
}

/// The distinct colours of a map, in rising order.
#[derive(Debug)]
pub(super) struct Colors {
    /// The colours.
    pub distinct: Vec<[u8; 3]>,
    /// Texels of each.
    pub counts: Vec<u32>,
    /// Which of them each texel has; [`NO_POINT`] where it is not covered.
    pub rank_of: Vec<u32>,
}

#[inline(always)]
fn code([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b)
}

/// Finds the distinct colours of the texels that are `covered`.
pub(super) fn distinct(texels: &[[u8; 3]], covered: Option<&[bool]>) -> Colors {
    let mut words = vec![Word::default(); WORDS];
    let mut last = u32::MAX;
    for (texel, &color) in texels.iter().enumerate() {
        let code = code(color);
        // Equal neighbours are common, and a bit that was just set would have to be waited for.
        if code != last && covered.is_none_or(|c| c[texel]) {
            words[code as usize >> 6].bits |= 1 << (code & 63);
            last = code;
        }
    }
    let mut distinct = Vec::new();
    for (index, word) in words.iter_mut().enumerate() {
        word.before = distinct.len() as u32;
        let mut bits = word.bits;
        while bits != 0 {
            let code = (index as u32) << 6 | bits.trailing_zeros();
            distinct.push([(code >> 16) as u8, (code >> 8) as u8, code as u8]);
            bits &= bits - 1;
        }
    }
    let mut rank_of = vec![NO_POINT; texels.len()];
    let level = Level::new();
    par::for_each_row(&mut rank_of, PIECE, |piece, ranks| {
        let part = piece * PIECE..piece * PIECE + ranks.len();
        let covered = covered.map(|c| &c[part.clone()]);
        dispatch!(level, simd => look_up(simd, &words, &texels[part.clone()], covered, ranks));
    });
    let mut counts = vec![0; distinct.len()];
    for &rank in &rank_of {
        if rank != NO_POINT {
            counts[rank as usize] += 1;
        }
    }
    Colors { distinct, counts, rank_of }
}

/// Ranks of some texels. (The level brings an instruction that counts bits.)
#[inline(always)]
fn look_up<S: Simd>(_simd: S, words: &[Word], texels: &[[u8; 3]], covered: Option<&[bool]>, ranks: &mut [u32]) {
    for (texel, (rank, &color)) in ranks.iter_mut().zip(texels).enumerate() {
        if covered.is_none_or(|c| c[texel]) {
            let code = code(color);
            let word = words[code as usize >> 6];
            *rank = word.before + (word.bits & ((1 << (code & 63)) - 1)).count_ones();
        }
    }
}

/// Colours as the unit vectors that [`crate::normal::decode_u8`] makes of them, and where these stand in Morton order; to
/// the bit, but side by side.
#[inline(always)]
pub(super) fn decode_with_codes<S: Simd>(simd: S, colors: &[[u8; 3]]) -> (Vec<[f32; 3]>, Vec<u64>) {
    let (mut directions, mut codes) = (Vec::with_capacity(colors.len()), Vec::with_capacity(colors.len()));
    for chunk in colors.chunks(LANES) {
        let mut scaled = [[1.0f32; LANES]; 3];
        for (l, color) in chunk.iter().enumerate() {
            for k in 0..3 {
                scaled[k][l] = (2 * i32::from(color[k]) - 255) as f32;
            }
        }
        let v = scaled.map(|c| f32x8::from_slice(simd, &c));
        let largest = v[0].abs().max(v[1].abs()).max(v[2].abs());
        let v = v.map(|c| c / largest);
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let v = v.map(|c| c / length);
        let all = octahedral::morton_lanes(simd, v);
        let [x, y, z] = v.map(f32x8::to_array);
        directions.extend((0..chunk.len()).map(|l| [x[l], y[l], z[l]]));
        codes.extend_from_slice(&all[..chunk.len()]);
    }
    (directions, codes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_side_by_side_are_decoded_as_one_by_one() {
        let colors: Vec<[u8; 3]> = (0..1u32 << 24)
            .step_by(61)
            .chain([0, 0x7f_7f_7f, 0x80_80_80, 0xff_ff_ff, 0x7f_80_00, 0x80_7f_ff])
            .map(|c| [(c >> 16) as u8, (c >> 8) as u8, c as u8])
            .collect();
        for level in [Level::new(), Level::baseline()] {
            let (directions, codes) = dispatch!(level, simd => decode_with_codes(simd, &colors));
            assert_eq!((directions.len(), codes.len()), (colors.len(), colors.len()));
            for (i, &color) in colors.iter().enumerate() {
                let expected = crate::normal::decode_u8::<crate::Object>(color).vec().to_array();
                assert_eq!(directions[i].map(f32::to_bits), expected.map(f32::to_bits), "{color:?}");
                assert_eq!(codes[i], octahedral::morton(expected), "{color:?}");
            }
        }
    }

    #[test]
    fn ranks_are_those_of_the_sorted_colours() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let texels: Vec<[u8; 3]> = (0..100_000).map(|_| [random() >> 2, random() >> 3, random() | 0xf0]).collect();
        let covered: Vec<bool> = (0..texels.len()).map(|_| random() > 20).collect();
        for mask in [None, Some(&covered[..])] {
            let inside = |t: &usize| mask.is_none_or(|m| m[*t]);
            let mut expected: Vec<[u8; 3]> = (0..texels.len()).filter(inside).map(|t| texels[t]).collect();
            expected.sort_unstable();
            expected.dedup();
            let found = distinct(&texels, mask);
            assert_eq!(found.distinct, expected);
            assert_eq!(found.counts.iter().sum::<u32>() as usize, (0..texels.len()).filter(inside).count());
            for (texel, &rank) in found.rank_of.iter().enumerate() {
                let expected = if inside(&texel) {
                    found.distinct.get(rank as usize) == Some(&texels[texel])
                } else {
                    rank == NO_POINT
                };
                assert!(expected, "{texel}");
            }
        }
    }
}
