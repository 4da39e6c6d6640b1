//! Pictures and maps of texels, in many formats; told apart by content, never by file name.
//!
//! Height, normal and material maps are data: colour chunks in their files are ignored on reading and never written.
//!
//! # Memory
//! A file's size is checked against [`Limits`] before anything is allocated, and against the bytes the file has: no
//! compression packs more than a fixed ratio (1032 : 1 for PNG). Decoding takes at most the samples as stored (up to
//! 16 bytes a texel for four floats), once more while they are unpacked, plus the result (12 bytes a texel for normals).

mod depth;
mod embedded;
mod environment;
mod exr;
mod height;
mod jpeg;
mod lengths;
mod materials;
mod normals;
mod npy;
mod picture;
pub(crate) mod png;
pub(crate) mod png_write;
mod raster;
mod relief;
mod rows;
mod tiff;

pub use self::exr::encode_normals_exr;
pub use depth::sample_depth;
pub use embedded::{EmbeddedMaterials, decode_normals_with_materials};
pub use environment::{EnvironmentImage, decode_environment, read_environment};
pub use height::{HeightImage, decode_height};
pub use materials::decode_materials;
pub use normals::{NormalImage, decode_normals, repair_normals};
pub use picture::decode_picture;
pub use png_write::{
    encode_apng, encode_gray_png8, encode_gray_png16, encode_normals_png8, encode_normals_png16, encode_picture_png,
};
pub use raster::Depth;
pub use relief::{ReliefImage, decode_relief, looks_like_normals};
pub use rows::NormalRows;

use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;
use raster::Raster;

/// The formats that are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Jpeg,
    Tiff,
    Exr,
    Npy,
    Ktx2,
    /// A known format that is not read, by name.
    Other(&'static str),
}

/// The format of `bytes` by their first few.
pub(crate) fn sniff(bytes: &[u8]) -> Option<Format> {
    let starts: [(&[u8], Format); 20] = [
        (&crate::chunks::SIGNATURE, Format::Png),
        (b"\xff\xd8\xff", Format::Jpeg),
        (b"II*\0", Format::Tiff),
        (b"MM\0*", Format::Tiff),
        (b"II+\0", Format::Tiff),
        (b"MM\0+", Format::Tiff),
        (b"\x76\x2f\x31\x01", Format::Exr),
        (b"\x93NUMPY", Format::Npy),
        (&ktx2::MAGIC, Format::Ktx2),
        (b"#?RADIANCE", Format::Other("Radiance HDR")),
        (b"#?RGBE", Format::Other("Radiance HDR")),
        (b"GIF8", Format::Other("GIF")),
        (b"BM", Format::Other("BMP")),
        (b"DDS ", Format::Other("DDS")),
        (b"8BPS", Format::Other("Photoshop")),
        (b"\xabKTX 11\xbb", Format::Other("KTX 1")),
        (b"\xff\x0a", Format::Other("JPEG XL")),
        (b"\0\0\0\x0cJXL ", Format::Other("JPEG XL")),
        (b"P5", Format::Other("Netpbm")),
        (b"P6", Format::Other("Netpbm")),
    ];
    let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let found = starts.iter().find(|(start, _)| bytes.starts_with(start)).map(|&(_, format)| format);
    found.or(webp.then_some(Format::Other("WebP")))
}

/// The error for a file that is not of a format that serves here.
pub(crate) fn not_read(source: &Source, format: Option<Format>) -> Error {
    let name = source.name();
    match format {
        Some(Format::Other(kind)) => Error::unsupported(name, format!("the format {kind}"), "convert the file to PNG"),
        Some(Format::Ktx2) => {
            let remedy = "a KTX2 file of this program is an indexed map: use it where one is asked for, or give a PNG";
            Error::unsupported(name, "a KTX2 texture in place of a picture", remedy)
        }
        _ if source.bytes().is_empty() => Error::format(name, "byte 0", "the file is empty"),
        _ => Error::format(name, "byte 0", "not a picture this program knows; it reads PNG, JPEG, TIFF, EXR and NPY"),
    }
}

/// Decodes a picture of any format as it is stored.
fn decode_raster(source: &Source, limits: &Limits) -> Result<Raster> {
    let raster = match sniff(source.bytes()) {
        Some(Format::Png) => png::decode(source, limits)?.into_raster(source.name())?,
        Some(Format::Jpeg) => jpeg::decode(source, limits)?,
        Some(Format::Tiff) => tiff::decode(source, limits)?,
        Some(Format::Exr) => exr::decode(source, limits)?,
        Some(Format::Npy) => npy::decode(source, limits)?,
        format => return Err(not_read(source, format)),
    };
    Ok(raster)
}
