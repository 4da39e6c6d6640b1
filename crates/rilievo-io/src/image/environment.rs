//! Surroundings in: Radiance HDR, EXR, and any picture.

use std::io::Cursor;

use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;
use rilievo::color::srgb_decode;
use rilievo::light::{Environment, Projection};
use rilievo::{Grid, LinearRgb};

use super::decode_raster;
use super::raster::{Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::{Limits, check_plausible};
use crate::source::Source;

/// A row of Radiance HDR may be a handful of runs; a longest row of 65 536 texels takes twelve bytes at least.
const MAX_RATIO: u64 = 32_768;

/// A picture of the surroundings as it was stored.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentImage {
    /// Linear light: floats as they are stored, integers by the sRGB curve. Never negative, always finite.
    pub picture: Grid<LinearRgb>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl EnvironmentImage {
    /// How the picture is to be read, by its shape: twice as wide as high is a panorama, a square is a matcap.
    pub fn projection(&self) -> Option<Projection> {
        match self.picture.size() {
            (w, h) if w == h => Some(Projection::Matcap),
            (w, h) if u64::from(w) == 2 * u64::from(h) => Some(Projection::Equirectangular),
            _ => None,
        }
    }
}

/// Decodes surroundings: Radiance HDR and EXR, whose light is linear, and all pictures, which are taken for sRGB. Alpha
/// plays no part.
///
/// # Errors
/// [`Error::Format`] for a damaged file or values that are not finite, [`Error::Limits`], [`Error::Unsupported`].
pub fn decode_environment(source: &Source, limits: &Limits) -> Result<EnvironmentImage> {
    let radiance = source.bytes().starts_with(b"#?RADIANCE") || source.bytes().starts_with(b"#?RGBE");
    let raster = if radiance { decode_radiance(source, limits)? } else { decode_raster(source, limits)? };
    let channels = raster.channels();
    let mut negative = 0usize;
    let colors: Vec<LinearRgb> = match raster.samples() {
        Samples::U8(v) => v.chunks_exact(channels).map(|t| color(t, |v| srgb_decode(f32::from(v) / 255.0))).collect(),
        Samples::U16(v) => {
            v.chunks_exact(channels).map(|t| color(t, |v| srgb_decode(f32::from(v) / 65_535.0))).collect()
        }
        Samples::F32(v) => {
            let wrong = v.chunks_exact(channels).position(|t| t[..channels.min(3)].iter().any(|v| !v.is_finite()));
            if let Some(at) = wrong {
                let reason = "light that is infinite or not a number; clip the picture to finite values first";
                return Err(Error::format(source.name(), raster.place(at), reason));
            }
            negative = v.chunks_exact(channels).filter(|t| t[..channels.min(3)].iter().any(|&v| v < 0.0)).count();
            v.chunks_exact(channels).map(|t| color(t, |v| v.max(0.0))).collect()
        }
    };
    let mut warnings = Vec::new();
    if negative > 0 {
        warnings.push(format!("{negative} texels hold negative light, which is taken for none"));
    }
    Ok(EnvironmentImage { picture: raster.grid(colors), warnings })
}

/// Gray or colour, without alpha.
fn color<T: Copy>(texel: &[T], to_linear: impl Fn(T) -> f32) -> LinearRgb {
    match *texel {
        [r, g, b, ..] => LinearRgb::new(to_linear(r), to_linear(g), to_linear(b)),
        [gray, ..] => LinearRgb::gray(to_linear(gray)),
        [] => LinearRgb::BLACK,
    }
}

/// Decodes Radiance HDR to RGB floats; the exposure in its header is undone.
fn decode_radiance(source: &Source, limits: &Limits) -> Result<Raster> {
    let (name, bytes) = (source.name(), source.bytes());
    let failed = |e: image::ImageError| Error::format(name, "Radiance data", e.to_string());
    // Not strict: "#?RGBE" files are as sound, and unknown lines of the header harm nobody.
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(bytes)).map_err(failed)?;
    let (size, exposure) = (decoder.dimensions(), decoder.metadata().exposure);
    let texels = limits.check_size(name, size.0.into(), size.1.into())?;
    check_plausible(name, texels as u64 * 4, bytes.len() as u64, MAX_RATIO)?;
    let mut samples = vec![0.0f32; texels * 3];
    decoder.read_image(bytemuck::cast_slice_mut(&mut samples)).map_err(failed)?;
    if let Some(exposure) = exposure.filter(|e| e.is_finite() && *e > 0.0 && *e != 1.0) {
        samples.iter_mut().for_each(|v| *v /= exposure);
    }
    Raster::new(name, size, 3, Samples::F32(samples))
}

/// Reads an environment as its shape says.
///
/// # Errors
/// As [`decode_environment`]; [`Error::Unsupported`] for a picture that is neither a panorama nor a matcap by its shape.
pub fn read_environment(source: &Source, limits: &Limits) -> Result<(Environment, Vec<String>)> {
    let image = decode_environment(source, limits)?;
    let Some(projection) = image.projection() else {
        let (width, height) = image.picture.size();
        let what = format!("an environment of {width} × {height}");
        let remedy = "a panorama is twice as wide as high, a matcap is square";
        return Err(Error::unsupported(source.name(), what, remedy));
    };
    let environment = Environment::new(projection, &image.picture).map_err(|e| Error::invalid(source.name(), e))?;
    Ok((environment, image.warnings))
}
