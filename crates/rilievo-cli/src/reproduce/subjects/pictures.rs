//! Taking pictures and comparing them.

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::measure::picture_stats;
use rilievo::raster::{self, Method, Scene, Target, TextureFilter};
use rilievo::{Grid, Rgba8};

/// Pictures are drawn at this multiple of their size: errors are measured there, what is shown is averaged.
const SAMPLES: u32 = 2;

/// A picture as it was drawn, and as it is shown.
pub(crate) struct Shown {
    /// Of the size asked for, smooth along edges; transparent where nothing is.
    pub(crate) picture: Picture,
    /// Twice as wide and high, one sample a pixel.
    pub(crate) full: Picture,
    /// Pixels of `full` that something was drawn on.
    pub(crate) covered: u64,
}

/// Draws a scene by the reference renderer.
///
/// # Errors
/// As [`raster::prepare`], or for an impossible size.
pub(crate) fn shoot(scene: &Scene<'_>, method: Method, (width, height): (u32, u32)) -> Result<Shown> {
    let mut target = Target::new(width.saturating_mul(SAMPLES), height.saturating_mul(SAMPLES))?;
    raster::draw(&raster::prepare(scene, method, TextureFilter::Trilinear)?, &mut target);
    let (picture, full) = (target.resolve(SAMPLES, None)?, target.resolve(1, None)?);
    Ok(Shown { picture, full, covered: target.covered_pixels() })
}

/// PSNR in dB over the pixels that the reference covers: those that show nothing are equal and count for nothing.
///
/// # Errors
/// If the sizes differ.
pub(crate) fn psnr_of_covered(reference: &Shown, other: &Shown) -> Result<f64> {
    let share = reference.covered as f64 / reference.full.texels().len() as f64;
    Ok(picture_stats(&reference.full, &other.full)?.psnr_db + 10.0 * share.log10())
}

/// Where two pictures differ, `gain` times enlarged; black where they are equal.
///
/// # Errors
/// If the sizes differ.
pub(crate) fn difference(a: &Picture, b: &Picture, gain: u8) -> Result<Picture> {
    a.expect_same_size("the other picture", b)?;
    let apart = |a: u8, b: u8| a.abs_diff(b).saturating_mul(gain);
    let pixel = |(a, b): (&Rgba8, &Rgba8)| Rgba8::new(apart(a.r, b.r), apart(a.g, b.g), apart(a.b, b.b), 255);
    Ok(Grid::new(a.width(), a.height(), a.texels().iter().zip(b.texels()).map(pixel).collect())?)
}

/// A part of a picture: `size` pixels from (`x`, `y`) on, as far as there are any.
///
/// # Errors
/// If nothing is left.
pub(crate) fn crop(picture: &Picture, (x, y): (u32, u32), (width, height): (u32, u32)) -> Result<Picture> {
    let (width, height) =
        (width.min(picture.width().saturating_sub(x)), height.min(picture.height().saturating_sub(y)));
    Ok(Grid::from_fn(width, height, |i, j| picture[(x + i, y + j)])?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_enlarged_and_crops_stay_inside() {
        let a = Grid::filled(4, 3, Rgba8::new(10, 20, 30, 255)).unwrap();
        let mut b = a.clone();
        b[(3, 2)] = Rgba8::new(12, 20, 200, 255);
        let apart = difference(&a, &b, 8).unwrap();
        assert_eq!((apart[(0, 0)], apart[(3, 2)]), (Rgba8::new(0, 0, 0, 255), Rgba8::new(16, 0, 255, 255)));
        assert_eq!(crop(&b, (2, 1), (9, 9)).unwrap().size(), (2, 2));
        assert_eq!(crop(&b, (3, 2), (1, 1)).unwrap()[(0, 0)], b[(3, 2)]);
        assert!(crop(&a, (4, 0), (1, 1)).is_err());
    }
}
