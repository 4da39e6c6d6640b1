//! What the units cost in accuracy: inner products and light against exact arithmetic, over random pixels.

use std::f64::consts::{FRAC_PI_2, TAU};

use rilievo_polar::{Frame, LightTables, Model, Sample, UnitKind, Width};

use super::rotation::{Polar, Rotation, exact};
use crate::error::{Error, Result};
use crate::random::unit;

/// Frames that a unit for distant lights is measured in, in turn.
const FRAMES: u32 = 8;
/// Numbers a pixel is made of.
const NUMBERS: u64 = 8;

/// Statistics of absolute errors, in the unit of what erred.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ErrorStats {
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// 99th percentile by nearest rank.
    pub p99: f64,
    /// Largest.
    pub max: f64,
    /// How many there were.
    pub count: u64,
}

/// Which pixels a unit is measured on: L, H and N uniform over the upper half of the sphere, of which those count where the
/// vector is on the normal's side; N' uniform within a cone around the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelSampling {
    /// How many pixels.
    pub count: u32,
    /// Another seed, other pixels.
    pub seed: u64,
    /// The most that N' leans away from the normal, in radians, 0 to π/2.
    pub steepest_rad: f64,
}

impl Default for PixelSampling {
    /// 200 000 pixels, bump vectors up to the horizon.
    fn default() -> Self {
        Self { count: 200_000, seed: 1, steepest_rad: FRAC_PI_2 }
    }
}

/// What of a unit is measured besides the inner products: its light tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LightSampling<'a> {
    /// Address bits of the light's tables.
    pub width: Width,
    /// Phong exponents, 1 to 65535.
    pub exponents: &'a [u32],
}

/// Errors of a unit against exact arithmetic on the same words.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitErrors {
    /// N'·L' and N'·H', which are numbers in −1 … 1.
    pub products: ErrorStats,
    /// The most they can be off, from the word lengths alone; `None` where the method itself errs.
    pub limit: Option<f64>,
    /// Diffuse light of reflectance 1: `max(0, N'·L')`.
    pub diffuse: ErrorStats,
    /// Specular light of reflectance 1, `max(0, N'·H')ⁿ`, for each exponent n.
    pub specular: Vec<(u32, ErrorStats)>,
}

/// Measures a unit in fixed point.
///
/// Both sides get the same binary angles; words that are numbers are the nearest to what those angles make. Units that hold directions in
/// tables ([`UnitKind::is_distant`]) are measured in eight frames. Kugler's maps have nothing below the horizon: there 0 is
/// expected of it.
///
/// # Errors
/// [`Error::Parameter`] for no pixels, a cone outside 0 … π/2, or an exponent outside 1 … 65535.
pub fn unit_errors(
    kind: UnitKind,
    width: Width,
    light: LightSampling<'_>,
    pixels: &PixelSampling,
) -> Result<UnitErrors> {
    pixels.check()?;
    if let Some(exponent) = light.exponents.iter().find(|n| !(1..=65_535).contains(*n)) {
        return Err(Error::parameter("exponent", exponent, "1 to 65535"));
    }
    let full = LightTables::FULL;
    let tables: Vec<_> = light.exponents.iter().map(|&n| LightTables::new(light.width, full, full, n)).collect();
    let diffuse_alone = LightTables::new(light.width, full, full, 1);
    let frames = if kind.is_distant() { FRAMES } else { 1 };
    let [mut products, mut diffuse] = [const { Vec::new() }; 2];
    let mut specular = vec![Vec::new(); tables.len()];
    // IMEM's light maps end at the horizon.
    let floor = if kind == UnitKind::Kugler { 0.0 } else { -1.0 };
    for number in 0..frames {
        let frame = if kind.is_distant() { pixels.frame(number) } else { Frame::default() };
        let model = Model::new(kind, width, frame);
        for index in (number..pixels.count).step_by(frames as usize) {
            let mut sample = pixels.sample(index.into());
            if kind.is_distant() {
                (sample.light, sample.half) = (frame.light, frame.half);
            }
            let words = sample.words(kind);
            let found = model.products(&words);
            let normal = Polar::from(sample.normal);
            let bump = Polar::from(sample.bump).cartesian();
            let expected = [sample.light, sample.half].map(|v| exact(v.into(), normal));
            let facing = expected.map(|v| v.z > 0.0);
            let expected = expected.map(|v| v.dot(bump).max(floor));
            for k in (0..2).filter(|&k| facing[k]) {
                products.push((f64::from(found[k]) / 16_384.0 - expected[k]).abs());
            }
            let intensity = |word: u32| f64::from(word) / 65_535.0;
            if facing[0] {
                let [word, ..] = model.illuminate(&words, &diffuse_alone);
                diffuse.push((intensity(word) - expected[0].max(0.0)).abs());
            }
            if facing[1] {
                for ((tables, n), errors) in tables.iter().zip(light.exponents).zip(&mut specular) {
                    // All units take their highlights from a table.
                    let [_, word] = tables.look_up(found);
                    errors.push((intensity(word.into()) - expected[1].max(0.0).powi(*n as i32)).abs());
                }
            }
        }
    }
    Ok(UnitErrors {
        products: ErrorStats::of(products),
        limit: kind.limit(width).map(|limit| f64::from(limit) / 16_384.0),
        diffuse: ErrorStats::of(diffuse),
        specular: light.exponents.iter().copied().zip(specular.into_iter().map(ErrorStats::of)).collect(),
    })
}

/// Measures a rotation in f64: the angle, in radians, between the rotated vector and where it should be, over pairs of
/// vector and normal.
///
/// # Errors
/// [`Error::Parameter`] for no pixels.
pub fn rotation_errors(rotation: Rotation, pixels: &PixelSampling) -> Result<ErrorStats> {
    pixels.check()?;
    let angles = (0..u64::from(pixels.count)).filter_map(|index| {
        let [a, n] = [0, 4].map(|first| pixels.upper(index, first));
        (exact(a, n).z > 0.0).then(|| rotation.error_rad(a, n))
    });
    Ok(ErrorStats::of(angles.collect()))
}

impl PixelSampling {
    fn check(&self) -> Result<()> {
        if self.count == 0 {
            return Err(Error::parameter("pixels", self.count, "at least 1"));
        }
        // A tolerance for degrees that were turned into radians.
        if !(0.0..=FRAC_PI_2 + 1e-9).contains(&self.steepest_rad) {
            return Err(Error::parameter("steepest angle", self.steepest_rad, "0 to a right angle"));
        }
        Ok(())
    }

    fn number(&self, index: u64, which: u64) -> f64 {
        unit(self.seed, index * NUMBERS + which)
    }

    /// Uniform over the upper half of the sphere.
    fn upper(&self, index: u64, first: u64) -> Polar {
        Polar { phi: TAU * self.number(index, first), theta: self.number(index, first + 1).acos() }
    }

    fn sample(&self, index: u64) -> Sample {
        let cone = self.steepest_rad.cos();
        let theta = (cone + (1.0 - cone) * self.number(index, 7)).acos();
        let bump = Polar { phi: TAU * self.number(index, 6), theta };
        let [light, half, normal] = [0, 2, 4].map(|first| self.upper(index, first).into());
        Sample { light, half, normal, bump: bump.into() }
    }

    /// Directions of a distant light and viewer.
    fn frame(&self, number: u32) -> Frame {
        let far = |first| self.upper(u64::MAX / NUMBERS - u64::from(number) - 1, first).into();
        Frame { light: far(0), half: far(2) }
    }
}

impl ErrorStats {
    fn of(mut errors: Vec<f64>) -> Self {
        let count = errors.len();
        if count == 0 {
            return Self::default();
        }
        errors.sort_unstable_by(f64::total_cmp);
        let mean = errors.iter().sum::<f64>() / count as f64;
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / count as f64).sqrt();
        let p99 = errors[(count * 99).div_ceil(100) - 1];
        Self { mean, rms, p99, max: errors[count - 1], count: count as u64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEW: PixelSampling = PixelSampling { count: 20_000, seed: 5, steepest_rad: FRAC_PI_2 };

    #[test]
    fn percentiles_are_by_nearest_rank() {
        let stats = ErrorStats::of((1..=100).rev().map(f64::from).collect());
        assert_eq!((stats.mean, stats.p99, stats.max, stats.count), (50.5, 99.0, 100.0, 100));
        assert_eq!(ErrorStats::of(vec![0.25]).p99, 0.25);
        assert_eq!(ErrorStats::of(vec![]), ErrorStats::default());
    }

    #[test]
    fn exact_units_err_by_their_tables_alone() {
        let light = LightSampling { width: Width::new(10).unwrap(), exponents: &[10, 50] };
        let of = |kind, bits| unit_errors(kind, Width::new(bits).unwrap(), light, &FEW).unwrap();
        let [coarse, fine] = [8, 10].map(|bits| of(UnitKind::E3, bits));
        assert!(coarse.products.rms <= 0.0015 && coarse.products.max <= 0.006, "{coarse:?}");
        assert!(fine.products.rms <= 4e-4 && fine.products.max <= 0.002, "{fine:?}");
        // The last place of light is its own table's.
        assert!(fine.diffuse.rms < 0.001 && fine.specular[1].1.max < 0.05, "{fine:?}");
        let published = of(UnitKind::Published, 8);
        assert!((0.17..0.21).contains(&published.products.rms), "{published:?}");
        // No light goes below zero, whatever the products do there.
        assert!((0.1..published.products.rms).contains(&published.diffuse.rms), "{published:?}");
        assert!((0.05..0.15).contains(&published.specular[0].1.rms), "{published:?}");
        assert!(of(UnitKind::E4d, 8).products.rms < 0.003);
    }

    #[test]
    fn nothing_is_measured_of_nothing() {
        let light = LightSampling { width: Width::PAPER, exponents: &[0] };
        assert!(unit_errors(UnitKind::E3, Width::PAPER, light, &FEW).is_err());
        let light = LightSampling { exponents: &[], ..light };
        for pixels in [PixelSampling { count: 0, ..FEW }, PixelSampling { steepest_rad: 2.0, ..FEW }] {
            assert!(unit_errors(UnitKind::E3, Width::PAPER, light, &pixels).is_err());
            assert!(rotation_errors(Rotation::Published, &pixels).is_err());
        }
    }
}
