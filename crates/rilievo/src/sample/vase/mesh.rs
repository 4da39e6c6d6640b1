//! The low-poly vase.

use glam::{Vec2, Vec3};

use super::handle;
use super::layout::map_length;
use super::profile::{PIECES, Point, Profile};
use crate::sample::turn;
use crate::surface::{Mesh, MeshParts};
use crate::{Error, Result};

/// Faces around the vase that give a smooth outline at a low price: 1200 triangles in all.
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
    handle::add(&mut parts, strip[0], strip[1], share(6).max(4), share(8).max(3));
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

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(mesh: &Mesh, t: [u32; 3]) -> [Vec3; 3] {
        t.map(|i| mesh.positions()[i as usize])
    }

    #[test]
    fn default_is_low_poly_centred_and_two_high() {
        let mesh = mesh(DEFAULT_SEGMENTS).unwrap();
        assert_eq!(mesh.triangles().len(), 1200);
        let (low, high) = mesh.positions().iter().fold((Vec3::MAX, Vec3::MIN), |(l, h), &p| (l.min(p), h.max(p)));
        assert!(low.y == -1.0 && high.y > 0.97 && high.y < 1.01, "{low} {high}");
        assert!((low.x + high.x).abs() < 1e-5 && (low.z + high.z).abs() < 1e-5, "{low} {high}");
    }

    #[test]
    fn faces_look_out_and_normals_agree() {
        // The volume of the turned profile, as a stack of cones; the mouth counts as outside.
        let points: Vec<Point> = (0..PIECES.len()).flat_map(|i| Profile::get().cut(i, 100)).collect();
        let cone = |w: &[Point]| {
            let [r0, r1, y0, y1] = [w[0].radius, w[1].radius, w[0].y, w[1].y].map(f64::from);
            (y0 - y1) * (r0 * r0 + r0 * r1 + r1 * r1) * std::f64::consts::FRAC_PI_3
        };
        let full: f64 = points.windows(2).map(cone).sum();
        for segments in [3, 7, 24, 50] {
            let mesh = mesh(segments).unwrap();
            let mut volume = 0.0;
            let mut worst = 1.0f32;
            for &t in mesh.triangles() {
                let [a, b, c] = corners(&mesh, t);
                volume += a.dot(b.cross(c)) / 6.0;
                let face = (b - a).cross(c - a).normalize();
                for i in t {
                    let n = mesh.normals()[i as usize];
                    assert!((n.length() - 1.0).abs() < 1e-5);
                    worst = worst.min(face.dot(n));
                }
            }
            // Few segments cut corners; the handles add less than a hundredth.
            let share = f64::from(volume) / full;
            let expected = if segments < 10 { 0.3..0.9 } else { 0.95..1.02 };
            assert!(expected.contains(&share), "{segments}: {volume} of {full}");
            // The flat straps of the handles have few sides and flared ends.
            let expected = if segments < 10 { 0.2 } else { 0.5 };
            assert!(worst > expected, "{segments}: a normal is {} degrees off its face", worst.acos().to_degrees());
        }
    }

    #[test]
    fn texture_runs_right_and_down_inside_the_map() {
        let mesh = mesh(DEFAULT_SEGMENTS).unwrap();
        assert!(mesh.uvs().iter().all(|uv| uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all()));
        for &t in mesh.triangles() {
            // Counter-clockwise seen from outside, so clockwise with v down unless the map is mirrored.
            let [a, b, c] = t.map(|i| mesh.uvs()[i as usize]);
            assert!((b - a).perp_dot(c - a) < 0.0, "{t:?} is mirrored or empty on the map");
        }
        // u = 1/2 faces +Z and 3/4 +X.
        for (p, uv) in mesh.positions().iter().zip(mesh.uvs()).filter(|(_, uv)| uv.y > 0.2 && uv.y < 0.8) {
            let angle = std::f32::consts::TAU * (uv.x - 0.5);
            let around = Vec2::new(p.x, p.z).normalize();
            assert!((around - Vec2::new(angle.sin(), angle.cos())).length() < 1e-5, "{p} {uv}");
        }
    }

    #[test]
    fn every_edge_has_two_faces_but_at_the_handles_ends() {
        // By position: creases and the seam split vertices, not the surface.
        let mesh = mesh(DEFAULT_SEGMENTS).unwrap();
        let mut edges = std::collections::HashMap::new();
        let key = |p: Vec3| [p.x, p.y, p.z].map(|x| (x * 1e5).round() as i64);
        for &t in mesh.triangles() {
            let c = corners(&mesh, t).map(key);
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                *edges.entry((c[a], c[b])).or_insert(0) += 1;
                *edges.entry((c[b], c[a])).or_insert(0) -= 1;
            }
        }
        let open = edges.values().filter(|&&n| n > 0).count();
        assert_eq!(open, 2 * 2 * 6, "two ends of two handles with six sides, hidden in the wall");
    }

    #[test]
    fn tangents_point_along_u() {
        let mesh = mesh(DEFAULT_SEGMENTS).unwrap().with_tangents().unwrap();
        let body =
            mesh.positions().iter().zip(mesh.tangents()).zip(mesh.uvs()).filter(|(_, uv)| uv.y > 0.3 && uv.y < 0.8);
        let mut checked = 0;
        for ((p, t), uv) in body {
            let right = Vec3::new(p.z, 0.0, -p.x).normalize();
            assert!(t.truncate().dot(right) > 0.97 && t.w == 1.0, "{p} {t} {uv}");
            checked += 1;
        }
        assert!(checked > 200);
    }

    #[test]
    fn segments_out_of_range_are_refused() {
        assert!(mesh(2).is_err() && mesh(4097).is_err());
    }
}
