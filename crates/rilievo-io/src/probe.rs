//! Telling what a file holds without being told.

use rilievo::Rgba8;

use crate::image::decode_picture;
use crate::indexed::PalettePng;
use crate::limits::Limits;
use crate::source::Source;

/// How far from unit length a vector of a normal map may be: JPEG and 8 bits stay well below.
const LENGTH_TOLERANCE: f32 = 0.1;
/// The share of a normal map's texels that must be of unit length. Photographs have about a tenth.
const UNIT_SHARE: f64 = 0.98;

/// Whether this is an index map with its table: a KTX2, or a PNG with a palette.
pub fn is_indexed(source: &Source) -> bool {
    source.bytes().starts_with(b"\xabKTX 20\xbb") || is_palette_png(source)
}

/// Whether this is a PNG with a palette.
pub fn is_palette_png(source: &Source) -> bool {
    PalettePng::parse(source).is_ok()
}

/// Whether a file holds normals rather than a picture: formats without colour do, pictures if nearly all their opaque
/// pixels are vectors of unit length. A file that cannot be read holds none.
pub fn looks_like_normals(source: &Source, limits: &Limits) -> bool {
    let bytes = source.bytes();
    let never_color = [&b"\xabKTX 20\xbb"[..], b"\x93NUMPY", b"\x76\x2f\x31\x01"];
    if never_color.iter().any(|magic| bytes.starts_with(magic)) {
        return true;
    }
    let Ok(picture) = decode_picture(source, limits) else { return false };
    let opaque = || picture.texels().iter().filter(|p| p.a > 0);
    let unit = opaque().filter(|p| (length(p) - 1.0).abs() < LENGTH_TOLERANCE).count();
    // All one colour says nothing: a flat gray picture of the right gray would be "normals" of one direction.
    let first = opaque().next();
    let varied = opaque().any(|p| Some(p) != first) || first.is_some_and(|p| p.b > 250 && p.r.abs_diff(128) < 2);
    varied && unit as f64 >= UNIT_SHARE * opaque().count() as f64
}

fn length(p: &Rgba8) -> f32 {
    let [x, y, z] = p.rgb().map(|c| f32::from(c) / 127.5 - 1.0);
    (x * x + y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{encode_normals_png8, encode_picture_png};
    use rilievo::normal::{Normal, encode_u8};
    use rilievo::{Grid, Object};

    fn is_normals(bytes: Vec<u8>) -> bool {
        looks_like_normals(&Source::from_bytes("x", bytes), &Limits::default())
    }

    #[test]
    fn vectors_are_told_from_colors() {
        let normal = |x, y| Normal::<Object>::new(glam::Vec3::new(x as f32 - 8.3, y as f32 - 8.1, 4.0)).unwrap();
        let codes = Grid::from_fn(16, 16, |x, y| encode_u8(normal(x, y))).unwrap();
        assert!(is_normals(encode_normals_png8(&codes, None).unwrap()));
        let flat = Grid::filled(4, 4, [128, 128, 255]).unwrap();
        assert!(is_normals(encode_normals_png8(&flat, None).unwrap()));
        let gray = Grid::from_fn(16, 16, |x, y| Rgba8::new((x * 16) as u8, (x * 16) as u8, (y * 16) as u8, 255));
        assert!(!is_normals(encode_picture_png(&gray.unwrap()).unwrap()));
        // A gray whose code happens to be a unit vector.
        let one = Grid::filled(4, 4, Rgba8::new(201, 201, 201, 255)).unwrap();
        assert!(!is_normals(encode_picture_png(&one).unwrap()));
        assert!(!is_normals(b"nothing".to_vec()));
    }
}
