//! PNG in: every colour type, bit depth and interlacing of the standard (ISO/IEC 15948).

use std::io::Cursor;

use png::{ColorType, DecodingError};

use super::raster::{Raster, Samples};
use crate::chunks::chunks;
use crate::error::{Error, Result};
use crate::limits::{Limits, check_plausible};
use crate::source::Source;

/// The highest ratio of a deflate stream (258 bytes for 2 bits), rounded up.
const MAX_DEFLATE_RATIO: u64 = 1033;

/// A PNG as stored: no gamma, no palette applied, samples of 1, 2 and 4 bits unpacked but not scaled.
pub(crate) struct Png {
    pub(crate) size: (u32, u32),
    pub(crate) color: ColorType,
    /// Bits per sample.
    pub(crate) bits: u8,
    /// Interleaved; palette indices if `color` says so.
    pub(crate) samples: Samples,
    pub(crate) palette: Vec<[u8; 3]>,
    /// The payload of the tRNS chunk, if there is one.
    transparency: Option<Vec<u8>>,
}

/// Decodes a PNG (an APNG's still picture).
///
/// Checksums of critical chunks must be right and IEND must be there, so a file that was cut anywhere is an error.
pub(crate) fn decode(source: &Source, limits: &Limits) -> Result<Png> {
    let name = source.name();
    let compressed = check_chunks(source)?;
    let failed = |e: DecodingError| match e {
        DecodingError::LimitsExceeded => Error::limits(name, "the memory for ancillary chunks", "64 MiB"),
        e => Error::format(name, "PNG data", e.to_string()),
    };
    let mut decoder = png::Decoder::new(Cursor::new(source.bytes()));
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_transformations(png::Transformations::IDENTITY);
    let header = decoder.read_header_info().map_err(failed)?;
    let size = (header.width, header.height);
    let texels = limits.check_size(name, size.0.into(), size.1.into())?;
    let (color, bits) = (header.color_type, header.bit_depth as u8);
    let row_bytes = header.raw_row_length() - 1;
    check_plausible(name, row_bytes as u64 * u64::from(size.1), compressed, MAX_DEFLATE_RATIO)?;
    decoder.set_limits(png::Limits { bytes: (64 << 20) + 8 * row_bytes });
    let mut reader = decoder.read_info().map_err(failed)?;

    let packed = read_rows(&mut reader, size, row_bytes, failed).and_then(|rows| {
        rows.ok_or_else(|| Error::format(name, "PNG data", "rows are missing or have wrong lengths"))
    })?;
    let samples = unpack(packed, row_bytes, bits, size.0 as usize * color.samples());
    let samples_len = match &samples {
        Samples::U8(v) => v.len(),
        Samples::U16(v) => v.len(),
        Samples::F32(_) => 0,
    };
    if samples_len != texels * color.samples() {
        return Err(Error::format(name, "PNG data", "rows are missing"));
    }
    let info = reader.info();
    let palette = info.palette.as_deref().map_or_else(Vec::new, |p| p.as_chunks::<3>().0.to_vec());
    Ok(Png { size, color, bits, samples, palette, transparency: info.trns.as_deref().map(<[u8]>::to_vec) })
}

/// Walks the chunks: critical ones must be intact. Returns the number of bytes of compressed pixels.
fn check_chunks(source: &Source) -> Result<u64> {
    let name = source.name();
    let mut compressed = 0;
    for (i, chunk) in chunks(name, source.bytes())?.enumerate() {
        let chunk = chunk?;
        if i == 0 && chunk.kind != *b"IHDR" {
            return Err(Error::format(name, chunk.place(), "a PNG begins with IHDR"));
        }
        // A capital first letter marks the chunks no decoder may ignore.
        if chunk.kind[0].is_ascii_uppercase() {
            chunk.expect_intact(name)?;
        }
        if chunk.kind == *b"IDAT" {
            compressed += chunk.data.len() as u64;
        }
    }
    Ok(compressed)
}

/// All rows, packed as stored; `None` if they do not fill the picture.
///
/// Memory grows with the rows that are really there; an interlaced picture needs all of it from the first pass on.
fn read_rows(
    reader: &mut png::Reader<Cursor<&[u8]>>,
    size: (u32, u32),
    row_bytes: usize,
    failed: impl Fn(DecodingError) -> Error,
) -> Result<Option<Vec<u8>>> {
    let total = row_bytes * size.1 as usize;
    let bits_per_pixel = reader.info().bits_per_pixel() as u8;
    let mut packed = Vec::new();
    if reader.info().interlaced {
        packed.resize(total, 0);
    }
    while let Some(row) = reader.next_interlaced_row().map_err(&failed)? {
        match row.interlace() {
            png::InterlaceInfo::Null(_) if row.data().len() == row_bytes && packed.len() < total => {
                packed.extend_from_slice(row.data());
            }
            png::InterlaceInfo::Adam7(pass) if packed.len() == total => {
                png::expand_interlaced_row(&mut packed, row_bytes, row.data(), pass, bits_per_pixel);
            }
            _ => return Ok(None),
        }
    }
    Ok((packed.len() == total).then_some(packed))
}

/// Packed rows to one sample a value; `row_samples` of each row count.
fn unpack(packed: Vec<u8>, row_bytes: usize, bits: u8, row_samples: usize) -> Samples {
    match bits {
        8 => Samples::U8(packed),
        16 => Samples::U16(packed.as_chunks::<2>().0.iter().map(|&b| u16::from_be_bytes(b)).collect()),
        _ => {
            let mask = (1u8 << bits) - 1;
            let mut samples = Vec::with_capacity(packed.len() / row_bytes * row_samples);
            for row in packed.chunks_exact(row_bytes) {
                // The leftmost texel is in the highest bits.
                let all = row.iter().flat_map(|&b| (0..8 / bits).map(move |i| (b >> (8 - bits * (i + 1))) & mask));
                samples.extend(all.take(row_samples));
            }
            Samples::U8(samples)
        }
    }
}

impl Png {
    /// Applies palette and transparency, and scales 1, 2 and 4 bits to 8 (exactly: 255 is a multiple of 1, 3 and 15).
    pub(crate) fn into_raster(self, name: &str) -> Result<Raster> {
        if self.color == ColorType::Indexed {
            return self.paint(name);
        }
        let channels = self.color.samples();
        let key = self.transparency.as_deref().and_then(|t| color_key(t, channels));
        let with_key = channels + usize::from(key.is_some());
        let samples = match self.samples {
            Samples::U16(v) => Samples::U16(match key {
                Some(key) => add_alpha(&v, channels, &key, u16::MAX),
                None => v,
            }),
            Samples::U8(v) => {
                let scale = if self.bits < 8 { 255 / ((1u8 << self.bits) - 1) } else { 1 };
                let scaled: Vec<u8> = v.iter().map(|&s| s * scale).collect();
                Samples::U8(match key {
                    Some(key) => add_alpha(&scaled, channels, &key.map(|k| (k as u8).wrapping_mul(scale)), u8::MAX),
                    None => scaled,
                })
            }
            floats @ Samples::F32(_) => floats,
        };
        Raster::new(name, self.size, with_key, samples)
    }

    /// The alpha of palette entry `i`; entries beyond the tRNS chunk are opaque.
    pub(crate) fn entry_alpha(&self, i: usize) -> u8 {
        self.transparency.as_ref().and_then(|t| t.get(i).copied()).unwrap_or(255)
    }

    /// The palette indices, each checked against the palette.
    ///
    /// # Errors
    /// [`Error::Format`] naming the first texel whose index has no entry.
    pub(crate) fn indices(&self, name: &str) -> Result<&[u8]> {
        let Samples::U8(indices) = &self.samples else {
            return Err(Error::format(name, "header", "palette indices of 16 bits do not exist"));
        };
        let entries = self.palette.len();
        if let Some(at) = indices.iter().position(|&i| usize::from(i) >= entries) {
            let width = self.size.0 as usize;
            let place = format!("texel ({}, {})", at % width, at / width);
            let reason = format!("palette index {} where the palette has {entries} entries", indices[at]);
            return Err(Error::format(name, place, reason));
        }
        Ok(indices)
    }

    /// Every index looked up in the palette.
    fn paint(&self, name: &str) -> Result<Raster> {
        let indices = self.indices(name)?;
        if self.transparency.is_none() {
            let colors = indices.iter().flat_map(|&i| self.palette[usize::from(i)]).collect();
            return Raster::new(name, self.size, 3, Samples::U8(colors));
        }
        let color = |&i: &u8| {
            let [r, g, b] = self.palette[usize::from(i)];
            [r, g, b, self.entry_alpha(i.into())]
        };
        Raster::new(name, self.size, 4, Samples::U8(indices.iter().flat_map(color).collect()))
    }
}

/// The one colour of a gray or RGB picture that is transparent; gray is repeated.
fn color_key(transparency: &[u8], channels: usize) -> Option<[u16; 3]> {
    let value = |i: usize| transparency.get(2 * i..2 * i + 2).map(|b| u16::from_be_bytes([b[0], b[1]]));
    match channels {
        1 => value(0).map(|v| [v; 3]),
        3 => Some([value(0)?, value(1)?, value(2)?]),
        _ => None,
    }
}

/// Adds an alpha channel to gray or RGB samples: 0 where the colour is `key`, `opaque` elsewhere.
fn add_alpha<T: Copy + PartialEq + Default>(samples: &[T], channels: usize, key: &[T; 3], opaque: T) -> Vec<T> {
    let alpha = |t: &[T]| if t == &key[..t.len()] { T::default() } else { opaque };
    samples.chunks_exact(channels).flat_map(|t| t.iter().copied().chain([alpha(t)])).collect()
}
