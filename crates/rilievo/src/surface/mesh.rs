//! Indexed triangle meshes (contract; the owner of this folder completes it).
use crate::{Error, Result};
use glam::{Vec2, Vec3, Vec4};

/// The raw arrays of a mesh, as a file has them; [`Mesh::new`] checks them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshParts {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex normals; empty if unknown (they are computed).
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v down from the top row; empty if there are none.
    pub uvs: Vec<Vec2>,
    /// Counter-clockwise triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// A checked triangle mesh: finite positions, unit normals, valid indices, no degenerate triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    tangents: Vec<Vec4>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Checks and completes.
    ///
    /// # Errors
    /// x
    pub fn new(parts: MeshParts) -> Result<Self> {
        if parts.triangles.is_empty() {
            return Err(Error::Missing { what: "triangles", remedy: "give a mesh with faces" });
        }
        Ok(Self {
            positions: parts.positions,
            normals: parts.normals,
            uvs: parts.uvs,
            tangents: vec![],
            triangles: parts.triangles,
        })
    }
    /// Vertex positions in object space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }
    /// Unit vertex normals.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }
    /// Texture coordinates; empty if there are none.
    pub fn uvs(&self) -> &[Vec2] {
        &self.uvs
    }
    /// MikkTSpace tangents, xyz unit and w = ±1 (bitangent = w · cross(normal, tangent)); empty until `with_tangents`.
    pub fn tangents(&self) -> &[Vec4] {
        &self.tangents
    }
    /// Triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }
    /// The same mesh with MikkTSpace tangents; vertices are split where tangents differ. A no-op if there already.
    ///
    /// # Errors
    /// x
    pub fn with_tangents(self) -> Result<Self> {
        Ok(self)
    }
    /// Centre of the bounding box and radius of the sphere about it that holds all vertices.
    pub fn bounding_sphere(&self) -> (Vec3, f32) {
        (Vec3::ZERO, 1.0)
    }
}
