//! Inputs that need no file: reliefs from noise.

use anyhow::Result;
use rilievo::light::{Light, Lighting};
use rilievo::{Grid, LinearRgb, Normal, Space};
use std::f64::consts::{PI, TAU};

/// Octaves of [`fractal`].
const OCTAVES: u32 = 6;

/// A rough relief of 0 … 1 that repeats without a seam, `side` × `side` texels.
pub(crate) fn rough(side: u32) -> Result<Grid<f32>> {
    let at = |i: u32| f64::from(i) / f64::from(side) * 8.0;
    Ok(Grid::from_fn(side, side, |x, y| fractal([at(x), at(y), 0.0], 8) as f32)?)
}

/// A world of flat seas and rough land, 2 · `rows` × `rows` texels, heights 0 … 1: longitude across, north on top.
///
/// The noise is that of the sphere's own points, so there is no seam; the land sinks towards the poles, so the map may
/// be wrapped there too.
pub(crate) fn world(rows: u32) -> Result<Grid<f32>> {
    Ok(Grid::from_fn(2 * rows, rows, |x, y| {
        let (sin_lon, cos_lon) = ((f64::from(x) + 0.5) / f64::from(2 * rows) * TAU).sin_cos();
        let (sin_polar, cos_polar) = ((f64::from(y) + 0.5) / f64::from(rows) * PI).sin_cos();
        // Moved away from the lattice's origin, and no period within reach.
        let p = [sin_polar * sin_lon, cos_polar, sin_polar * cos_lon].map(|v| 2.0 * v + 16.0);
        let land = ((fractal(p, 32) - 0.5) * 4.0).clamp(0.0, 1.0);
        (land * sin_polar * sin_polar) as f32
    })?)
}

/// Octaves of value noise, each of half the amplitude and twice the frequency; 0 … 1, repeating after `period`.
fn fractal(p: [f64; 3], period: u32) -> f64 {
    let octave = |i: u32| value_noise(p.map(|v| v * f64::from(1 << i)), period << i, i) * 0.5f64.powi(i as i32);
    (0..OCTAVES).map(octave).sum::<f64>() / (2.0 - 0.5f64.powi(OCTAVES as i32 - 1))
}

/// Random values at whole coordinates, blended smoothly between them. Coordinates must not be negative.
fn value_noise(p: [f64; 3], period: u32, seed: u32) -> f64 {
    let cell = p.map(|v| v as u32);
    let blend = [0, 1, 2].map(|i| {
        let t = p[i] - f64::from(cell[i]);
        t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
    });
    let mut sum = 0.0;
    for corner in 0..8 {
        let offset = [corner & 1, corner >> 1 & 1, corner >> 2];
        let at = [0, 1, 2].map(|i| (cell[i] + offset[i]) % period);
        let weight: f64 = (0..3).map(|i| if offset[i] == 1 { blend[i] } else { 1.0 - blend[i] }).product();
        sum += weight * lattice(at, seed);
    }
    sum
}

/// A random value of 0 … 1 for a point of the lattice.
fn lattice([x, y, z]: [u32; 3], seed: u32) -> f64 {
    let point = [y, z, seed].iter().fold(u64::from(x), |key, &v| key << 16 | u64::from(v));
    testkit::Random::new(point).unit()
}

/// A key light from the upper left and a weak one from the right, as seen by an eye on +Z.
pub(crate) fn lighting<S: Space>() -> Lighting<S> {
    let light = |toward: [f32; 3], color| Light::directional(Normal::new_or(toward.into(), Normal::Z), color);
    let (key, fill) = (LinearRgb::new(1.2, 1.15, 1.05), LinearRgb::new(0.15, 0.18, 0.24));
    Lighting::new(LinearRgb::gray(0.08), vec![light([-0.6, 0.5, 0.6], key), light([0.9, 0.1, 0.2], fill)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reliefs_are_rough_and_in_range() {
        for relief in [rough(64).unwrap(), world(64).unwrap()] {
            assert!(relief.texels().iter().all(|h| (0.0..=1.0).contains(h)));
            let mean = relief.texels().iter().sum::<f32>() / relief.texels().len() as f32;
            let spread = relief.texels().iter().map(|h| (h - mean).powi(2)).sum::<f32>() / relief.texels().len() as f32;
            assert!(spread.sqrt() > 0.05, "{mean} ± {}", spread.sqrt());
        }
    }

    #[test]
    fn rough_relief_has_no_seam() {
        let relief = rough(64).unwrap();
        let step = |a: u32, b: u32| (0..64).map(|i| (relief[(a, i)] - relief[(b, i)]).abs()).sum::<f32>();
        let inside = (0..63).map(|x| step(x, x + 1)).fold(0.0, f32::max);
        assert!(step(63, 0) <= inside, "{} against {inside}", step(63, 0));
    }

    #[test]
    fn world_has_seas_and_land_and_low_poles() {
        let world = world(64).unwrap();
        let seas = world.texels().iter().filter(|&&h| h == 0.0).count();
        assert!((1000..7000).contains(&seas), "{seas} of 8192");
        assert!(world.row(0).iter().chain(world.row(63)).all(|&h| h < 0.01));
    }
}
