//! In Rust: as good to read, and files some tenths larger.

use std::io::{Error, ErrorKind, Read, Result};

use ruzstd::decoding::StreamingDecoder;
use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};

/// Unpacks frames; memory grows with what is really there, and stops one byte past what is expected.
pub(in crate::indexed) fn decompress(mut data: &[u8], expected: usize) -> Result<Vec<u8>> {
    let mut unpacked = Vec::new();
    while !data.is_empty() && unpacked.len() <= expected {
        match StreamingDecoder::new(&mut data) {
            Ok(decoder) => {
                let left = expected - unpacked.len();
                decoder.take(left as u64 + 1).read_to_end(&mut unpacked)?;
            }
            Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame { length, .. })) => {
                data = data.get(length as usize..).unwrap_or_default();
            }
            Err(error) => return Err(Error::new(ErrorKind::InvalidData, error.to_string())),
        }
    }
    Ok(unpacked)
}

/// One frame.
pub(in crate::indexed) fn compress_frame(raw: &[u8]) -> Result<Vec<u8>> {
    Ok(compress_to_vec(raw, CompressionLevel::Fastest))
}
