//! Material maps in.

use png::ColorType;
use rilievo::{Grid, MaterialMap};

use super::raster::Samples;
use super::{Format, decode_raster, png as png_in, sniff};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// Decodes a material map: the value of a gray texel, or the palette index, is the material's number.
///
/// Gray of 1, 2 and 4 bits is not scaled: value 1 is material 1. Alpha is ignored.
///
/// # Errors
/// [`Error::Format`] for colours, more than 8 bits or lossy files; [`Error::Limits`]; [`Error::Unsupported`].
pub fn decode_materials(source: &Source, limits: &Limits) -> Result<MaterialMap> {
    let name = source.name();
    let refuse = |reason: &str| Err(Error::format(name, "header", reason));
    match sniff(source.bytes()) {
        Some(Format::Jpeg) => return refuse("JPEG blurs material numbers; use a PNG of 8-bit gray or with a palette"),
        Some(Format::Png) => {
            let png = png_in::decode(source, limits)?;
            let numbers = match (&png.samples, png.color) {
                (_, ColorType::Indexed) => Some(png.indices(name)?.to_vec()),
                (Samples::U8(v), ColorType::Grayscale) => Some(v.clone()),
                _ => None,
            };
            if let Some(numbers) = numbers {
                let (width, height) = png.size;
                return Grid::new(width, height, numbers).map_err(|e| Error::invalid(name, e));
            }
        }
        _ => {}
    }
    let raster = decode_raster(source, limits)?;
    if let Some(at) = raster.first_colored() {
        let reason = "a colour is not a material number; use 8-bit gray values or palette indices";
        return Err(Error::format(name, raster.place(at), reason));
    }
    match raster.samples() {
        Samples::U8(v) => Ok(raster.grid(v.chunks_exact(raster.channels()).map(|t| t[0]).collect())),
        _ => refuse("material numbers have 8 bits; save the map as 8-bit gray or with a palette"),
    }
}
