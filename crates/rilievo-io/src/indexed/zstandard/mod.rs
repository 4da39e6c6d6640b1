//! Zstandard (RFC 8878): by its authors' own library, and in browsers, where no C is compiled, in Rust.

#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(any(target_arch = "wasm32", test))]
mod portable;

#[cfg(not(target_arch = "wasm32"))]
pub(super) use native::{compress_frame, decompress};
#[cfg(target_arch = "wasm32")]
pub(super) use portable::{compress_frame, decompress};

#[cfg(test)]
mod tests {
    use super::{native, portable};

    /// Indices of a map: runs, repetitions, noise.
    fn samples() -> Vec<Vec<u8>> {
        let mut random = testkit::Random::new(4);
        let mut noise = |n: usize| (0..n).map(|_| (random.unit() * 256.0) as u8).collect::<Vec<_>>();
        let waves = |n: usize| (0..n).map(|i| ((i as f32 * 0.01).sin() * 90.0 + 100.0) as u8).collect::<Vec<_>>();
        vec![vec![], vec![7], vec![3; 100_000], noise(5000), waves(300_000), [waves(70_000), noise(900)].concat()]
    }

    #[test]
    fn each_reads_what_the_other_writes() {
        for raw in samples() {
            for packed in [native::compress_frame(&raw).unwrap(), portable::compress_frame(&raw).unwrap()] {
                assert_eq!(native::decompress(&packed, raw.len()).unwrap(), raw);
                assert_eq!(portable::decompress(&packed, raw.len()).unwrap(), raw);
                // Two frames are one stream.
                let twice = [packed.clone(), packed].concat();
                assert_eq!(portable::decompress(&twice, raw.len() * 2).unwrap(), [raw.clone(), raw.clone()].concat());
            }
        }
    }

    #[test]
    fn damage_and_too_much_are_no_end() {
        let raw = &samples()[4];
        let packed = native::compress_frame(raw).unwrap();
        for len in (0..packed.len()).step_by(packed.len() / 40) {
            assert!(portable::decompress(&packed[..len], raw.len()).is_ok_and(|d| d.is_empty()) || len > 0);
            let mut broken = packed.clone();
            broken[len] ^= 0x55;
            // It may be other data, and it may be none: never more than asked for.
            assert!(portable::decompress(&broken, raw.len()).map_or(0, |d| d.len()) <= raw.len() + 1);
        }
        for expected in [0, 1, raw.len() - 1] {
            assert!(portable::decompress(&packed, expected).map_or(true, |d| d.len() != expected));
            assert!(native::decompress(&packed, expected).map_or(true, |d| d.len() != expected));
        }
    }
}
