//! Indexed triangle meshes, checked once.

mod angle;
mod normals;
mod tangents;

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::Frame;
use crate::{Error, Result};

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
///
/// - **Space:** object; right-handed, counter-clockwise front faces, texture v down from the top row.
/// - **Determinism:** the same bits on every machine and thread count; angles come from IEEE operations, not from libm.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    tangents: Vec<Vec4>,
    triangles: Vec<[u32; 3]>,
    dropped_triangles: usize,
    /// Wanted every frame, and it takes all vertices.
    sphere: (Vec3, f32),
}

impl Mesh {
    /// Checks and completes.
    ///
    /// Triangles without an area (see [`Self::dropped_triangles`]) are left out, the others keep their order; vertices
    /// are kept as they are. Given normals are normalised; those that have no direction, and all that are missing, are
    /// computed from the faces, weighted by the angle of each corner (Thürmer and Wüthrich 1998), shared by vertex. Where
    /// faces of opposite winding cancel, the normal is that of the vertex's first face. A vertex of no triangle gets +Z.
    ///
    /// # Errors
    /// - [`Error::Missing`] if there are no triangles (a mesh of triangles without an area is valid, and invisible);
    /// - [`Error::Length`] if normals or texture coordinates are neither empty nor one per vertex;
    /// - [`Error::NotFinite`] for a position or texture coordinate that is NaN or infinite;
    /// - [`Error::IndexRange`] for a triangle of a vertex that does not exist.
    pub fn new(parts: MeshParts) -> Result<Self> {
        let MeshParts { positions, mut normals, uvs, mut triangles } = parts;
        if triangles.is_empty() {
            return Err(Error::Missing { what: "triangles", remedy: "give a mesh with faces" });
        }
        for (what, actual) in [("vertex normals", normals.len()), ("texture coordinates", uvs.len())] {
            if actual != 0 && actual != positions.len() {
                return Err(Error::Length { what, expected: positions.len(), actual });
            }
        }
        if let Some(index) = positions.iter().position(|p| !p.is_finite()) {
            return Err(Error::NotFinite { what: "vertex position", index });
        }
        if let Some(index) = uvs.iter().position(|uv| !uv.is_finite()) {
            return Err(Error::NotFinite { what: "texture coordinate", index });
        }
        for (at, triangle) in triangles.iter().enumerate() {
            if let Some(&index) = triangle.iter().find(|&&i| i as usize >= positions.len()) {
                let (index, len) = (u64::from(index), positions.len());
                return Err(Error::IndexRange { what: "vertex index of triangle", at, index, len });
            }
        }
        let given = triangles.len();
        triangles.retain(|t| !is_degenerate(corners(&positions, t)));
        normals::complete(&mut normals, &positions, &triangles);
        let dropped_triangles = given - triangles.len();
        let sphere = if triangles.is_empty() {
            sphere_about(positions.iter().copied())
        } else {
            sphere_about(triangles.iter().flatten().map(|&i| positions[i as usize]))
        };
        Ok(Self { positions, normals, uvs, tangents: Vec::new(), triangles, dropped_triangles, sphere })
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

    /// MikkTSpace tangents, xyz unit and w = ±1 (bitangent = w · cross(normal, tangent), up the picture); empty until
    /// [`Self::with_tangents`].
    pub fn tangents(&self) -> &[Vec4] {
        &self.tangents
    }

    /// Triangles, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// How many triangles [`Self::new`] left out because they have no area: a corner twice, or three in a line.
    ///
    /// The measure is relative to the triangle's own edges, so neither tiny meshes nor remote ones lose faces.
    pub fn dropped_triangles(&self) -> usize {
        self.dropped_triangles
    }

    /// The same mesh with MikkTSpace tangents; vertices are split where tangents differ. A no-op if there already.
    ///
    /// The tangent points along +u and the bitangent up the picture (−v), so that +Y ("gl") normal maps apply as they are:
    /// the convention of glTF. Existing vertices keep their numbers, triangles their order; the vertices that were split
    /// off come last. Where the texture coordinates have no area, the tangent is some unit vector at right angles to the normal.
    ///
    /// - **Source:** Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"; the reference implementation's grouping.
    ///
    /// # Errors
    /// [`Error::Missing`] if the mesh has no texture coordinates; [`Error::Parameter`] if more corners than
    /// MikkTSpace's quadratic grouping can bear meet in one point, or if splitting needs more than 2³² vertices.
    pub fn with_tangents(mut self) -> Result<Self> {
        if !self.tangents.is_empty() {
            return Ok(self);
        }
        if self.uvs.is_empty() {
            let remedy = "give a mesh that is unwrapped (OBJ vt, PLY s and t, glTF TEXCOORD_0)";
            return Err(Error::Missing { what: "texture coordinates", remedy });
        }
        let corner_tangents = tangents::per_corner(&self)?;
        tangents::split(&mut self, &corner_tangents)?;
        Ok(self)
    }

    /// The frame of a vertex; `None` until [`Self::with_tangents`], or past the last vertex.
    pub fn vertex_frame(&self, vertex: usize) -> Option<Frame> {
        Some(Frame::from_mikk(*self.normals.get(vertex)?, *self.tangents.get(vertex)?))
    }

    /// The frame all vertices share, as on a flat sheet with one orientation of its texture; `None` if they differ by
    /// more than rounding, or before [`Self::with_tangents`].
    ///
    /// Only then can a tangent-space map be shaded by table.
    pub fn constant_frame(&self) -> Option<Frame> {
        /// Largest difference of a component that is still rounding.
        const TOLERANCE: f32 = 1e-4;
        let (&normal, &tangent) = (self.normals.first()?, self.tangents.first()?);
        let same_normal = self.normals.iter().all(|n| n.abs_diff_eq(normal, TOLERANCE));
        let same_tangent = self.tangents.iter().all(|t| t.abs_diff_eq(tangent, TOLERANCE));
        (same_normal && same_tangent).then(|| Frame::from_mikk(normal, tangent))
    }

    /// Centre of the bounding box and radius of the sphere about it, of all vertices that triangles use (of all there are
    /// if no triangle has an area). The radius is positive.
    pub fn bounding_sphere(&self) -> (Vec3, f32) {
        self.sphere
    }
}

/// Centre of the bounding box of some points, and the radius about it that holds them.
fn sphere_about(points: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    /// Of a single point: large enough for a camera to stand off it.
    const SMALLEST: f32 = 1e-30;
    let low = points.clone().fold(Vec3::INFINITY, Vec3::min).as_dvec3();
    let high = points.clone().fold(Vec3::NEG_INFINITY, Vec3::max).as_dvec3();
    let center = ((low + high) * 0.5).as_vec3();
    let squared = points.map(|p| (p.as_dvec3() - center.as_dvec3()).length_squared()).fold(0.0, f64::max);
    // Rounded up, so that the sphere does hold them.
    (center, (squared.sqrt() as f32).next_up().clamp(SMALLEST, f32::MAX))
}

/// The corners of a triangle in f64: edges between them are then exact for all but absurd ranges, and so areas of
/// tiny, huge and remote triangles neither underflow, overflow nor vanish.
fn corners(positions: &[Vec3], triangle: &[u32; 3]) -> [DVec3; 3] {
    triangle.map(|i| positions[i as usize].as_dvec3())
}

/// Normal of a triangle, as long as twice its area; the rounding error does not depend on which corner is named first.
fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    let edges = [c - b, a - c, b - a];
    let lengths = edges.map(DVec3::length_squared);
    // The product of the two shortest edges: that of a needle's long ones would be rounding error only.
    let longest = if lengths[0] >= lengths[1].max(lengths[2]) {
        0
    } else if lengths[1] >= lengths[2] {
        1
    } else {
        2
    };
    edges[(longest + 1) % 3].cross(edges[(longest + 2) % 3])
}

/// Whether no normal is left of a triangle: its area is lost in the rounding of the product of its two shortest edges.
///
/// A threshold in units of length or area would delete the faces of a mesh modelled in another unit.
fn is_degenerate([a, b, c]: [DVec3; 3]) -> bool {
    let mut edges = [a.distance(b), b.distance(c), c.distance(a)];
    edges.sort_by(f64::total_cmp);
    // `>` is false for 0 > 0 too: two corners in one place.
    let has_area = area_vector([a, b, c]).length() > 1e-14 * edges[0] * edges[1];
    !has_area
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn quad() -> MeshParts {
        MeshParts {
            positions: vec![
                Vec3::new(-0.5, 0.5, 0.0),
                Vec3::new(0.5, 0.5, 0.0),
                Vec3::new(0.5, -0.5, 0.0),
                Vec3::new(-0.5, -0.5, 0.0),
            ],
            normals: vec![],
            uvs: vec![Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0)],
            triangles: vec![[0, 3, 2], [0, 2, 1]],
        }
    }

    #[test]
    fn lengths_must_match() {
        let short_normals = MeshParts { normals: vec![Vec3::Z; 3], ..quad() };
        assert!(matches!(Mesh::new(short_normals), Err(Error::Length { expected: 4, actual: 3, .. })));
        let long_uvs = MeshParts { uvs: vec![Vec2::ZERO; 5], ..quad() };
        assert!(matches!(Mesh::new(long_uvs), Err(Error::Length { expected: 4, actual: 5, .. })));
    }

    #[test]
    fn bad_numbers_are_named() {
        let mut parts = quad();
        parts.positions[2].y = f32::NAN;
        assert_eq!(Mesh::new(parts), Err(Error::NotFinite { what: "vertex position", index: 2 }));
        let mut parts = quad();
        parts.uvs[3].x = f32::INFINITY;
        assert_eq!(Mesh::new(parts), Err(Error::NotFinite { what: "texture coordinate", index: 3 }));
        let mut parts = quad();
        parts.triangles[1][2] = 4;
        assert!(matches!(Mesh::new(parts), Err(Error::IndexRange { at: 1, index: 4, len: 4, .. })));
        assert!(matches!(Mesh::new(MeshParts::default()), Err(Error::Missing { .. })));
    }

    #[test]
    fn degenerate_triangles_are_counted_and_left_out() {
        let mut parts = quad();
        parts.positions.push(Vec3::ZERO); // the middle of a diagonal
        parts.positions.push(Vec3::new(-0.5, 0.5, 0.0)); // a copy of vertex 0
        parts.uvs.extend([Vec2::splat(0.5), Vec2::ZERO]);
        parts.triangles = vec![[0, 0, 1], [0, 3, 2], [0, 4, 2], [0, 5, 1], [0, 2, 1]];
        let mesh = Mesh::new(parts).unwrap();
        assert_eq!((mesh.dropped_triangles(), mesh.triangles()), (3, &[[0, 3, 2], [0, 2, 1]][..]));
        let flat = MeshParts { triangles: vec![[0, 0, 1], [2, 2, 2]], ..quad() };
        let flat = Mesh::new(flat).unwrap();
        assert_eq!((flat.dropped_triangles(), flat.triangles().len()), (2, 0));
        let (center, radius) = flat.bounding_sphere();
        assert!(center.is_finite() && radius > 0.0);
    }

    #[test]
    fn no_scale_or_offset_deletes_faces() {
        for scale in [1e-30f32, 1e-6, 1.0, 1e6, 1e30] {
            for offset in [0.0f32, 10.0 * scale, -1e4 * scale] {
                let mut parts = quad();
                for p in &mut parts.positions {
                    *p = *p * scale + Vec3::splat(offset);
                }
                let mesh = Mesh::new(parts).unwrap();
                assert_eq!(mesh.dropped_triangles(), 0, "{scale} {offset}");
                assert!(mesh.normals().iter().all(|n| n.distance(Vec3::Z) < 1e-6), "{scale} {offset}");
            }
        }
        // One step of the float grid on each side is still a triangle.
        let ulp = 1.0; // of 1e7
        let parts = MeshParts {
            positions: [Vec3::ZERO, Vec3::X * ulp, Vec3::Y * ulp].map(|p| p + 1e7).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..MeshParts::default()
        };
        assert_eq!(Mesh::new(parts).unwrap().dropped_triangles(), 0);
        // A needle has an area, however thin.
        let parts = MeshParts {
            positions: vec![Vec3::ZERO, Vec3::X * 1e-20, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..MeshParts::default()
        };
        for triangle in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            let mesh = Mesh::new(MeshParts { triangles: vec![triangle], ..parts.clone() }).unwrap();
            assert_eq!(mesh.normals(), [Vec3::Z; 3]);
        }
    }

    #[test]
    fn sphere_holds_the_used_vertices_only() {
        let mut parts = quad();
        parts.positions.push(Vec3::splat(1e6));
        parts.uvs.push(Vec2::ZERO);
        let (center, radius) = Mesh::new(parts).unwrap().bounding_sphere();
        assert_eq!(center, Vec3::ZERO);
        assert!((radius - 0.5f32.sqrt()).abs() < 1e-6);
    }
}
