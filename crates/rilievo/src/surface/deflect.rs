//! Maps bent onto meshes (contract; the owner of this folder completes it).
use super::Mesh;
use crate::height::{Filter, HeightMap};
use crate::{Edges, Grid, Normal, NormalMap, Object, Progress, Result, Tangent};

/// An object-space normal map made on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Deflected {
    /// The normals; gutter texels are dilated from their neighbours, the rest is +Z.
    pub normals: NormalMap<Object>,
    /// Which texels lie on a triangle (true) and which are gutter or nothing.
    pub covered: Grid<bool>,
    /// Texels that more than one triangle claims (overlapping UVs).
    pub overlaps: u64,
}

/// Tangent-space normal map → object space.
///
/// # Errors
/// x
pub fn deflect_normals(
    mesh: &Mesh,
    map: &NormalMap<Tangent>,
    size: (u32, u32),
    gutter: u32,
    progress: &dyn Progress,
) -> Result<Deflected> {
    let _ = (mesh, map, gutter, progress);
    Ok(Deflected {
        normals: Grid::filled(size.0, size.1, Normal::Z)?,
        covered: Grid::filled(size.0, size.1, false)?,
        overlaps: 0,
    })
}

/// Height map → object space, by the surface gradient.
///
/// # Errors
/// x
pub fn deflect_heights(
    mesh: &Mesh,
    map: &HeightMap,
    filter: Filter,
    edges: Edges,
    size: (u32, u32),
    gutter: u32,
    progress: &dyn Progress,
) -> Result<Deflected> {
    let _ = (mesh, map, filter, edges, gutter, progress);
    Ok(Deflected {
        normals: Grid::filled(size.0, size.1, Normal::Z)?,
        covered: Grid::filled(size.0, size.1, false)?,
        overlaps: 0,
    })
}
