//! Height maps and normal maps in, told apart.

use rilievo::{Convention, Space};

use super::decode_raster;
use super::height::{HeightImage, heights};
use super::normals::{NormalImage, normals};
use super::raster::{Raster, Samples};
use crate::error::Result;
use crate::limits::Limits;
use crate::source::Source;

/// How far from unit length a vector of a normal map may be: JPEG and 8 bits stay well below.
const LENGTH_TOLERANCE: f32 = 0.1;
/// The share of a normal map's texels that must be of unit length. Photographs have about a tenth.
const UNIT_SHARE: f64 = 0.98;

/// What a map of either kind has.
#[derive(Debug, Clone, PartialEq)]
pub enum ReliefImage<S> {
    /// A gray one.
    Heights(HeightImage),
    /// One whose colours are vectors.
    Normals(NormalImage<S>),
}

/// Decodes a map of heights or of normals, whichever it is: floats with colours are normals, and so are integers if nearly
/// all opaque texels are vectors of unit length.
///
/// # Errors
/// Those of [`super::decode_normals`] for normals, of [`super::decode_height`] for anything else.
pub fn decode_relief<S: Space>(source: &Source, convention: Convention, limits: &Limits) -> Result<ReliefImage<S>> {
    let raster = decode_raster(source, limits)?;
    if holds_normals(&raster) {
        return normals(source, &raster, convention, false).map(ReliefImage::Normals);
    }
    heights(source, &raster).map(ReliefImage::Heights)
}

/// Whether a file holds normals rather than heights or a picture, as [`decode_relief`] tells them apart. A KTX2 does, which
/// has a table of them; a file that cannot be read holds none.
pub fn looks_like_normals(source: &Source, limits: &Limits) -> bool {
    source.bytes().starts_with(&ktx2::MAGIC) || decode_raster(source, limits).is_ok_and(|raster| holds_normals(&raster))
}

fn holds_normals(raster: &Raster) -> bool {
    if !raster.has_color() {
        return false;
    }
    match raster.samples() {
        Samples::U8(v) => are_unit(v, raster.channels(), 127.5),
        Samples::U16(v) => are_unit(v, raster.channels(), 32_767.5),
        Samples::F32(_) => raster.first_colored().is_some(),
    }
}

/// Whether nearly all opaque texels are vectors of unit length, where `half` stands for zero.
fn are_unit<T: Copy + PartialEq + Default + Into<f32>>(samples: &[T], channels: usize, half: f32) -> bool {
    let opaque = || samples.chunks_exact(channels).filter(|t| channels == 3 || t[3] != T::default());
    let vector = |t: &[T]| [t[0], t[1], t[2]].map(|c| c.into() / half - 1.0);
    let length = |[x, y, z]: [f32; 3]| (x * x + y * y + z * z).sqrt();
    let unit = opaque().filter(|t| (length(vector(t)) - 1.0).abs() < LENGTH_TOLERANCE).count();
    // All one colour says nothing, unless it is that of a flat map: a gray of the right code would be one direction.
    let Some(first) = opaque().next() else { return false };
    let [x, _, z] = vector(first);
    let is_flat = z > 0.965 && x.abs() < 0.02;
    let varied = is_flat || opaque().any(|t| t[..3] != first[..3]);
    varied && unit as f64 >= UNIT_SHARE * opaque().count() as f64
}

#[cfg(test)]
mod tests {
    use rilievo::normal::{Normal, encode_u8};
    use rilievo::{Grid, Object, Rgba8};
    use testkit::write_npy_f32;

    use super::*;
    use crate::image::{
        encode_gray_png16, encode_normals_exr, encode_normals_png8, encode_normals_png16, encode_picture_png,
    };

    fn is_normals(bytes: Vec<u8>) -> bool {
        looks_like_normals(&Source::from_bytes("x", bytes), &Limits::default())
    }

    fn normal(x: u32, y: u32) -> Normal<Object> {
        Normal::new(glam::Vec3::new(x as f32 - 8.3, y as f32 - 8.1, 4.0)).unwrap()
    }

    #[test]
    fn vectors_are_told_from_colors() {
        let map = Grid::from_fn(16, 16, normal).unwrap();
        assert!(is_normals(encode_normals_png8(&map.map(|&n| encode_u8(n)), None).unwrap()));
        assert!(is_normals(encode_normals_png16(&map, Convention::Gl, None).unwrap()));
        assert!(is_normals(encode_normals_exr(&map, Convention::Gl, None).unwrap()));
        let flat = Grid::filled(4, 4, [128, 128, 255]).unwrap();
        assert!(is_normals(encode_normals_png8(&flat, None).unwrap()));
        let colors = Grid::from_fn(16, 16, |x, y| Rgba8::new((x * 16) as u8, (x * 16) as u8, (y * 16) as u8, 255));
        assert!(!is_normals(encode_picture_png(&colors.unwrap()).unwrap()));
        // A gray whose code happens to be a unit vector.
        let one = Grid::filled(4, 4, Rgba8::new(201, 201, 201, 255)).unwrap();
        assert!(!is_normals(encode_picture_png(&one).unwrap()));
        assert!(!is_normals(b"nothing".to_vec()));
    }

    #[test]
    fn each_kind_is_decoded_as_what_it_is() {
        let decode = |bytes: Vec<u8>| {
            let source = Source::from_bytes("x", bytes);
            decode_relief::<Object>(&source, Convention::Gl, &Limits::default())
        };
        let ramp = Grid::from_fn(8, 4, |x, y| (x + y) as f32 / 16.0).unwrap();
        for bytes in [encode_gray_png16(&ramp).unwrap(), write_npy_f32(&[4, 8], ramp.texels())] {
            let Ok(ReliefImage::Heights(found)) = decode(bytes) else { panic!("these are heights") };
            assert!((found.heights[(7, 3)] - 0.625).abs() < 1e-4);
        }
        let map = Grid::from_fn(16, 16, normal).unwrap();
        let values: Vec<f32> = map.texels().iter().flat_map(|n| n.vec().to_array()).collect();
        for bytes in [encode_normals_exr(&map, Convention::Gl, None).unwrap(), write_npy_f32(&[16, 16, 3], &values)] {
            let Ok(ReliefImage::Normals(found)) = decode(bytes) else { panic!("these are normals") };
            assert!(found.normals[(3, 5)].angle_to(map[(3, 5)]) < 1e-2);
        }
        let colors = Grid::from_fn(16, 16, |x, y| Rgba8::new(x as u8, 0, y as u8 * 9, 255)).unwrap();
        let error = decode(encode_picture_png(&colors).unwrap()).unwrap_err().to_string();
        assert!(error.contains("differ"), "{error}");
    }
}
