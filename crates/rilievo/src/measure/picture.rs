//! Errors between pictures.
//!
//! Source: NMSE, RNMSE, PMSE and RPMSE as in the polar-coordinates bump mapping paper (§7, Table 2), after Al-Otum:
//! the mean square error relative to the mean square, or to the peak, of the reference. This crate fixes the peak at
//! 255; the printed PMSE values cannot come from any one peak.

use crate::color::{Picture, Rgba8};
use crate::error::Result;
use crate::par;

/// Errors of a picture against a reference; arrays are per channel R, G, B.
///
/// They are measured on the stored 8-bit sRGB codes, as the paper does, not on linear light.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PictureStats {
    /// PSNR over all channels, `10 log₁₀ (255² / MSE)`; infinite for equal pictures.
    pub psnr_db: f64,
    /// Largest difference of a channel, in 1/255.
    pub max_abs: u8,
    /// `Σ (a − b)² / Σ a²`, a the reference. Against an all-black channel 0 if equal and infinite if not.
    pub nmse: [f64; 3],
    /// `√NMSE`.
    pub rnmse: [f64; 3],
    /// `MSE / 255²`.
    pub pmse: [f64; 3],
    /// `√PMSE`.
    pub rpmse: [f64; 3],
}

/// The colour that measures compare: what is seen over black, `code · alpha / 255` to nearest.
///
/// What a transparent pixel stores nobody sees, so it must not count; that one picture covers a pixel and the other
/// does not must. Codes are blended as they are, as browsers and viewers do. Opaque pixels stay what they are.
pub(super) fn compared_rgb(pixel: Rgba8) -> [u8; 3] {
    // Halves do not occur: 255 is odd.
    pixel.rgb().map(|c| ((u32::from(c) * u32::from(pixel.a) + 127) / 255) as u8)
}

/// Compares two pictures pixel by pixel. Sums are exact integers.
///
/// Pixels count as they are seen over black: alpha scales the codes. So pixels that are transparent in both pictures are
/// equal, and opaque pictures are compared as stored.
///
/// # Errors
/// [`crate::Error::SizeMismatch`] if the sizes differ.
///
/// ```
/// use rilievo::measure::picture_stats;
/// use rilievo::{Grid, Rgba8};
///
/// let a = Grid::filled(2, 2, Rgba8::new(100, 100, 100, 255))?;
/// let b = Grid::filled(2, 2, Rgba8::new(110, 100, 100, 255))?;
/// let stats = picture_stats(&a, &b)?;
/// assert_eq!(stats.max_abs, 10);
/// assert_eq!(stats.rnmse, [0.1, 0.0, 0.0]);
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn picture_stats(reference: &Picture, other: &Picture) -> Result<PictureStats> {
    reference.expect_same_size("the other picture", other)?;
    let rows = par::map_range(reference.height() as usize, |y| {
        let pairs = reference.row(y as u32).iter().zip(other.row(y as u32));
        pairs.fold(Sums::default(), |sums, (a, b)| sums.with(compared_rgb(*a), compared_rgb(*b)))
    });
    let sums = rows.into_iter().fold(Sums::default(), Sums::merge);

    let pixels = reference.texels().len() as f64;
    let peak = 255.0f64 * 255.0;
    let pmse = sums.errors.map(|e| e as f64 / pixels / peak);
    let nmse = std::array::from_fn(|c| match (sums.errors[c], sums.squares[c]) {
        (0, _) => 0.0,
        (error, square) => error as f64 / square as f64,
    });
    let all: u64 = sums.errors.iter().sum();
    Ok(PictureStats {
        psnr_db: 10.0 * (3.0 * pixels * peak / all as f64).log10(),
        max_abs: sums.max_abs,
        nmse,
        rnmse: nmse.map(f64::sqrt),
        pmse,
        rpmse: pmse.map(f64::sqrt),
    })
}

/// Sums per channel: 2³⁰ pixels of 255² fit 46 bits.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    errors: [u64; 3],
    squares: [u64; 3],
    max_abs: u8,
}

impl Sums {
    fn with(mut self, a: [u8; 3], b: [u8; 3]) -> Self {
        for c in 0..3 {
            let difference = a[c].abs_diff(b[c]);
            self.errors[c] += u64::from(difference).pow(2);
            self.squares[c] += u64::from(a[c]).pow(2);
            self.max_abs = self.max_abs.max(difference);
        }
        self
    }

    fn merge(mut self, other: Self) -> Self {
        for c in 0..3 {
            self.errors[c] += other.errors[c];
            self.squares[c] += other.squares[c];
        }
        self.max_abs = self.max_abs.max(other.max_abs);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::grid::Grid;

    fn picture(width: u32, pixels: &[[u8; 4]]) -> Picture {
        let pixels = pixels.iter().map(|&[r, g, b, a]| Rgba8::new(r, g, b, a)).collect::<Vec<_>>();
        Grid::new(width, pixels.len() as u32 / width, pixels).unwrap()
    }

    #[test]
    fn equal_pictures_have_no_error() {
        let p = picture(2, &[[1, 2, 3, 255], [0, 0, 0, 255]]);
        let expected = PictureStats { psnr_db: f64::INFINITY, ..PictureStats::default() };
        assert_eq!(picture_stats(&p, &p).unwrap(), expected);
    }

    #[test]
    fn known_differences_give_known_measures() {
        let a = picture(2, &[[3, 0, 10, 255], [4, 0, 20, 255]]);
        let b = picture(2, &[[3, 1, 13, 255], [4, 0, 16, 255]]);
        let s = picture_stats(&a, &b).unwrap();
        assert_eq!(s.max_abs, 4);
        assert_eq!(s.nmse, [0.0, f64::INFINITY, 25.0 / 500.0]);
        assert_eq!(s.rnmse, s.nmse.map(f64::sqrt));
        let peak = 65_025.0;
        assert_eq!(s.pmse, [0.0, 0.5 / peak, 12.5 / peak]);
        assert_eq!(s.rpmse, s.pmse.map(f64::sqrt));
        let mse: f64 = (1.0 + 9.0 + 16.0) / 6.0;
        assert!((s.psnr_db - 10.0 * (peak / mse).log10()).abs() < 1e-12);
    }

    #[test]
    fn black_against_white_is_0_db() {
        let s = picture_stats(&picture(1, &[[0, 0, 0, 255]]), &picture(1, &[[255; 4]])).unwrap();
        assert_eq!((s.psnr_db, s.max_abs, s.rpmse), (0.0, 255, [1.0; 3]));
    }

    #[test]
    fn transparent_pixels_are_equal_and_coverage_counts() {
        let hidden = picture(1, &[[9, 9, 9, 0]]);
        assert_eq!(picture_stats(&hidden, &picture(1, &[[200, 1, 2, 0]])).unwrap().max_abs, 0);
        assert_eq!(picture_stats(&hidden, &picture(1, &[[9, 9, 9, 255]])).unwrap().max_abs, 9);
    }

    #[test]
    fn partial_alpha_counts_as_seen_over_black() {
        let opaque = picture(1, &[[200, 100, 51, 255]]);
        let stats = |a| picture_stats(&opaque, &picture(1, &[[200, 100, 51, a]])).unwrap();
        assert_eq!((stats(255).max_abs, stats(1).max_abs, stats(0).max_abs), (0, 199, 200));
        assert_eq!(compared_rgb(Rgba8::new(200, 100, 51, 128)), [100, 50, 26]);
        assert!((0..=255).all(|c| compared_rgb(Rgba8::new(c, c, c, 255)) == [c; 3]));
    }

    #[test]
    fn sizes_must_agree() {
        let (a, b) = (picture(1, &[[0; 4]; 2]), picture(2, &[[0; 4]; 2]));
        assert!(matches!(picture_stats(&a, &b), Err(Error::SizeMismatch { .. })));
    }
}
