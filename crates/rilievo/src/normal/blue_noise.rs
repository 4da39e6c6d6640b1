//! A threshold mask without low frequencies, made by the void-and-cluster method.
//!
//! Source: Ulichney 1993, "The void-and-cluster method for dither array generation", Proc. SPIE 1913. Made when first
//! asked for (some hundredths of a second) instead of stored: the method is shorter than its result.

use std::sync::OnceLock;

/// Side of the mask in texels; a power of two.
const SIDE: usize = 64;
const AREA: usize = SIDE * SIDE;
/// `exp(−1 / 2σ²)` for Ulichney's σ = 1.5: the energy one texel away. A literal, because `exp` is not the same bits on
/// every platform and files depend on the mask.
const FALLOFF: f64 = 0.800_737_402_916_808_1;
/// Where the energy of a point ends; beyond, it is below 10⁻⁷ of its own.
const REACH: i64 = 9;

/// Ranks 0 … AREA − 1 over a torus: any prefix of them is spread as evenly as can be.
pub(crate) struct BlueNoise(Vec<u16>);

impl BlueNoise {
    /// The mask, always the same.
    pub(crate) fn get() -> &'static Self {
        static MASK: OnceLock<BlueNoise> = OnceLock::new();
        MASK.get_or_init(|| Self(ranks()))
    }

    /// The threshold at (x, y), in the open interval 0 … 1. Repeats every 64 texels.
    pub(crate) fn threshold(&self, x: usize, y: usize) -> f32 {
        (f32::from(self.0[y % SIDE * SIDE + x % SIDE]) + 0.5) / AREA as f32
    }
}

/// Points on a torus and the energy they spread: high in clusters, low in voids.
#[derive(Clone)]
struct Pattern {
    is_set: Vec<bool>,
    energy: Vec<i64>,
    /// Energy of a point at each offset within [`REACH`], in 2⁻³² of its own. Integers, so that a point that is taken
    /// away leaves nothing behind.
    kernel: Vec<(i64, i64, i64)>,
}

impl Pattern {
    fn empty() -> Self {
        // Powers by multiplication: `powf` is not the same bits on every platform either.
        let powers: Vec<f64> =
            std::iter::successors(Some(1.0), |p| Some(p * FALLOFF)).take((2 * REACH * REACH) as usize + 1).collect();
        let offsets = (-REACH..=REACH).flat_map(|dy| (-REACH..=REACH).map(move |dx| (dx, dy)));
        let energy = |(dx, dy): (i64, i64)| (powers[(dx * dx + dy * dy) as usize] * 4_294_967_296.0) as i64;
        let kernel = offsets.map(|(dx, dy)| (dx, dy, energy((dx, dy)))).collect();
        Self { is_set: vec![false; AREA], energy: vec![0; AREA], kernel }
    }

    /// Sets or takes away a point.
    fn toggle(&mut self, i: usize) {
        self.is_set[i] = !self.is_set[i];
        let sign = if self.is_set[i] { 1 } else { -1 };
        let (x, y) = ((i % SIDE) as i64, (i / SIDE) as i64);
        let wrapped = |c: i64| c.rem_euclid(SIDE as i64) as usize;
        for &(dx, dy, energy) in &self.kernel {
            self.energy[wrapped(y + dy) * SIDE + wrapped(x + dx)] += sign * energy;
        }
    }

    /// The point with the most energy; the first of equals.
    fn tightest_cluster(&self) -> usize {
        let points = (0..AREA).filter(|&i| self.is_set[i]);
        points.min_by_key(|&i| -self.energy[i]).expect("invariant: only asked of patterns with points")
    }

    /// The place without a point that has the least energy; the first of equals.
    fn largest_void(&self) -> usize {
        let voids = (0..AREA).filter(|&i| !self.is_set[i]);
        voids.min_by_key(|&i| self.energy[i]).expect("invariant: only asked of patterns with voids")
    }
}

fn ranks() -> Vec<u16> {
    // A tenth of the places, at random (a linear congruential generator), then clusters fill voids until none would.
    let mut start = Pattern::empty();
    let (mut state, mut points) = (1u32, 0);
    while points < AREA / 10 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let place = (state >> 20) as usize;
        if !start.is_set[place] {
            start.toggle(place);
            points += 1;
        }
    }
    loop {
        let cluster = start.tightest_cluster();
        start.toggle(cluster);
        let void = start.largest_void();
        start.toggle(void);
        if void == cluster {
            break;
        }
    }

    let mut ranks = vec![0; AREA];
    // Downwards from the start: the point that is missed least goes first.
    let mut below = start.clone();
    for rank in (0..points).rev() {
        let cluster = below.tightest_cluster();
        below.toggle(cluster);
        ranks[cluster] = rank as u16;
    }
    // Upwards: the largest void is filled next. (Past one half Ulichney looks for clusters of voids instead: with the
    // energy of a point the same everywhere, that is the same place.)
    for rank in points..AREA {
        let void = start.largest_void();
        start.toggle(void);
        ranks[void] = rank as u16;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rank_occurs_once() {
        let mut ranks = BlueNoise::get().0.clone();
        ranks.sort_unstable();
        assert!(ranks.iter().copied().eq(0..AREA as u16));
        assert_eq!(BlueNoise::get().threshold(3, 5), BlueNoise::get().threshold(3 + 64, 5 + 128));
    }

    #[test]
    fn averages_over_blocks_are_closer_to_one_half_than_those_of_white_noise() {
        let mask = BlueNoise::get();
        let mut square = 0.0;
        for y in (0..SIDE).step_by(8) {
            for x in (0..SIDE).step_by(8) {
                let sum: f32 = (0..64).map(|i| mask.threshold(x + i % 8, y + i / 8)).sum();
                square += f64::from(sum / 64.0 - 0.5).powi(2);
            }
        }
        let deviation = (square / 64.0).sqrt();
        // White noise: √(1/12) / √64 = 0.036. Measured: 0.010; what is left is the noise at the blocks' edges.
        assert!(deviation < 0.036 / 3.0, "{deviation}");
    }
}
