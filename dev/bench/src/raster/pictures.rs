//! Comparing pictures of two renderers, and keeping them to be looked at.

use anyhow::{Context, Result};
use rilievo::color::{Picture, Rgba8};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

/// Where pictures are kept, beside the build's own output.
pub(super) const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/bench-raster");

/// How two pictures differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Difference {
    /// Squared error of the codes of pixels that both cover, and how many codes that are.
    squared: f64,
    codes: u64,
    /// Pixels that only one of the two covers.
    pub(super) coverage: u64,
}

impl Difference {
    pub(super) const NONE: Self = Self { squared: 0.0, codes: 0, coverage: 0 };

    pub(super) fn between(a: &Picture, b: &Picture) -> Self {
        a.texels().iter().zip(b.texels()).fold(Self::NONE, |sum, (a, b)| match (a.a > 0, b.a > 0) {
            (true, true) => {
                let squares = a.rgb().into_iter().zip(b.rgb()).map(|(a, b)| f64::from(a.abs_diff(b)).powi(2));
                Self { squared: sum.squared + squares.sum::<f64>(), codes: sum.codes + 3, ..sum }
            }
            (false, false) => sum,
            _ => Self { coverage: sum.coverage + 1, ..sum },
        })
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            squared: self.squared + other.squared,
            codes: self.codes + other.codes,
            coverage: self.coverage + other.coverage,
        }
    }

    /// PSNR over the pixels that both cover; infinite for equal ones.
    pub(super) fn psnr_db(&self) -> f64 {
        10.0 * (self.codes as f64 * 255.0 * 255.0 / self.squared).log10()
    }
}

/// How many pixels are covered.
pub(super) fn covered(picture: &Picture) -> u64 {
    picture.texels().iter().filter(|p| p.a > 0).count() as u64
}

/// Differences times eight, and white where only one picture covers.
pub(super) fn difference(a: &Picture, b: &Picture) -> Picture {
    let mut out = a.clone();
    for (out, b) in out.texels_mut().iter_mut().zip(b.texels()) {
        let scaled = |a: u8, b: u8| a.abs_diff(b).saturating_mul(8);
        *out = if (out.a > 0) == (b.a > 0) {
            Rgba8::new(scaled(out.r, b.r), scaled(out.g, b.g), scaled(out.b, b.b), 255)
        } else {
            Rgba8::new(255, 255, 255, 255)
        };
    }
    out
}

/// Writes a picture to [`FOLDER`].
pub(super) fn keep(name: &str, picture: &Picture) -> Result<()> {
    let folder = Path::new(FOLDER);
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let path = folder.join(format!("{name}.png"));
    let file = File::create(&path).with_context(|| path.display().to_string())?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    Ok(encoder.write_header()?.write_image_data(bytemuck::cast_slice(picture.texels()))?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::Grid;

    #[test]
    fn only_common_pixels_count_and_the_others_are_counted() {
        let pixel = |v, a| Rgba8 { r: v, g: v, b: v, a };
        let a = Grid::new(4, 1, vec![pixel(10, 255), pixel(9, 255), pixel(0, 0), pixel(0, 0)]).unwrap();
        let b = Grid::new(4, 1, vec![pixel(13, 255), pixel(7, 0), pixel(200, 255), pixel(90, 0)]).unwrap();
        let found = Difference::between(&a, &b);
        assert_eq!(found, Difference { squared: 27.0, codes: 3, coverage: 2 });
        // Three codes off by three.
        assert!((found.psnr_db() - 20.0 * (255.0f64 / 3.0).log10()).abs() < 1e-9);
        assert_eq!(found.and(found), Difference { squared: 54.0, codes: 6, coverage: 4 });
        assert_eq!((covered(&a), covered(&b)), (2, 2));
        let seen = difference(&a, &b);
        assert_eq!(seen.texels()[..3], [pixel(24, 255), pixel(255, 255), pixel(255, 255)]);
    }

    #[test]
    fn equal_pictures_have_no_bound_on_psnr() {
        let a = Grid::filled(2, 2, Rgba8::new(1, 2, 3, 255)).unwrap();
        assert_eq!(Difference::between(&a, &a).psnr_db(), f64::INFINITY);
    }
}
