//! Pictures for the eye, in.

use rilievo::Rgba8;
use rilievo::color::Picture;

use super::decode_raster;
use super::raster::Samples;
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// Decodes a picture of 8 or 16 bits as sRGB with straight alpha; 16 bits are rounded to 8.
///
/// # Errors
/// [`Error::Format`], [`Error::Limits`], or [`Error::Unsupported`] for floats: how bright they should look is not in
/// the file.
pub fn decode_picture(source: &Source, limits: &Limits) -> Result<Picture> {
    let raster = decode_raster(source, limits)?;
    let channels = raster.channels();
    let pixels = match raster.samples() {
        Samples::U8(v) => v.chunks_exact(channels).map(pixel).collect(),
        Samples::U16(v) => {
            // v · 255 / 65535 = v / 257, to nearest; halves do not occur.
            let narrow = |v: u16| ((u32::from(v) + 128) / 257) as u8;
            let mut texel = [0; 4];
            let convert = |t: &[u16]| {
                texel.iter_mut().zip(t).for_each(|(to, &from)| *to = narrow(from));
                pixel(&texel[..channels])
            };
            v.chunks_exact(channels).map(convert).collect()
        }
        Samples::F32(_) => {
            let remedy = "convert it to an 8-bit PNG at the exposure you want";
            return Err(Error::unsupported(source.name(), "a picture of floats", remedy));
        }
    };
    Ok(raster.grid(pixels))
}

fn pixel(t: &[u8]) -> Rgba8 {
    match *t {
        [v] => Rgba8::new(v, v, v, 255),
        [v, a] => Rgba8::new(v, v, v, a),
        [r, g, b] => Rgba8::new(r, g, b, 255),
        [r, g, b, a, ..] => Rgba8::new(r, g, b, a),
        [] => Rgba8::default(),
    }
}
