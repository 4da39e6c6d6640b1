//! Angles between normal maps.

use std::f64::consts::PI;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::normal::{NormalMap, Space};
use crate::order::greater;
use crate::par;

/// Statistics of the angles between two normal maps, in radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AngleStats {
    /// Mean.
    pub mean_rad: f64,
    /// Root mean square.
    pub rms_rad: f64,
    /// 99th percentile by nearest rank: the smallest angle that at least 99 % of the texels do not exceed.
    ///
    /// Exact but for a rounding to f32 (relative 6 · 10⁻⁸).
    pub p99_rad: f64,
    /// Largest.
    pub max_rad: f64,
    /// Texels compared.
    pub count: u64,
}

/// Compares texel by texel; only where `covered` says so, if given.
///
/// - **Units:** radians.
/// - **Determinism:** sums in f64 over at most 16 bands of whole rows that depend on the size alone, added in order: the
///   same bits for any thread count. (The arc sine of the platform may differ in its last bit.)
/// - **Memory:** at most 9 MB, whatever the size of the maps.
///
/// # Errors
/// [`Error::SizeMismatch`] if the maps (or `covered`) differ in size, [`Error::Missing`] if nothing is covered: no
/// texels would otherwise look like no error.
///
/// ```
/// use rilievo::measure::angle_stats;
/// use rilievo::{Grid, Normal, Tangent};
///
/// let up = Grid::filled(4, 4, Normal::<Tangent>::Z)?;
/// let mut other = up.clone();
/// other[(0, 0)] = Normal::X;
/// let stats = angle_stats(&up, &other, None)?;
/// assert_eq!(stats.count, 16);
/// assert!((stats.max_rad.to_degrees() - 90.0).abs() < 1e-9);
/// assert!((stats.mean_rad.to_degrees() - 90.0 / 16.0).abs() < 1e-9);
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn angle_stats<S: Space>(
    reference: &NormalMap<S>,
    other: &NormalMap<S>,
    covered: Option<&Grid<bool>>,
) -> Result<AngleStats> {
    reference.expect_same_size("the other normal map", other)?;
    if let Some(covered) = covered {
        reference.expect_same_size("the coverage", covered)?;
    }
    let compared = Compared { reference, other, covered };
    let bands = band_count(reference.texels().len());
    // First pass: the sums, and which 1/32768 of the scale of angles the percentile lies in …
    let coarse = par::map_range(bands, |band| compared.summarise(band, bands)).into_iter().reduce(Summary::merge);
    let coarse = coarse.expect("invariant: a grid is never empty");
    if coarse.count == 0 {
        return Err(Error::Missing { what: "covered texels", remedy: "give a coverage with at least one set texel" });
    }
    // … second pass: where in it. Two small histograms instead of sorting all angles.
    let mut rank = (coarse.count * 99).div_ceil(100);
    let high = select(&coarse.histogram, &mut rank);
    let fine = par::map_range(bands, |band| compared.low_histogram(band, bands, high)).into_iter().reduce(add_counts);
    let low = select(&fine.expect("invariant: a grid is never empty"), &mut rank);
    Ok(coarse.finish(high, low))
}

/// The angle of two unit vectors at the distance √`chord2`.
pub(crate) fn angle_of_chord(chord2: f64) -> f64 {
    let chord = chord2.sqrt();
    if chord2 < 0.01 {
        // 2 asin(c/2) as its series; what is left out is below 10⁻¹³ of it.
        let series = 1.0
            + chord2 * (1.0 / 24.0 + chord2 * (3.0 / 640.0 + chord2 * (5.0 / 7168.0 + chord2 * (35.0 / 294_912.0))));
        return chord * series;
    }
    2.0 * (chord * 0.5).min(1.0).asin()
}

/// Statistics of angles that occur several times each: (angle, how often). At least one must occur.
pub(crate) fn weighted_angle_stats(angles: &[(f64, u64)]) -> AngleStats {
    let mut s = Summary { sum: 0.0, sum_of_squares: 0.0, max: 0.0, count: 0, histogram: vec![0; (key(PI) >> 16) + 1] };
    for &(angle, times) in angles {
        s.sum += angle * times as f64;
        s.sum_of_squares += angle * angle * times as f64;
        s.max = greater(angle, s.max);
        s.count += times;
        s.histogram[key(angle) >> 16] += times;
    }
    let mut rank = (s.count * 99).div_ceil(100);
    let high = select(&s.histogram, &mut rank);
    let mut fine = vec![0; 1 << 16];
    for &(angle, times) in angles.iter().filter(|(angle, _)| key(*angle) >> 16 == high) {
        fine[key(angle) & 0xffff] += times;
    }
    let low = select(&fine, &mut rank);
    s.finish(high, low)
}

/// How many bands of rows the work is cut into: a function of the size only.
fn band_count(texels: usize) -> usize {
    texels.div_ceil(1 << 16).min(16)
}

/// The order of an angle among all angles: non-negative floats are ordered like their bits.
pub(super) fn key(angle: f64) -> usize {
    (angle as f32).to_bits() as usize
}

struct Compared<'a, S> {
    reference: &'a NormalMap<S>,
    other: &'a NormalMap<S>,
    covered: Option<&'a Grid<bool>>,
}

/// Sums over a band, and how often each value of the upper 16 bits of [`key`] occurs.
struct Summary {
    sum: f64,
    sum_of_squares: f64,
    max: f64,
    count: u64,
    histogram: Vec<u64>,
}

impl Summary {
    /// With the percentile's [`key`] by its upper and its lower half.
    fn finish(&self, high: usize, low: usize) -> AngleStats {
        let count = self.count as f64;
        AngleStats {
            mean_rad: self.sum / count,
            rms_rad: (self.sum_of_squares / count).sqrt(),
            p99_rad: f32::from_bits((high << 16 | low) as u32).into(),
            max_rad: self.max,
            count: self.count,
        }
    }

    fn merge(self, later: Self) -> Self {
        Self {
            sum: self.sum + later.sum,
            sum_of_squares: self.sum_of_squares + later.sum_of_squares,
            max: self.max.max(later.max),
            count: self.count + later.count,
            histogram: add_counts(self.histogram, later.histogram),
        }
    }
}

impl<S: Space> Compared<'_, S> {
    fn for_each_angle(&self, band: usize, bands: usize, mut visit: impl FnMut(f64)) {
        let (width, height) = (self.reference.width() as usize, self.reference.height() as usize);
        let texels = band * height / bands * width..(band + 1) * height / bands * width;
        let pairs = self.reference.texels()[texels.clone()].iter().zip(&self.other.texels()[texels.clone()]);
        match self.covered {
            None => pairs.for_each(|(a, b)| visit(a.angle_to(*b))),
            Some(covered) => pairs
                .zip(&covered.texels()[texels])
                .filter(|(_, covered)| **covered)
                .for_each(|((a, b), _)| visit(a.angle_to(*b))),
        }
    }

    fn summarise(&self, band: usize, bands: usize) -> Summary {
        let histogram = vec![0; (key(PI) >> 16) + 1];
        let mut s = Summary { sum: 0.0, sum_of_squares: 0.0, max: 0.0, count: 0, histogram };
        self.for_each_angle(band, bands, |angle| {
            s.sum += angle;
            s.sum_of_squares += angle * angle;
            s.max = greater(angle, s.max);
            s.count += 1;
            s.histogram[key(angle) >> 16] += 1;
        });
        s
    }

    /// How often each value of the lower 16 bits of [`key`] occurs where the upper ones are `high`.
    fn low_histogram(&self, band: usize, bands: usize, high: usize) -> Vec<u64> {
        let mut histogram = vec![0; 1 << 16];
        self.for_each_angle(band, bands, |angle| {
            let key = key(angle);
            if key >> 16 == high {
                histogram[key & 0xffff] += 1;
            }
        });
        histogram
    }
}

fn add_counts(mut a: Vec<u64>, b: Vec<u64>) -> Vec<u64> {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b;
    }
    a
}

/// The bin that holds the `rank`-th value (from 1); leaves in `rank` its rank inside that bin.
fn select(histogram: &[u64], rank: &mut u64) -> usize {
    for (bin, &count) in histogram.iter().enumerate() {
        if *rank <= count {
            return bin;
        }
        *rank -= count;
    }
    unreachable!("invariant: the rank is at most the sum of the counts")
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::normal::{Normal, Object};

    /// Z, and Z tilted by each of the angles.
    fn tilted(width: u32, height: u32, angle: impl Fn(u32) -> f64) -> [NormalMap<Object>; 2] {
        let tilted = Grid::from_fn(width, height, |x, y| {
            let a = angle(y * width + x);
            Normal::new(Vec3::new(a.sin() as f32, 0.0, a.cos() as f32)).unwrap()
        });
        [Grid::filled(width, height, Normal::Z).unwrap(), tilted.unwrap()]
    }

    #[test]
    fn series_and_arc_sine_agree() {
        for i in 0..2000 {
            let chord = f64::from(i) * 1e-3;
            let expected = 2.0 * (chord * 0.5).asin();
            assert!((angle_of_chord(chord * chord) - expected).abs() <= 1e-13 * expected, "{chord}");
        }
    }

    #[test]
    fn weights_count_like_repetitions() {
        let [a, b] = tilted(40, 25, |i| f64::from(i * 77 % 23) * 0.01);
        let direct = angle_stats(&a, &b, None).unwrap();
        let angles: Vec<(f64, u64)> = (0..1000).map(|i| (a.texels()[i].angle_to(b.texels()[i]), 3)).collect();
        let found = weighted_angle_stats(&angles);
        assert_eq!(found.count, 3000);
        assert_eq!((found.p99_rad, found.max_rad), (direct.p99_rad, direct.max_rad));
        assert!((found.rms_rad - direct.rms_rad).abs() < 1e-12 && (found.mean_rad - direct.mean_rad).abs() < 1e-12);
    }

    #[test]
    fn known_angles_give_known_statistics() {
        // 0.01°, 0.02° … 2.00°, shuffled.
        let [a, b] = tilted(20, 10, |i| (f64::from((i * 77) % 200 + 1) * 0.01).to_radians());
        let s = angle_stats(&a, &b, None).unwrap();
        let close = |found: f64, degrees: f64| assert!((found.to_degrees() - degrees).abs() < 1e-5, "{s:?}");
        close(s.mean_rad, 1.005);
        close(s.max_rad, 2.0);
        close(s.p99_rad, 1.98);
        close(s.rms_rad, ((201.0 * 401.0) / 6.0f64).sqrt() * 0.01);
        assert_eq!(s.count, 200);
    }

    #[test]
    fn percentile_is_that_of_the_sorted_angles() {
        // More than one band, and a last band of another size.
        let [a, b] = tilted(401, 503, |i| f64::from(i.wrapping_mul(2_654_435_769) >> 8) / f64::from(1 << 24) * PI);
        let mut angles: Vec<f64> = a.texels().iter().zip(b.texels()).map(|(a, b)| a.angle_to(*b)).collect();
        angles.sort_by(f64::total_cmp);
        let rank = (angles.len() * 99).div_ceil(100);
        let s = angle_stats(&a, &b, None).unwrap();
        assert_eq!(s.p99_rad, f64::from(angles[rank - 1] as f32));
        assert_eq!(s.max_rad, angles[angles.len() - 1]);
        assert!((s.mean_rad - angles.iter().sum::<f64>() / angles.len() as f64).abs() < 1e-12);
    }

    #[test]
    fn equal_and_opposite_maps() {
        let [a, _] = tilted(1, 1, |_| 0.0);
        assert_eq!(angle_stats(&a, &a, None).unwrap(), AngleStats { count: 1, ..AngleStats::default() });
        let s = angle_stats(&a, &a.map(|n| Normal::new(-n.vec()).unwrap()), None).unwrap();
        assert_eq!((s.mean_rad, s.rms_rad, s.max_rad, s.p99_rad as f32), (PI, PI, PI, PI as f32));
    }

    #[test]
    fn only_covered_texels_count() {
        let [a, b] = tilted(5, 3, f64::from);
        let covered = Grid::from_fn(5, 3, |x, y| (x, y) == (1, 0)).unwrap();
        let s = angle_stats(&a, &b, Some(&covered)).unwrap();
        assert_eq!(s.count, 1);
        assert!((s.mean_rad - 1.0).abs() < 1e-6 && s.max_rad == s.mean_rad);
        assert!(matches!(angle_stats(&a, &b, Some(&covered.map(|_| false))), Err(Error::Missing { .. })));
        let wrong = Grid::filled(5, 4, true).unwrap();
        assert!(matches!(angle_stats(&a, &b, Some(&wrong)), Err(Error::SizeMismatch { .. })));
    }

    #[cfg(feature = "rayon")]
    #[test]
    fn thread_count_does_not_change_a_bit() {
        let [a, b] = tilted(700, 300, |i| f64::from(i % 977) * 1e-4);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| angle_stats(&a, &b, None).unwrap())
        };
        assert_eq!(with(1), with(5));
    }
}
