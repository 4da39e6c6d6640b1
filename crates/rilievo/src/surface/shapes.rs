//! Built-in shapes (contract; the owner of this folder completes it).
use super::{Mesh, MeshParts};
use crate::Result;
/// A plane in x, y facing +Z, width 1, centred.
///
/// # Errors
/// x
pub fn plane(aspect: f32) -> Result<Mesh> {
    let _ = aspect;
    Mesh::new(MeshParts::default())
}
/// A cube of side 1, each face the whole texture.
///
/// # Errors
/// x
pub fn cube() -> Result<Mesh> {
    Mesh::new(MeshParts::default())
}
/// A unit sphere.
///
/// # Errors
/// x
pub fn sphere(segments: u32, rings: u32) -> Result<Mesh> {
    let _ = (segments, rings);
    Mesh::new(MeshParts::default())
}
/// A torus about the Y axis.
///
/// # Errors
/// x
pub fn torus(segments: u32, sides: u32, major_radius: f32, minor_radius: f32) -> Result<Mesh> {
    let _ = (segments, sides, major_radius, minor_radius);
    Mesh::new(MeshParts::default())
}
