//! The smallest table that is good enough.

use super::{Options, Quantized, Texels, quantize};
use crate::progress::Silent;
use crate::{Progress, Result, Space};

/// Quantises `map` to the smallest table whose RMS error is at most `max_rms_rad` radians; `None` if the largest table
/// misses it.
///
/// `options.entries` is the largest size that is tried. A table of every size between failing and passing ones is made on the way, about
/// fifteen in all. The quantiser is not perfectly even: a smaller table than the one found may pass by luck, but the one
/// with an entry less does not.
///
/// # Errors
/// As [`quantize`].
pub fn quantize_within<'a, S: Space>(
    map: impl Into<Texels<'a, S>>,
    max_rms_rad: f64,
    options: &Options<'_>,
    progress: &dyn Progress,
) -> Result<Option<Quantized<S>>> {
    let map = map.into();
    progress.begin("looking for the smallest table", 16);
    let fewest = fewest_entries(options);
    let rms = |entries: u32| -> Result<f64> {
        let tried = quantize(map, &Options { entries, mip_levels: false, ..*options }, &Silent)?;
        progress.advance(1);
        Ok(tried.error.rms_rad)
    };
    let Some(entries) = smallest(fewest, options.entries.max(fewest), max_rms_rad, rms)? else { return Ok(None) };
    quantize(map, &Options { entries, ..*options }, progress).map(Some)
}

/// One entry for each material in use.
fn fewest_entries(options: &Options<'_>) -> u32 {
    let Some(materials) = options.materials else { return 1 };
    let mut in_use = [false; 256];
    materials.texels().iter().for_each(|&m| in_use[usize::from(m)] = true);
    in_use.iter().filter(|&&used| used).count() as u32
}

/// The smallest count in `low..=high` whose error is at most `target`, for an error that falls as the count grows.
fn smallest(low: u32, high: u32, target: f64, mut error: impl FnMut(u32) -> Result<f64>) -> Result<Option<u32>> {
    // The paper's smallest useful table; error² falls about as one over the count, so each try aims the next.
    const FIRST: u32 = 256;
    let (mut failing, mut passing) = (low - 1, None);
    let mut next = FIRST.clamp(low, high);
    loop {
        let seen = error(next)?;
        if seen <= target {
            passing = Some(next);
        } else {
            failing = next;
        }
        match passing {
            Some(best) if best == failing + 1 => return Ok(Some(best)),
            None if failing == high => return Ok(None),
            _ => {}
        }
        let aimed = (f64::from(next) * (seen / target).powi(2)).clamp(f64::from(low), f64::from(high)) as u32;
        // Never outside the bracket, and at least an eighth into it, so that a bad aim costs little.
        let top = passing.map_or(high, |p| p - 1);
        let margin = passing.map_or(0, |p| (p - failing) / 8);
        next = aimed.clamp(failing + 1 + margin.min(top - failing - 1), top - margin.min(top - failing - 1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Grid, Normal, Object};
    use glam::Vec3;

    #[test]
    fn the_search_finds_every_threshold() {
        for true_count in [1u32, 2, 7, 255, 256, 257, 3000, 65_535, 65_536] {
            let mut tries = 0;
            let error = |k: u32| {
                tries += 1;
                Ok(1.0 / f64::from(k).sqrt())
            };
            let target = 1.0 / f64::from(true_count).sqrt() + 1e-9;
            assert_eq!(smallest(1, 65_536, target, error), Ok(Some(true_count)));
            assert!(tries < 40, "{true_count}: {tries}");
        }
        assert_eq!(smallest(1, 65_536, 1e-9, |_| Ok(1.0)), Ok(None));
        assert_eq!(smallest(3, 65_536, 1.0, |_| Ok(0.0)), Ok(Some(3)));
    }

    #[test]
    fn one_entry_less_is_not_enough() {
        let map = Grid::from_fn(48, 48, |x, y| {
            let v = Vec3::new((x as f32 * 0.13).sin(), (y as f32 * 0.17).cos(), 1.0 + (x as f32 * 0.07).cos());
            Normal::<Object>::new(v).unwrap()
        })
        .unwrap();
        let target = 2.0f64.to_radians();
        let found = quantize_within(&map, target, &Options { entries: 65_536, ..Options::default() }, &Silent)
            .unwrap()
            .unwrap();
        assert!(found.error.rms_rad <= target);
        let entries = found.map.table().len() as u32 - 1;
        let less = quantize(&map, &Options { entries, ..Options::default() }, &Silent).unwrap();
        assert!(less.error.rms_rad > target);
    }
}
