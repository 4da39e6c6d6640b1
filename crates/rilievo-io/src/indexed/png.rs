//! Indexed PNG in and out.

use png::{BitDepth, ColorType, EncodingError, Filter};
use rilievo::normal::encode_u8;
use rilievo::{Convention, Grid, MipChain, QuantizedMap, Space};

use super::palette::{PalettePng, TABLE_CHUNK};
use super::record::Record;
use super::{AnyIndexed, ImportAs, IndexedFile};
use crate::error::{Error, Result};
use crate::image::{png as png_in, png_write};
use crate::limits::Limits;
use crate::source::Source;

const NAME: &str = "indexed PNG to be written";

pub(super) fn decode(source: &Source, import: &ImportAs, limits: &Limits) -> Result<IndexedFile> {
    let name = source.name();
    let palette = PalettePng::parse(source)?.table(import)?;
    let png = png_in::decode(source, limits)?;
    let (width, height) = png.size;
    let indices = png.indices(name)?.iter().map(|&i| u16::from(i)).collect();
    let base = Grid::new(width, height, indices).map_err(|e| Error::invalid(name, e))?;
    let map = AnyIndexed::new(name, palette.table, MipChain::single(base))?;
    Ok(IndexedFile { map, convention: palette.convention, warnings: palette.warnings })
}

/// The full-size level as a PNG whose palette is the table in 8 bits, with the exact table in the chunk `nrTB`.
///
/// The smallest of 1, 2, 4 and 8 bits an index that fits is used. Indices are not amounts, so filters rarely help:
/// none and the adaptive choice are tried, and the smaller file is kept.
///
/// # Errors
/// [`Error::Unsupported`] for more than 256 entries, or a space that maps are not stored in.
pub fn encode_indexed_png<S: Space>(map: &QuantizedMap<S>, convention: Convention) -> Result<Vec<u8>> {
    let entries = map.table().len();
    let depth = match entries {
        0..=2 => BitDepth::One,
        3..=4 => BitDepth::Two,
        5..=16 => BitDepth::Four,
        17..=256 => BitDepth::Eight,
        _ => {
            let what = format!("a palette of {entries} entries");
            return Err(Error::unsupported(NAME, what, "PNG holds at most 256: write a .ktx2, or quantize to 256"));
        }
    };
    let colors = map.table().normals().iter().flat_map(|&n| encode_u8(convention.apply(n)));
    let palette: Vec<u8> = colors.collect();
    let mut chunk = crc32fast::hash(&palette).to_be_bytes().to_vec();
    chunk.extend(Record::new(NAME, map.table(), convention)?.to_bytes());
    let data = pack(map.base(), depth as u8);

    let write = |filter: Filter| {
        png_write::encode(map.base().size(), ColorType::Indexed, depth, |mut encoder| -> Result<(), EncodingError> {
            encoder.set_deflate_compression(png::DeflateCompression::Level(9));
            encoder.set_filter(filter);
            encoder.set_palette(palette.clone());
            let mut writer = encoder.write_header()?;
            writer.write_chunk(png::chunk::ChunkType(TABLE_CHUNK), &chunk)?;
            writer.write_image_data(&data)?;
            writer.finish()
        })
    };
    let plain = write(Filter::NoFilter)?;
    if depth != BitDepth::Eight {
        return Ok(plain);
    }
    let filtered = write(Filter::Adaptive)?;
    Ok(if filtered.len() < plain.len() { filtered } else { plain })
}

/// Indices packed into bytes, each row by itself, the leftmost in the highest bits.
fn pack(indices: &Grid<u16>, bits: u8) -> Vec<u8> {
    let per_byte = usize::from(8 / bits);
    let byte = |group: &[u16]| {
        let shifted = group.iter().enumerate().map(|(i, &v)| (v as u8) << (8 - bits as usize * (i + 1)));
        shifted.fold(0, |a, b| a | b)
    };
    indices.rows().flat_map(|row| row.chunks(per_byte).map(byte)).collect()
}
