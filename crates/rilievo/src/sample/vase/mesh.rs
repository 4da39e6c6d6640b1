//! The low-poly vase.

use glam::{Vec2, Vec3};

use super::handle;
use super::layout::map_length;
use super::profile::{PIECES, Point, Profile};
use super::turn;
use crate::surface::{Mesh, MeshParts};
use crate::{Error, Result};

/// Faces around the vase that give a smooth outline at a low price: about a thousand triangles in all.
pub const DEFAULT_SEGMENTS: u32 = 24;

/// The vase as a low-poly mesh: a surface of revolution about +Y and two handles at ±X, 2 high, centred.
///
/// `segments` faces go around; rings along the profile and faces of the handles keep in proportion. Normals are the
/// profile's own, with creases where it has corners. Texture coordinates fit [`super::maps`]: u runs once around, to
/// the right seen from outside, with its seam at −Z; v runs down from the bottom of the mouth over the lip to the foot by
/// arc length (the inside and the underside get less); the handles have islands of their own at the bottom of the map.
///
/// # Errors
/// [`Error::Parameter`] unless `segments` is 3 to 4096.
pub fn mesh(segments: u32) -> Result<Mesh> {
    if !(3..=4096).contains(&segments) {
        return Err(Error::parameter("segments", segments, "3 to 4096"));
    }
    let share = |faces: u32| ((faces * segments + DEFAULT_SEGMENTS / 2) / DEFAULT_SEGMENTS).max(1);
    let mut parts = MeshParts::default();
    let profile = Profile::get();
    for (index, piece) in PIECES.iter().enumerate() {
        let points: Vec<Point> = profile.cut(index, share(piece.rings)).collect();
        for pair in points.windows(2) {
            add_ring(&mut parts, pair[0], pair[1], segments);
        }
    }
    let strip = [profile.length() / map_length(), 1.0];
    handle::add(&mut parts, strip[0], strip[1], share(5).max(4), share(9).max(3));
    Mesh::new(weld(parts))
}

/// One ring of faces; triangles only where it ends on the axis.
fn add_ring(parts: &mut MeshParts, top: Point, bottom: Point, segments: u32) {
    let vertex = |parts: &mut MeshParts, p: Point, u: f32| {
        // The seam's two columns stand at the very same place.
        let around = if u < 1.0 { u } else { 0.0 };
        let (sin, cos) = turn::sin_cos(f64::from(around) - 0.5);
        parts.positions.push(Vec3::new(p.radius * sin, p.y, p.radius * cos));
        parts.normals.push(Vec3::new(p.normal[0] * sin, p.normal[1], p.normal[0] * cos));
        parts.uvs.push(Vec2::new(u, p.s / map_length()));
        parts.positions.len() as u32 - 1
    };
    for j in 0..segments {
        let (u0, u1) = (j as f32 / segments as f32, (j + 1) as f32 / segments as f32);
        let middle = 0.5 * (u0 + u1);
        if top.radius <= 0.0 {
            let face = [(top, middle), (bottom, u0), (bottom, u1)].map(|(p, u)| vertex(parts, p, u));
            parts.triangles.push(face);
        } else if bottom.radius <= 0.0 {
            let face = [(top, u0), (bottom, middle), (top, u1)].map(|(p, u)| vertex(parts, p, u));
            parts.triangles.push(face);
        } else {
            let [a, b, c, d] = [(top, u0), (top, u1), (bottom, u0), (bottom, u1)].map(|(p, u)| vertex(parts, p, u));
            parts.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
}

/// Joins vertices that are the same in every attribute, in order of first use.
fn weld(parts: MeshParts) -> MeshParts {
    let mut seen = std::collections::HashMap::new();
    let mut out = MeshParts::default();
    for triangle in parts.triangles {
        let joined = triangle.map(|i| {
            let i = i as usize;
            let (p, n, uv) = (parts.positions[i], parts.normals[i], parts.uvs[i]);
            let key = [p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y].map(f32::to_bits);
            *seen.entry(key).or_insert_with(|| {
                out.positions.push(p);
                out.normals.push(n);
                out.uvs.push(uv);
                out.positions.len() as u32 - 1
            })
        });
        out.triangles.push(joined);
    }
    out
}
