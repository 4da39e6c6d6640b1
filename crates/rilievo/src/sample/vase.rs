//! The built-in sample: a Greek vase (contract; the owner of this folder completes it).
use crate::height::HeightMap;
use crate::surface::{Mesh, MeshParts};
use crate::{Grid, MaterialMap, Result, Rgba8};

/// The material number of the clay.
pub const CLAY: u8 = 0;
/// The material number of the black glaze.
pub const GLAZE: u8 = 1;

/// The maps of the vase, all of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct VaseMaps {
    /// Engraved ornament and brush relief.
    pub height: HeightMap,
    /// [`CLAY`] or [`GLAZE`].
    pub materials: MaterialMap,
    /// sRGB base colour.
    pub color: Grid<Rgba8>,
}

/// The low-poly mesh with UVs: u once around, v down from lip to foot.
///
/// # Errors
/// x
pub fn mesh(segments: u32) -> Result<Mesh> {
    let _ = segments;
    Mesh::new(MeshParts::default())
}

/// Maps of `width` × `width / 2` (or another fitting aspect) texels.
///
/// # Errors
/// x
pub fn maps(width: u32) -> Result<VaseMaps> {
    let h = width / 2;
    Ok(VaseMaps {
        height: HeightMap::new(Grid::filled(width, h, 0.5)?, 0.01)?,
        materials: Grid::filled(width, h, CLAY)?,
        color: Grid::filled(width, h, Rgba8::default())?,
    })
}
