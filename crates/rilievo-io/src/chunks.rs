//! The chunk structure of PNG files: what the decoder of pixels does not tell.

use crate::error::{Error, Result};

/// The eight bytes every PNG begins with.
pub(crate) const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// One chunk of a PNG.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chunk<'a> {
    pub(crate) kind: [u8; 4],
    /// Where the payload begins in the file.
    pub(crate) at: usize,
    pub(crate) data: &'a [u8],
    crc: u32,
}

impl Chunk<'_> {
    /// Whether the chunk's checksum is that of its contents.
    pub(crate) fn is_intact(&self) -> bool {
        checksum(self.kind, self.data) == self.crc
    }

    /// Fails if the chunk's checksum is wrong.
    pub(crate) fn expect_intact(&self, name: &str) -> Result<()> {
        if self.is_intact() {
            return Ok(());
        }
        Err(Error::format(name, self.place(), "its checksum is wrong: the file is damaged; fetch or export it again"))
    }

    /// The chunk as messages name it.
    pub(crate) fn place(&self) -> String {
        let kind: String = self.kind.iter().map(|&b| char::from(b)).collect();
        format!("chunk {} at byte {}", kind.escape_default(), self.at - 8)
    }
}

/// CRC-32 of a chunk, as it stands behind the payload.
pub(crate) fn checksum(kind: [u8; 4], data: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&kind);
    hasher.update(data);
    hasher.finalize()
}

/// The chunks of `bytes` from the first to IEND; an error ends the walk.
///
/// Only lengths are looked at, so skipping the pixels costs nothing.
pub(crate) fn chunks<'a>(name: &'a str, bytes: &'a [u8]) -> Result<Chunks<'a>> {
    if !bytes.starts_with(&SIGNATURE) {
        return Err(Error::format(name, "byte 0", "not a PNG: the signature is missing"));
    }
    Ok(Chunks { name, bytes, at: SIGNATURE.len(), ended: false })
}

/// See [`chunks`].
pub(crate) struct Chunks<'a> {
    name: &'a str,
    bytes: &'a [u8],
    at: usize,
    ended: bool,
}

impl<'a> Chunks<'a> {
    fn read(&mut self) -> Option<Chunk<'a>> {
        let rest = self.bytes.get(self.at..)?;
        let (length, rest) = rest.split_first_chunk::<4>()?;
        let (kind, rest) = rest.split_first_chunk::<4>()?;
        let data = rest.get(..u32::from_be_bytes(*length) as usize)?;
        let crc = u32::from_be_bytes(*rest[data.len()..].first_chunk::<4>()?);
        let chunk = Chunk { kind: *kind, at: self.at + 8, data, crc };
        self.at = chunk.at + data.len() + 4;
        Some(chunk)
    }
}

impl<'a> Iterator for Chunks<'a> {
    type Item = Result<Chunk<'a>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let chunk = self.read();
        self.ended = chunk.is_none_or(|c| c.kind == *b"IEND");
        let cut = || Error::format(self.name, format!("byte {}", self.at), "the file is cut short inside a PNG chunk");
        Some(chunk.ok_or_else(cut))
    }
}
