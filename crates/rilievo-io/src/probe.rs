//! Telling what a file holds without being told.

use crate::indexed::PalettePng;
use crate::source::Source;

/// Whether this is an index map with its table: a KTX2, or a PNG with a palette.
pub fn is_indexed(source: &Source) -> bool {
    source.bytes().starts_with(b"\xabKTX 20\xbb") || is_palette_png(source)
}

/// Whether this is a PNG with a palette.
pub fn is_palette_png(source: &Source) -> bool {
    PalettePng::parse(source).is_ok()
}
