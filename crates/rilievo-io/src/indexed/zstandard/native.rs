//! By the library of Zstandard's authors.

use std::io::{Read, Result};

use zstd::zstd_safe::CParameter;

/// Slow to write, as fast to read as any other.
const LEVEL: i32 = 19;

/// Unpacks frames; memory grows with what is really there, and stops one byte past what is expected.
pub(in crate::indexed) fn decompress(data: &[u8], expected: usize) -> Result<Vec<u8>> {
    let mut unpacked = Vec::new();
    let mut decoder = zstd::stream::read::Decoder::with_buffer(data)?;
    // 128 MiB, what every decoder must accept at most: a frame cannot ask for more.
    decoder.window_log_max(27)?;
    decoder.take(expected as u64 + 1).read_to_end(&mut unpacked)?;
    Ok(unpacked)
}

/// One frame with a checksum.
pub(in crate::indexed) fn compress_frame(raw: &[u8]) -> Result<Vec<u8>> {
    let mut compressor = zstd::bulk::Compressor::new(LEVEL)?;
    compressor.set_parameter(CParameter::ChecksumFlag(true))?;
    compressor.compress(raw)
}
