//! How samples are stored, told without decoding them.

use super::raster::Depth;
use super::{Format, not_read, sniff, tiff};
use crate::chunks::chunks;
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// How the samples of a picture are stored, from its header alone: [`crate::decode_picture`] narrows 16 bits to 8, and
/// callers may want to say so.
///
/// # Errors
/// [`Error::Format`] for a damaged header, [`Error::Limits`] for a size in a PNG's or TIFF's header above the limits,
/// [`Error::Unsupported`] for formats that are not read. The texels may still turn out to be damaged.
pub fn sample_depth(source: &Source, limits: &Limits) -> Result<Depth> {
    let of_bits = |bits| if bits <= 8 { Depth::U8 } else { Depth::U16 };
    match sniff(source.bytes()) {
        Some(Format::Png) => png_bits(source, limits).map(of_bits),
        Some(Format::Tiff) => tiff::sample_depth(source, limits),
        Some(Format::Jpeg) => Ok(Depth::U8),
        Some(Format::Exr | Format::Npy) => Ok(Depth::F32),
        format => Err(not_read(source, format)),
    }
}

/// Bits per sample of a PNG; of a palette's indices, which is at most the 8 bits of its colours.
fn png_bits(source: &Source, limits: &Limits) -> Result<u8> {
    let name = source.name();
    let missing = || Error::format(name, "byte 8", "a PNG begins with IHDR");
    let header = chunks(name, source.bytes())?.next().ok_or_else(missing)??;
    if header.kind != *b"IHDR" {
        return Err(missing());
    }
    header.expect_intact(name)?;
    let (size, rest) = header.data.split_first_chunk::<8>().ok_or_else(missing)?;
    let [w0, w1, w2, w3, h0, h1, h2, h3] = *size;
    let side = |bytes| u64::from(u32::from_be_bytes(bytes));
    limits.check_size(name, side([w0, w1, w2, w3]), side([h0, h1, h2, h3]))?;
    rest.first().copied().ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{encode_gray_png8, encode_gray_png16};

    #[test]
    fn depths_are_told_from_headers() {
        let gray = rilievo::Grid::filled(3, 2, 0.5f32).unwrap();
        let limits = Limits::default();
        let png16 = encode_gray_png16(&gray).unwrap();
        let png8 = encode_gray_png8(&gray.map(|_| 9)).unwrap();
        // No texel is looked at, so a cut file has a depth, too.
        let cut = png16[..60].to_vec();
        let depth = |bytes: &[u8]| sample_depth(&Source::from_bytes("a", bytes.to_vec()), &limits);
        assert_eq!([png16.clone(), cut, png8].map(|b| depth(&b).unwrap()), [Depth::U16, Depth::U16, Depth::U8]);
        let small = Limits { max_side: 2, ..limits };
        assert!(matches!(sample_depth(&Source::from_bytes("a", png16.clone()), &small), Err(Error::Limits { .. })));
        assert!(matches!(depth(&png16[..20]), Err(Error::Format { .. })));
        assert!(matches!(depth(b"GIF89a"), Err(Error::Unsupported { .. })));

        let mut tiff = std::io::Cursor::new(Vec::new());
        let mut encoder = ::tiff::encoder::TiffEncoder::new(&mut tiff).unwrap();
        encoder.write_image::<::tiff::encoder::colortype::Gray16>(1, 1, &[7]).unwrap();
        assert_eq!(depth(tiff.get_ref()).unwrap(), Depth::U16);
    }
}
