//! Reproducible random numbers.

use glam::DVec3;
use rilievo::{Normal, Space};

/// SplitMix64 (Steele, Lea, Flood 2014): small, seedable, the same everywhere.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// A generator that always gives the same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `low..high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + self.unit() * (high - low)
    }
}

/// `count` directions spread uniformly at random over the sphere (Archimedes: z and azimuth are uniform).
pub fn uniform_sphere<S: Space>(count: usize, seed: u64) -> Vec<Normal<S>> {
    let mut random = Random::new(seed);
    let mut direction = || {
        let z = random.range(-1.0, 1.0);
        let (sin, cos) = random.range(0.0, std::f64::consts::TAU).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Normal::new(DVec3::new(r * cos, r * sin, z).as_vec3()).expect("a point of the sphere has a direction")
    };
    (0..count).map(|_| direction()).collect()
}
