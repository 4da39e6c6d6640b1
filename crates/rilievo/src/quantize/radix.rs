//! Sorting keys by their upper bits.

/// Bits of a digit at most: its counters stay in the first cache.
const DIGIT_BITS: u32 = 12;
/// Keys that are looked at together; see [`crate::par`].
const PIECE: usize = 1 << 16;

/// Some bits of a key.
#[derive(Clone, Copy)]
struct Digit {
    shift: u32,
    mask: u64,
}

impl Digit {
    fn of(self, key: u64) -> usize {
        (key >> self.shift & self.mask) as usize
    }

    #[inline(never)]
    fn count(self, keys: &[u64], counts: &mut [u32]) {
        keys.iter().for_each(|&key| counts[self.of(key)] += 1);
    }

    /// Puts keys where the next of their digit goes.
    #[inline(never)]
    fn sort(self, keys: &[u64], places: &mut [u32], sorted: &mut [u64]) {
        for &key in keys {
            let place = &mut places[self.of(key)];
            sorted[*place as usize] = key;
            *place += 1;
        }
    }
}

/// Sorts keys by the bits from `low` on; keys with equal ones stay in their order. By digits, the lowest first: a few
/// passes over the keys, where comparing takes one for each doubling of their number.
pub(super) fn sort_by_upper_bits(keys: &mut Vec<u64>, low: u32, bits: u32) {
    let digits = bits.div_ceil(DIGIT_BITS);
    let mut sorted = vec![0; keys.len()];
    for digit in 0..digits {
        let (from, to) = (bits * digit / digits, bits * (digit + 1) / digits);
        let digit = Digit { shift: low + from, mask: (1 << (to - from)) - 1 };
        let mut counts = vec![0; 1 << (to - from)];
        keys.chunks(PIECE).for_each(|keys| digit.count(keys, &mut counts));
        if counts.iter().any(|&count: &u32| count as usize == keys.len()) {
            continue;
        }
        let mut start = 0;
        for count in &mut counts {
            start += std::mem::replace(count, start);
        }
        keys.chunks(PIECE).for_each(|keys| digit.sort(keys, &mut counts, &mut sorted));
        std::mem::swap(keys, &mut sorted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorts_by_the_upper_bits_and_keeps_the_order_of_equals() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            state >> 30
        };
        for (count, spread) in [(0, 34), (1, 34), (5000, 34), (5000, 5), (5000, 0), (70_000, 20)] {
            let keys: Vec<u64> = (0..count).map(|item| (random() & ((1 << spread) - 1)) << 30 | item).collect();
            let (mut sorted, mut expected) = (keys.clone(), keys);
            sort_by_upper_bits(&mut sorted, 30, 34);
            expected.sort_by_key(|key| key >> 30);
            assert_eq!(sorted, expected, "{count} keys of {spread} bits");
        }
    }
}
