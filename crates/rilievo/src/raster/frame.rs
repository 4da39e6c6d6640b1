//! The work of a frame before a pixel is touched: lighting tables, checking that maps fit.

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::mip::MipChain;
use crate::polar::BumpFrame;
use crate::raster::reference::{Baked, Exact, Interpolated, Polar, Table};
use crate::raster::scene::{Detail, Method, Object, Scene};
use crate::raster::texture::TextureFilter;
use crate::raster::vectors::Interpolation;

/// The shading of one object for one frame.
pub(super) enum Shading<'a> {
    Table(Table<'a>),
    Exact(Exact<'a>),
    Interpolated(Interpolated<'a>),
    Static(Baked<'a>),
    Polar(Polar<'a>),
}

/// A scene whose tables are lit: ready to be drawn, as often as wanted.
pub struct Frame<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) shadings: Vec<Shading<'a>>,
    pub(super) filter: TextureFilter,
}

/// Lights the shade tables and takes lights and eye to object space.
///
/// # Errors
/// [`Error::Missing`] where an object lacks what its map or the method needs, [`Error::IndexRange`] if a map names a
/// material that is not there.
pub fn prepare<'a>(scene: &'a Scene<'a>, method: Method, filter: TextureFilter) -> Result<Frame<'a>> {
    let shadings = scene.objects.iter().map(|object| shading(scene, object, method)).collect::<Result<_>>()?;
    Ok(Frame { scene, shadings, filter })
}

/// The shading of one object of a scene.
pub(super) fn shading<'a>(scene: &Scene<'_>, object: &'a Object<'a>, method: Method) -> Result<Shading<'a>> {
    check(object)?;
    let lighting = scene.lighting.to_object(&object.pose);
    let eye = object.pose.point_to_object(scene.camera.eye());
    let interpolated = |how, lighting| Interpolated::new(how, object, lighting, eye).map(Shading::Interpolated);
    match method {
        Method::Table => Ok(Shading::Table(Table::new(object, &lighting, eye)?)),
        Method::Exact => Ok(Shading::Exact(Exact::new(object, lighting, eye)?)),
        Method::Static => Ok(Shading::Static(Baked::new(object)?)),
        Method::Polar { unit, width } => Polar::new((unit, width), object, lighting, eye).map(Shading::Polar),
        Method::Linear => interpolated(Interpolation::Linear, lighting),
        Method::Normalized => interpolated(Interpolation::Normalized, lighting),
        Method::Quadratic { midpoints, order } => interpolated(Interpolation::Quadratic { midpoints, order }, lighting),
    }
}

pub(super) fn check(object: &Object<'_>) -> Result<()> {
    let textured = object.base_color.is_some() || !matches!(object.detail, Detail::Smooth);
    if textured && object.mesh.uvs().is_empty() {
        let remedy = "maps need a mesh with UVs; unwrap it first";
        return Err(Error::Missing { what: "texture coordinates", remedy });
    }
    let in_texture = match object.detail {
        Detail::Tangent { .. } => true,
        Detail::Bump { map, .. } => map.frame() == BumpFrame::Texture,
        _ => false,
    };
    if in_texture && object.mesh.tangents().is_empty() {
        let remedy = "a tangent-space map needs a mesh with tangents (Mesh::with_tangents)";
        return Err(Error::Missing { what: "tangents", remedy });
    }
    let highest = match object.detail {
        Detail::Smooth => 0,
        // Lit already: materials play no part.
        Detail::Baked(_) => return Ok(()),
        Detail::Tangent { normals, materials, .. } => highest_material(normals, materials)?,
        Detail::Object { normals, materials } => highest_material(normals, materials)?,
        Detail::Bump { map, materials, .. } => highest_material(map.words(), materials)?,
        Detail::Indexed(map) => map.table().spans().last().map_or(0, |s| s.material),
    };
    if usize::from(highest) >= object.materials.len() {
        let len = object.materials.len();
        return Err(Error::IndexRange { what: "highest material", at: 0, index: highest.into(), len });
    }
    Ok(())
}

/// The highest material number of a map; checks that the material levels fit the normal levels.
fn highest_material<T>(normals: &MipChain<T>, materials: Option<&MipChain<u8>>) -> Result<u8> {
    let Some(materials) = materials else { return Ok(0) };
    normals.base().expect_same_size("the material map", materials.base())?;
    if normals.levels().len() != materials.levels().len() {
        let (expected, actual) = (normals.levels().len(), materials.levels().len());
        return Err(Error::Length { what: "mip levels of the material map", expected, actual });
    }
    Ok(materials.levels().iter().flat_map(Grid::texels).copied().max().unwrap_or(0))
}
