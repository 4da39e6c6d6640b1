//! Statistics of more angles than one likes to keep.

use super::angle::{AngleStats, key};
use crate::order::greater;

/// Statistics of angles that are seen once each, in order, and not kept: only the largest hundredth is.
#[derive(Debug)]
pub(crate) struct AngleSums {
    sum: f64,
    sum_of_squares: f64,
    max: f64,
    count: u64,
    /// How many of the largest decide the percentile of as many angles as there may be.
    keep: usize,
    /// The [`key`]s of the largest ones, and fewer than as many others.
    largest: Vec<u32>,
    /// Angles below this are not among the largest.
    floor: u32,
}

impl AngleSums {
    /// For at most `most` angles.
    pub(crate) fn new(most: u64) -> Self {
        let keep = (most / 100) as usize + 1;
        Self { sum: 0.0, sum_of_squares: 0.0, max: 0.0, count: 0, keep, largest: Vec::new(), floor: 0 }
    }

    pub(crate) fn add(&mut self, angle: f64) {
        self.sum += angle;
        self.sum_of_squares += angle * angle;
        self.max = greater(angle, self.max);
        self.count += 1;
        let key = key(angle) as u32;
        if key >= self.floor {
            self.largest.push(key);
            if self.largest.len() >= 2 * self.keep {
                let (_, &mut floor, _) = self.largest.select_nth_unstable_by(self.keep - 1, |a, b| b.cmp(a));
                self.floor = floor;
                self.largest.truncate(self.keep);
            }
        }
    }

    /// `None` if there was no angle.
    pub(crate) fn finish(mut self) -> Option<AngleStats> {
        if self.count == 0 {
            return None;
        }
        // The nearest rank, counted from the largest one.
        let rank = (self.count - (self.count * 99).div_ceil(100)) as usize;
        let (_, &mut p99, _) = self.largest.select_nth_unstable_by(rank, |a, b| b.cmp(a));
        let count = self.count as f64;
        Some(AngleStats {
            mean_rad: self.sum / count,
            rms_rad: (self.sum_of_squares / count).sqrt(),
            p99_rad: f32::from_bits(p99).into(),
            max_rad: self.max,
            count: self.count,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::weighted_angle_stats;
    use super::*;

    #[test]
    fn sums_are_those_of_angles_that_are_kept() {
        for (count, most) in [(1u32, 1u64), (99, 99), (100, 100), (101, 5000), (20_000, 20_000), (20_000, 123_456)] {
            for kind in 0..3u32 {
                let angle = |i: u32| match kind {
                    0 => f64::from(i.wrapping_mul(2_654_435_761) >> 8) * 1e-7,
                    1 => f64::from(count - i) * 1e-4,
                    _ => f64::from(i / 150) * 1e-3,
                };
                let angles: Vec<(f64, u64)> = (0..count).map(|i| (angle(i), 1)).collect();
                let mut sums = AngleSums::new(most);
                angles.iter().for_each(|a| sums.add(a.0));
                assert_eq!(sums.finish(), Some(weighted_angle_stats(&angles)), "{count} {most} {kind}");
            }
        }
        assert_eq!(AngleSums::new(7).finish(), None);
    }
}
