//! TIFF in: gray and RGB, with or without alpha, of 8 or 16 bits or floats.

use std::io::Cursor;

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use super::raster::{Depth, Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::{Limits, check_plausible};
use crate::source::Source;

/// LZW packs up to 4094 bytes in a code of 12 bits; deflate less.
const MAX_RATIO: u64 = 4096;

/// Decodes the first picture of a TIFF.
pub(crate) fn decode(source: &Source, limits: &Limits) -> Result<Raster> {
    let name = source.name();
    let failed = |e: tiff::TiffError| match e {
        tiff::TiffError::UnsupportedError(e) => Error::unsupported(name, format!("this TIFF ({e})"), REMEDY),
        tiff::TiffError::LimitsExceeded => Error::limits(name, "the memory for this TIFF", "its size in texels"),
        e => Error::format(name, "TIFF data", e.to_string()),
    };
    let unsupported = |what: String| Err(Error::unsupported(name, what, REMEDY));
    let mut decoder = Decoder::new(Cursor::new(source.bytes())).map_err(failed)?;
    let size = decoder.dimensions().map_err(failed)?;
    let texels = limits.check_size(name, size.0.into(), size.1.into())?;
    let color = decoder.colortype().map_err(failed)?;
    let (channels, bits) = match color {
        ColorType::Gray(bits) => (1, bits),
        ColorType::GrayA(bits) => (2, bits),
        ColorType::RGB(bits) => (3, bits),
        ColorType::RGBA(bits) => (4, bits),
        other => return unsupported(format!("a TIFF of {other:?}")),
    };
    if !matches!(bits, 8 | 16 | 32 | 64) {
        return unsupported(format!("a TIFF of {bits} bits a sample"));
    }
    let planar = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(failed)?;
    if planar == Some(2) && channels > 1 {
        return unsupported("a TIFF with one plane per channel".into());
    }
    let bytes = texels * channels * usize::from(bits / 8);
    check_plausible(name, bytes as u64, source.bytes().len() as u64, MAX_RATIO)?;
    let mut memory = tiff::decoder::Limits::default();
    memory.decoding_buffer_size = bytes;
    memory.intermediate_buffer_size = bytes.max(1 << 20);
    let samples = match decoder.with_limits(memory).read_image().map_err(failed)? {
        DecodingResult::U8(v) => Samples::U8(v),
        DecodingResult::U16(v) => Samples::U16(v),
        DecodingResult::F16(v) => Samples::F32(v.into_iter().map(f32::from).collect()),
        DecodingResult::F32(v) => Samples::F32(v),
        DecodingResult::F64(v) => Samples::F32(v.into_iter().map(|v| v as f32).collect()),
        _ => return unsupported(format!("a TIFF of {bits}-bit integers")),
    };
    Raster::new(name, size, channels, samples)
}

/// How the samples of the first picture are stored, from its header.
pub(crate) fn sample_depth(source: &Source, limits: &Limits) -> Result<Depth> {
    let name = source.name();
    let failed = |e: tiff::TiffError| Error::format(name, "TIFF data", e.to_string());
    let mut decoder = Decoder::new(Cursor::new(source.bytes())).map_err(failed)?;
    let (width, height) = decoder.dimensions().map_err(failed)?;
    limits.check_size(name, width.into(), height.into())?;
    let format = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).map_err(failed)?;
    // 3 is IEEE floating point (TIFF 6.0, section 19).
    let floats = format.is_some_and(|f| f.first() == Some(&3));
    let bits = decoder.colortype().map_err(failed)?.bit_depth();
    Ok(match bits {
        _ if floats => Depth::F32,
        0..=8 => Depth::U8,
        _ => Depth::U16,
    })
}

const REMEDY: &str = "save it as gray or RGB of 8 or 16 bits, or of 32-bit floats, interleaved";
