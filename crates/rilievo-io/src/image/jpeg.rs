//! JPEG in. Lossy: good for pictures, poor for maps (its noise tilts normals by degrees).

use std::io::Cursor;

use image::codecs::jpeg::JpegDecoder;
use image::{ColorType, ImageDecoder};

use super::raster::{Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::{Limits, check_plausible};
use crate::source::Source;

/// A block of 8 × 8 texels costs at least a bit in some scan: 512 texels a byte, three channels each, doubled.
const MAX_RATIO: u64 = 3072;

/// Decodes a JPEG to gray or RGB of 8 bits.
pub(crate) fn decode(source: &Source, limits: &Limits) -> Result<Raster> {
    let (name, bytes) = (source.name(), source.bytes());
    let failed = |e: image::ImageError| Error::format(name, "JPEG data", e.to_string());
    check_complete(name, bytes)?;
    let decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(failed)?;
    let size = decoder.dimensions();
    let texels = limits.check_size(name, size.0.into(), size.1.into())?;
    let channels = match decoder.color_type() {
        ColorType::L8 => 1,
        ColorType::Rgb8 => 3,
        other => return Err(Error::unsupported(name, format!("a JPEG of {other:?}"), "convert the file to PNG")),
    };
    check_plausible(name, (texels * channels) as u64, bytes.len() as u64, MAX_RATIO)?;
    let mut samples = vec![0; texels * channels];
    decoder.read_image(&mut samples).map_err(failed)?;
    Raster::new(name, size, channels, Samples::U8(samples))
}

/// Fails unless the end marker follows the last scan: decoders fill what a cut file lacks with gray, silently.
fn check_complete(name: &str, bytes: &[u8]) -> Result<()> {
    // In compressed data FF is always followed by 00 or a restart marker, so these pairs are markers.
    let last = |marker: u8| bytes.windows(2).rposition(|w| w == [0xff, marker]);
    let (scan, end) = (last(0xda), last(0xd9));
    if scan.is_some() && scan < end {
        return Ok(());
    }
    Err(Error::format(name, format!("byte {}", bytes.len()), "the JPEG is cut short: its end marker is missing"))
}
