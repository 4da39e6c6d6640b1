//! Numbers that look random and are the same on every machine.

/// A number that looks random (the output function of SplitMix64: Steele, Lea and Flood 2014).
pub(crate) fn scramble(v: u64) -> u64 {
    let v = v.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let v = (v ^ (v >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let v = (v ^ (v >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    v ^ (v >> 31)
}

/// From 0 up to 1, 53 bits of number `index` of the sequence `seed`.
pub(crate) fn unit(seed: u64, index: u64) -> f64 {
    (scramble(scramble(seed) ^ index) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_fill_their_range_and_sequences_differ() {
        let all = |seed| (0..10_000).map(move |i| unit(seed, i));
        let mean = all(1).sum::<f64>() / 1e4;
        assert!((mean - 0.5).abs() < 0.02 && all(1).all(|x| (0.0..1.0).contains(&x)), "{mean}");
        assert!((0..10).all(|tenth| all(2).filter(|x| (x * 10.0) as u32 == tenth).count() > 800));
        assert!(all(1).zip(all(2)).all(|(a, b)| a != b));
    }
}
