//! Look-ups, where each lane reads a table at an index of its own, and writes past the caches.
//!
//! The one place in the crate with unsafe code: these instructions take addresses. Sets from AVX2 on look up eight or sixteen words
//! at once; indices are limited to the table here, in front of each, so whatever the caller computed, no lane reads
//! beyond it. Refused: sixteen checked loads, which the sets without such an instruction use; they make a frame by table half as long
//! again (`cargo xtask bench raster`). Writes go to slices of the very length, where their addresses are aligned.
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "the instructions take addresses; they are limited here")
)]

#[cfg(target_arch = "x86_64")]
use fearless_simd::Level;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u8x64, u32x16};

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

/// Bytes that [`stream`] writes at once, and what their address should be a multiple of.
pub(crate) const STREAM: usize = 64;

/// Writes bytes that nobody reads soon, past the caches where there is such an instruction and the address allows it.
///
/// Lines that are written whole are not fetched first, which is a third of the traffic of a large map. [`stream_end`] is to be
/// called when all is written.
#[inline(always)]
pub(crate) fn stream<S: Simd>(simd: S, bytes: u8x64<S>, out: &mut [u8; STREAM]) {
    if !out.as_ptr().addr().is_multiple_of(STREAM) {
        return bytes.store_array(out);
    }
    match simd.level() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn write(token: Avx512, bytes: core::arch::x86_64::__m512i, out: &mut [u8; STREAM]) {
                    let _ = token;
                    // SAFETY: the 64 bytes lie within the array, whose address is a multiple of 64 (see above).
                    unsafe { core::arch::x86_64::_mm512_stream_si512(out.as_mut_ptr().cast(), bytes) }
                }
            );
            write(token, bytes.into(), out);
        }
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(token) => {
            fearless_simd::kernel!(
                #[inline(always)]
                fn write(token: Avx2, bytes: [core::arch::x86_64::__m256i; 2], out: &mut [u8; STREAM]) {
                    let _ = token;
                    let (low, high) = out.split_at_mut(32);
                    // SAFETY: both halves are 32 bytes long and begin at multiples of 32 (see above).
                    unsafe {
                        core::arch::x86_64::_mm256_stream_si256(low.as_mut_ptr().cast(), bytes[0]);
                        core::arch::x86_64::_mm256_stream_si256(high.as_mut_ptr().cast(), bytes[1]);
                    }
                }
            );
            let (low, high) = bytes.split();
            write(token, [low.into(), high.into()], out);
        }
        _ => bytes.store_array(out),
    }
}

/// Orders what was streamed before whatever comes after: writes past the caches may be seen late by other threads otherwise.
#[inline(always)]
pub(crate) fn stream_end() {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every processor of this architecture has the instruction, and it has no operands.
    unsafe {
        core::arch::x86_64::_mm_sfence();
    }
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
                for lane in 0..16 {
                    let at = |i: u32| table[(i as usize).min(len - 1)];
                    assert_eq!(found[lane], at(wanted[lane]), "{level:?} {len}");
                    let half = at(wanted[lane] / 2) >> (wanted[lane] % 2 * 16) & 0xffff;
                    assert_eq!(halves[lane], half, "{level:?} {len}");
                }
            }
        }
    }

    #[test]
    fn streams_write_their_bytes_wherever_they_begin() {
        for level in super::super::levels() {
            let bytes: [u8; STREAM] = std::array::from_fn(|i| i as u8 * 3 + 1);
            for start in 0..STREAM {
                let mut room = [0u8; 3 * STREAM];
                let place = room[start..].first_chunk_mut().unwrap();
                dispatch!(level, simd => stream(simd, bytes.simd_into(simd), place));
                stream_end();
                assert_eq!(room[start..start + STREAM], bytes, "{level:?} {start}");
                assert_eq!(room.iter().filter(|&&b| b != 0).count(), STREAM, "{level:?} {start}");
            }
        }
    }
}
