//! KTX2 in and out (KTX File Format Specification 2.0, Khronos Data Format 1.3).

use ktx2::{Format, Header, Index, LevelIndex, Reader, SupercompressionScheme};
use rilievo::{Convention, Grid, MipChain, QuantizedMap, Space};

use super::record::Record;
use super::zstandard::{compress_frame, decompress};
use super::{AnyIndexed, ImportAs, IndexedFile, disagreements};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

const NAME: &str = "KTX2 to be written";
/// The key of the table record.
const TABLE_KEY: &str = "rilievo:table";
/// A level longer than this is several frames (RFC 8878, § 3: data is one or more of them). At this level the search for
/// matches outgrows the caches: twice the time per byte for 64 MiB in one frame, for 5 % less.
const FRAME_BYTES: usize = 4 << 20;

pub(super) fn decode(source: &Source, import: &ImportAs, limits: &Limits) -> Result<IndexedFile> {
    let (name, bytes) = (source.name(), source.bytes());
    let unsupported = |what: String| {
        let remedy = "write it again as R8_UINT or R16_UINT, one 2D texture, without or with Zstandard compression";
        Err(Error::unsupported(name, what, remedy))
    };
    let file = Reader::new(bytes).map_err(|e| Error::format(name, "KTX2 structure", e.to_string()))?;
    let header = file.header();
    let texel_bytes = match header.format {
        Some(Format::R8_UINT) => 1,
        Some(Format::R16_UINT) => 2,
        other => return unsupported(format!("the KTX2 format {other:?} for an indexed map")),
    };
    let compressed = match header.supercompression_scheme {
        // The crate reads "none" and "unknown" alike.
        None if bytes.get(44..48) == Some(&[0; 4]) => false,
        Some(SupercompressionScheme::Zstandard) => true,
        other => return unsupported(format!("the KTX2 supercompression {other:?}")),
    };
    if header.pixel_depth != 0 || header.layer_count > 1 || header.face_count != 1 {
        return unsupported("a KTX2 of several layers, faces or slices".into());
    }
    if file.key_value_data().any(|(key, value)| key == "KTXorientation" && !matches!(value, b"rd\0" | b"rd")) {
        return unsupported("a KTX2 whose first row is not the top one".into());
    }
    limits.check_size(name, header.pixel_width.into(), header.pixel_height.into())?;

    let Some((_, record)) = file.key_value_data().find(|(key, _)| *key == TABLE_KEY) else {
        let reason = format!("the key {TABLE_KEY} is missing, so there is no table: not written by this program");
        return Err(Error::format(name, "KTX2 key/value data", reason));
    };
    let record = Record::from_bytes(record).map_err(|reason| {
        Error::format(name, format!("KTX2 key {TABLE_KEY}"), format!("the table is damaged: {reason}"))
    })?;

    let mut size = Some((header.pixel_width, header.pixel_height));
    let mut levels = Vec::new();
    for (i, level) in file.levels().enumerate() {
        let place = format!("KTX2 level {i}");
        let Some((width, height)) = size else {
            return Err(Error::format(name, place, "there are more levels than halvings of the size"));
        };
        let texels = limits.check_size(name, width.into(), height.into())?;
        let expected = texels * texel_bytes;
        if level.uncompressed_byte_length != expected as u64 {
            let reason = format!("it has {} bytes where {expected} belong", level.uncompressed_byte_length);
            return Err(Error::format(name, place, reason));
        }
        let data = if compressed {
            decompress(level.data, expected).map_err(|e| Error::format(name, &place, e.to_string()))?
        } else {
            level.data.to_vec()
        };
        if data.len() != expected {
            let reason = format!("it unpacks to {} bytes where {expected} belong", data.len());
            return Err(Error::format(name, place, reason));
        }
        let indices = match texel_bytes {
            1 => data.iter().map(|&b| u16::from(b)).collect(),
            _ => data.as_chunks::<2>().0.iter().map(|&b| u16::from_le_bytes(b)).collect(),
        };
        levels.push(Grid::new(width, height, indices).map_err(|e| Error::invalid(name, e))?);
        size = rilievo::mip::next_size((width, height));
    }
    let indices = MipChain::from_levels(levels).map_err(|e| Error::invalid(name, e))?;
    let map = AnyIndexed::new(name, record.table(name)?, indices)?;
    let warnings = disagreements(import, record.space, record.convention);
    Ok(IndexedFile { map, convention: record.convention, warnings })
}

/// All levels as a KTX2: R8_UINT for up to 256 entries, R16_UINT above, Zstandard-compressed level by level (frames of 4 MiB), with the
/// table under the key `rilievo:table`.
///
/// # Errors
/// [`Error::Unsupported`] for a space that maps are not stored in.
pub fn encode_ktx2<S: Space>(map: &QuantizedMap<S>, convention: Convention) -> Result<Vec<u8>> {
    let record = Record::new(NAME, map.table(), convention)?.to_bytes();
    let (format, texel_bytes) = if map.table().len() <= 256 { (Format::R8_UINT, 1) } else { (Format::R16_UINT, 2) };
    let levels = map.indices().levels();

    let dfd = data_format(texel_bytes);
    // The specification wants the keys sorted.
    let writer = concat!("rilievo ", env!("CARGO_PKG_VERSION"), "\0").as_bytes();
    let pairs: [(&str, &[u8]); 3] = [("KTXorientation", b"rd\0"), ("KTXwriter", writer), (TABLE_KEY, &record)];
    let kvd: Vec<u8> = pairs.iter().flat_map(|(key, value)| key_value(key, value)).collect();
    let dfd_at = Header::LENGTH + levels.len() * LevelIndex::LENGTH;
    let kvd_at = dfd_at + dfd.len();

    // Smallest level first, so that a reader of a stream can show something early. Compressed levels need no alignment.
    let mut data_at = kvd_at + kvd.len();
    let mut index = Vec::new();
    let mut data = Vec::new();
    for level in levels.iter().rev() {
        let packed = compress(level.texels(), texel_bytes as usize).map_err(|e| Error::write(NAME, e))?;
        index.push(LevelIndex {
            byte_offset: data_at as u64,
            byte_length: packed.len() as u64,
            uncompressed_byte_length: level.texels().len() as u64 * u64::from(texel_bytes),
        });
        data_at += packed.len();
        data.extend(packed);
    }

    let header = Header {
        format: Some(format),
        type_size: texel_bytes,
        pixel_width: map.base().width(),
        pixel_height: map.base().height(),
        pixel_depth: 0,
        layer_count: 0,
        face_count: 1,
        level_count: levels.len() as u32,
        supercompression_scheme: Some(SupercompressionScheme::Zstandard),
        index: Index {
            dfd_byte_offset: dfd_at as u32,
            dfd_byte_length: dfd.len() as u32,
            kvd_byte_offset: kvd_at as u32,
            kvd_byte_length: kvd.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let mut bytes = header.as_bytes().to_vec();
    // The index lists the largest level first, though it lies last.
    bytes.extend(index.iter().rev().flat_map(LevelIndex::as_bytes));
    bytes.extend(dfd);
    bytes.extend(kvd);
    bytes.extend(data);
    Ok(bytes)
}

/// One Zstandard frame for every [`FRAME_BYTES`] of texels, packed side by side.
fn compress(texels: &[u16], texel_bytes: usize) -> std::io::Result<Vec<u8>> {
    let frames: Vec<&[u16]> = texels.chunks(FRAME_BYTES / texel_bytes).collect();
    let packed = rilievo::par::map_range(frames.len(), |frame| {
        let raw: Vec<u8> = match texel_bytes {
            1 => frames[frame].iter().map(|&i| i as u8).collect(),
            _ => frames[frame].iter().flat_map(|i| i.to_le_bytes()).collect(),
        };
        compress_frame(&raw)
    });
    Ok(packed.into_iter().collect::<std::io::Result<Vec<_>>>()?.concat())
}

/// A data format descriptor with one basic block: one unsigned integer channel.
fn data_format(texel_bytes: u32) -> Vec<u8> {
    const BLOCK_BYTES: u32 = 24 + 16;
    let words: [u32; 11] = [
        4 + BLOCK_BYTES,
        // Khronos's own vendor number and the basic descriptor, both 0.
        0,
        // Version 2 (KDF 1.3), size of the block.
        2 | (BLOCK_BYTES << 16),
        // Model RGBSDA (1), primaries unspecified (0), linear (1), straight alpha (0).
        1 | (1 << 16),
        // Blocks of 1 × 1 × 1 × 1 texels, stored less one.
        0,
        // Bytes per plane: 0 while the data is supercompressed.
        0,
        0,
        // Sample: bit 0, length less one, channel red (0), unsigned integer (no qualifier).
        (8 * texel_bytes - 1) << 16,
        // At the texel's origin.
        0,
        // An integer stands for itself: 0 is 0 and 1 is 1.
        0,
        1,
    ];
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

/// One entry of the key/value data, padded to four bytes.
fn key_value(key: &str, value: &[u8]) -> Vec<u8> {
    let length = key.len() + 1 + value.len();
    let mut entry = (length as u32).to_le_bytes().to_vec();
    entry.extend(key.as_bytes());
    entry.push(0);
    entry.extend(value);
    entry.resize(4 + length.next_multiple_of(4), 0);
    entry
}
