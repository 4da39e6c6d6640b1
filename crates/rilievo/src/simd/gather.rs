//! Look-ups and prefetches: each lane reads a table at an index of its own.
//!
//! The one place in the crate with unsafe code: instruction sets from AVX2 on look up eight or sixteen words at once, and those
//! instructions take addresses. Indices are limited to the table here, in front of each of them, so whatever the caller computed,
//! no lane reads beyond it. Refused: sixteen checked loads, which the sets without such an instruction use; they make
//! a frame by table half as long again (`cargo xtask bench raster`).
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "gather instructions take addresses; indices are limited here")
)]

#[cfg(target_arch = "x86_64")]
use fearless_simd::Level;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};

/// `table[index]` in each lane; an index beyond the table reads its last word.
///
/// # Panics
/// If the table is empty.
#[inline(always)]
pub(crate) fn gather<S: Simd>(simd: S, table: &[u32], index: u32x16<S>) -> u32x16<S> {
    assert!(!table.is_empty(), "a table to look up in has entries");
    // Indices are signed to the instructions; tables of more than 2³¹ words are read as if they ended there.
    let last = (table.len() - 1).min(i32::MAX as usize) as u32;
    let index = index.min(u32x16::splat(simd, last));
    match simd.level() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn look_up(
                    token: Avx512,
                    table: &[u32],
                    index: core::arch::x86_64::__m512i,
                ) -> core::arch::x86_64::__m512i {
                    let _ = token;
                    // SAFETY: every index is below `table.len()` and below 2³¹ (see above), so each of the sixteen words
                    // that are read lies within the slice; the scale is the size of a word.
                    unsafe { core::arch::x86_64::_mm512_i32gather_epi32::<4>(index, table.as_ptr().cast()) }
                }
            );
            look_up(token, table, index.into()).simd_into(simd)
        }
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn look_up(
                    token: Avx2,
                    table: &[u32],
                    index: core::arch::x86_64::__m256i,
                ) -> core::arch::x86_64::__m256i {
                    let _ = token;
                    // SAFETY: as above, for eight words.
                    unsafe { core::arch::x86_64::_mm256_i32gather_epi32::<4>(table.as_ptr().cast(), index) }
                }
            );
            let (low, high) = index.split();
            let low: fearless_simd::u32x8<S> = look_up(token, table, low.into()).simd_into(simd);
            let high: fearless_simd::u32x8<S> = look_up(token, table, high.into()).simd_into(simd);
            low.combine(high)
        }
        _ => u32x16::from_fn(simd, |lane| table[index[lane] as usize]),
    }
}

/// Half-words of a table that holds two in each word, the first in the low half; an index beyond it reads the last pair's.
///
/// # Panics
/// If the table is empty.
#[inline(always)]
pub(crate) fn gather_u16<S: Simd>(simd: S, pairs: &[u32], index: u32x16<S>) -> u32x16<S> {
    let pair = gather(simd, pairs, index >> 1);
    // A shift by 0 or 16, as a choice: shifts by lane are slow on the older sets.
    let odd = (index & 1).simd_eq(u32x16::splat(simd, 1));
    odd.select(pair >> 16, pair & 0xffff)
}

/// Sends for the cache lines of `table[index]`, so that a look-up some hundred instructions later need not wait for them.
///
/// A look-up itself, however early, holds up everything behind it until its words are there: processors finish instructions in order.
#[inline(always)]
pub(crate) fn prefetch<S: Simd>(table: &[u32], index: u32x16<S>) {
    #[cfg(target_arch = "x86_64")]
    {
        let mut indices = [0; 16];
        index.store_array(&mut indices);
        for i in indices {
            let word = table.as_ptr().wrapping_add(i as usize);
            // SAFETY: a hint, which reads nothing and is ignored for an address that is nobody's; every processor of this
            // architecture has it.
            unsafe { core::arch::x86_64::_mm_prefetch::<{ core::arch::x86_64::_MM_HINT_T0 }>(word.cast()) }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (table, index);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::dispatch;

    #[test]
    fn lanes_read_their_words_and_none_beyond() {
        for level in super::super::levels() {
            for len in [1usize, 2, 5, 64, 1000] {
                let table: Vec<u32> = (0..len as u32).map(|i| i.wrapping_mul(0x9e37_79b9) ^ 0x8000_0001).collect();
                let wanted: [u32; 16] =
                    std::array::from_fn(|i| if i % 5 == 4 { u32::MAX - i as u32 } else { i as u32 * 37 % 1100 });
                let found: [u32; 16] = dispatch!(level, simd => gather(simd, &table, wanted.simd_into(simd)).into());
                let halves: [u32; 16] =
                    dispatch!(level, simd => gather_u16(simd, &table, wanted.simd_into(simd)).into());
                // Anywhere, there or not.
                dispatch!(level, simd => prefetch::<_>(&table, u32x16::simd_from(simd, wanted)));
                for lane in 0..16 {
                    let at = |i: u32| table[(i as usize).min(len - 1)];
                    assert_eq!(found[lane], at(wanted[lane]), "{level:?} {len}");
                    let half = at(wanted[lane] / 2) >> (wanted[lane] % 2 * 16) & 0xffff;
                    assert_eq!(halves[lane], half, "{level:?} {len}");
                }
            }
        }
    }
}
