//! Normal maps whose colours hold the materials as well (Tarini et al. 2000, § 6).

use glam::Vec3;
use rilievo::normal::decode_u8;
use rilievo::{Convention, MaterialMap, Normal, Space};

use super::decode_raster;
use super::normals::NormalImage;
use super::raster::{Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// Where in its colour a texel's material stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EmbeddedMaterials {
    /// Alpha is the material's number; all texels are covered.
    Alpha,
    /// The colour cube is cut into 8 sub-cubes by the top bits r, g, b of the components. The 4 that share no face, those
    /// with r ⊕ g ⊕ b = 0, hold a material each, its number being 2r + g; the other 7 bits c of a component stand for
    /// c / 127 · 2 − 1. (The paper leaves open which sub-cube is which material.)
    SubCubes,
}

/// Decodes an 8-bit normal map that holds a material for each texel, too.
///
/// # Errors
/// [`Error::Format`] for other depths, for pictures without alpha if that is where materials should stand, and for
/// colours in a sub-cube that is not used; as [`super::decode_normals`] otherwise.
pub fn decode_normals_with_materials<S: Space>(
    source: &Source,
    convention: Convention,
    embedded: EmbeddedMaterials,
    limits: &Limits,
) -> Result<(NormalImage<S>, MaterialMap)> {
    let raster = decode_raster(source, limits)?;
    let refuse = |reason: &str| Err(Error::format(source.name(), "header", reason));
    let channels = raster.channels();
    let Samples::U8(samples) = raster.samples() else {
        return refuse("materials inside colours need 8 bits a channel; give the materials as a map of their own");
    };
    match (embedded, channels) {
        (EmbeddedMaterials::Alpha, 4) | (EmbeddedMaterials::SubCubes, 3 | 4) => {}
        (EmbeddedMaterials::Alpha, _) => return refuse("there is no alpha beside three colours to hold materials"),
        (EmbeddedMaterials::SubCubes, _) => return refuse("a gray picture holds heights, not normals"),
    }
    let texels = samples.chunks_exact(channels);
    let (normals, materials): (Vec<_>, Vec<_>) = match embedded {
        EmbeddedMaterials::Alpha => texels.map(|t| (convention.apply(decode_u8([t[0], t[1], t[2]])), t[3])).unzip(),
        EmbeddedMaterials::SubCubes => {
            let decoded = texels.enumerate().map(|(i, t)| sub_cube(source.name(), &raster, i, [t[0], t[1], t[2]]));
            let decoded: Vec<(Normal<S>, u8)> = decoded.collect::<Result<_>>()?;
            decoded.into_iter().map(|(normal, material)| (convention.apply(normal), material)).unzip()
        }
    };
    let image = NormalImage {
        normals: raster.grid(normals),
        colors: None,
        covered: None,
        depth: raster.depth(),
        warnings: Vec::new(),
    };
    Ok((image, raster.grid(materials)))
}

/// Normal and material of texel `i`.
fn sub_cube<S: Space>(name: &str, raster: &Raster, i: usize, color: [u8; 3]) -> Result<(Normal<S>, u8)> {
    let [r, g, b] = color.map(|c| c >> 7);
    if r ^ g ^ b != 0 {
        let reason = format!("the colour {color:?} lies in a sub-cube that holds no material: was the map filtered?");
        return Err(Error::format(name, raster.place(i), reason));
    }
    // 2c − 127 is 127 times the component, and odd.
    let v = Vec3::from_array(color.map(|c| f32::from(2 * i16::from(c & 127) - 127)));
    Ok((Normal::new_or(v, Normal::Z), 2 * r + g))
}
