//! The cube, and where its faces lie in the texture.

use glam::{Vec2, Vec3};

use super::{Vertex, lattice};
use crate::error::Result;
use crate::surface::{Mesh, MeshParts};

/// Where the six faces of [`cube`] lie in the texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CubeUvs {
    /// Each face shows the whole texture. The faces overlap in the texture, so no object-space map fits.
    #[default]
    EachFace,
    /// Each face has a cell of its own in 3 × 2 (top row −X +Z +X, bottom row +Y −Z −Y), less a margin.
    ///
    /// A map repeated [`CUBE_ATLAS_REPEAT`] times over the texture lies once on each face, cropped by the margin.
    Atlas,
}

/// The part of a cell of [`CubeUvs::Atlas`] that is left free on each of its sides.
///
/// Without it, filtering and mip levels would mix faces that do not meet on the cube; 1/64 leaves 8 texels each side in
/// cells of 512, so that levels 0 to 3 stay apart.
pub const CUBE_ATLAS_MARGIN: f32 = 1.0 / 64.0;

/// How often a map must repeat over the texture to lie once in each cell of [`CubeUvs::Atlas`].
pub const CUBE_ATLAS_REPEAT: [f32; 2] = [3.0, 2.0];

/// A face: its outward normal, the direction of u (up is normal × right), and its column and row in the atlas.
struct Face {
    normal: Vec3,
    right: Vec3,
    cell: [f32; 2],
}

/// Sides are upright; the top continues the front (+Z) upwards and the bottom continues it downwards.
const FACES: [Face; 6] = [
    Face { normal: Vec3::NEG_X, right: Vec3::Z, cell: [0.0, 0.0] },
    Face { normal: Vec3::Z, right: Vec3::X, cell: [1.0, 0.0] },
    Face { normal: Vec3::X, right: Vec3::NEG_Z, cell: [2.0, 0.0] },
    Face { normal: Vec3::Y, right: Vec3::X, cell: [0.0, 1.0] },
    Face { normal: Vec3::NEG_Z, right: Vec3::NEG_X, cell: [1.0, 1.0] },
    Face { normal: Vec3::NEG_Y, right: Vec3::X, cell: [2.0, 1.0] },
];

/// A cube of side 1, centred, with flat faces of two triangles each.
///
/// # Errors
/// Never in practice: the shape is fixed, but every mesh passes the same checks.
pub fn cube(uvs: CubeUvs) -> Result<Mesh> {
    let mut parts = MeshParts::default();
    for face in &FACES {
        let up = face.normal.cross(face.right);
        lattice(&mut parts, 1, 1, |u, v| {
            let uv = match uvs {
                CubeUvs::EachFace => Vec2::new(u, v),
                CubeUvs::Atlas => {
                    let inside = Vec2::splat(CUBE_ATLAS_MARGIN) + Vec2::new(u, v) * (1.0 - 2.0 * CUBE_ATLAS_MARGIN);
                    (Vec2::from(face.cell) + inside) / Vec2::from(CUBE_ATLAS_REPEAT)
                }
            };
            let position = face.normal * 0.5 + face.right * (u - 0.5) + up * (0.5 - v);
            Vertex { position, normal: face.normal, uv }
        });
    }
    Mesh::new(parts)
}
