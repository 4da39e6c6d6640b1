//! MikkTSpace tangents (Mikkelsen 2008), and the vertices split where they differ.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, Ops, TangentSpace};
use glam::{Vec3, Vec4};

use super::{Mesh, angle};
use crate::{Error, Normal, Object, Result};

/// How many corners may meet in one point.
///
/// MikkTSpace walks round a vertex by recursion and compares each of its faces with each other, so a hostile fan of a
/// million triangles would exhaust the stack or the day. The reference implementation has the same limits, unwritten.
const MAX_CORNERS_AT_A_POINT: u32 = 4096;

/// One tangent per corner, three per triangle in order.
pub(super) fn per_corner(mesh: &Mesh) -> Result<Vec<Option<Vec4>>> {
    check_fans(mesh)?;
    let largest = mesh.positions.iter().fold(0.0f32, |m, p| m.max(p.abs().max_element()));
    let mut work = Work { mesh, scale: power_of_two_below(largest).recip(), tangents: Vec::new() };
    work.tangents.resize(mesh.triangles.len() * 3, None);
    let Ok(()) = bevy_mikktspace::generate_tangents(&mut work) else {
        return Err(Error::parameter("texture coordinates", "unusable", "coordinates that MikkTSpace accepts"));
    };
    Ok(work.tangents)
}

fn check_fans(mesh: &Mesh) -> Result<()> {
    let mut corners = vec![0u32; mesh.positions.len()];
    for &i in mesh.triangles.iter().flatten() {
        corners[i as usize] += 1;
    }
    let mut at_point = HashMap::with_capacity(corners.len());
    for (p, count) in mesh.positions.iter().zip(corners) {
        // + 0.0 makes −0 and 0 the same point.
        let sum = at_point.entry((*p + 0.0).to_array().map(f32::to_bits)).or_insert(0u32);
        *sum += count;
        if *sum > MAX_CORNERS_AT_A_POINT {
            let expected = format!("at most {MAX_CORNERS_AT_A_POINT} for tangents; split the fan");
            return Err(Error::parameter("number of corners that meet in one point", *sum, expected));
        }
    }
    Ok(())
}

/// The largest power of two that is not above a positive `x`; 1 for 0.
fn power_of_two_below(x: f32) -> f64 {
    if x > 0.0 { f64::from_bits(f64::from(x).to_bits() & 0x7ff0_0000_0000_0000) } else { 1.0 }
}

/// The mesh as MikkTSpace reads it.
struct Work<'a> {
    mesh: &'a Mesh,
    /// A power of two that brings the positions to about 1: exact, and MikkTSpace's absolute thresholds (it takes
    /// 1e-38 for zero, after squaring) then neither delete tiny meshes nor overflow on huge ones.
    scale: f64,
    tangents: Vec<Option<Vec4>>,
}

impl Work<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry<IeeeOps> for Work<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        (self.mesh.positions[self.vertex(face, corner)].as_dvec3() * self.scale).as_vec3().to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    /// MikkTSpace's bitangent follows its second coordinate. Ours has to point up the picture, against v, hence the
    /// sign (not 1 − v, which rounds).
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.mesh.uvs[self.vertex(face, corner)];
        [uv.x, -uv.y]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[face * 3 + corner] = space.and_then(|space| {
            let [x, y, z, w] = space.tangent_encoded();
            // Degenerate texture coordinates come out as zero or NaN.
            Some(Normal::<Object>::new(Vec3::new(x, y, z))?.vec().extend(w))
        });
    }
}

/// What MikkTSpace needs of a mathematical library, without one.
struct IeeeOps;

impl Ops for IeeeOps {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        angle::acos(f64::from(x)) as f32
    }
}

const END: u32 = u32::MAX;

/// Gives each vertex the tangent of its corners, and a copy of itself for each further tangent.
pub(super) fn split(mesh: &mut Mesh, corner_tangents: &[Option<Vec4>]) -> Result<()> {
    let given = mesh.positions.len();
    let mut tangents: Vec<Option<Vec4>> = vec![None; given];
    // The copies of a vertex, as a chain through this list.
    let mut next_copy = vec![END; given];
    for (slot, tangent) in mesh.triangles.iter_mut().flatten().zip(corner_tangents) {
        // A corner without a tangent of its own takes any that its vertex has or gets.
        let Some(tangent) = tangent else { continue };
        let mut i = *slot as usize;
        loop {
            match tangents[i] {
                None => {
                    tangents[i] = Some(*tangent);
                    break;
                }
                Some(t) if t == *tangent => break,
                Some(_) if next_copy[i] != END => i = next_copy[i] as usize,
                Some(_) => {
                    let copy = u32::try_from(tangents.len()).ok().filter(|&n| n != END);
                    let copy = copy.ok_or_else(|| Error::parameter("number of vertices", "2^32", "fewer"))?;
                    next_copy[i] = copy;
                    next_copy.push(END);
                    tangents.push(Some(*tangent));
                    mesh.positions.push(mesh.positions[*slot as usize]);
                    mesh.normals.push(mesh.normals[*slot as usize]);
                    mesh.uvs.push(mesh.uvs[*slot as usize]);
                    i = copy as usize;
                    break;
                }
            }
        }
        *slot = i as u32;
    }
    let fallback = |n: &Vec3| n.any_orthonormal_vector().extend(1.0);
    mesh.tangents = tangents.iter().zip(&mesh.normals).map(|(t, n)| t.unwrap_or_else(|| fallback(n))).collect();
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::super::MeshParts;
    use super::super::tests::quad;
    use super::*;

    fn finite_frames(mesh: &Mesh) {
        assert_eq!(mesh.tangents().len(), mesh.positions().len());
        for (t, n) in mesh.tangents().iter().zip(mesh.normals()) {
            let xyz = t.truncate();
            assert!((xyz.length() - 1.0).abs() < 1e-5 && t.w.abs() == 1.0 && xyz.dot(*n).abs() < 1e-5, "{t} {n}");
        }
    }

    #[test]
    fn plane_points_right_and_up() {
        // Row 0 of the picture on top: u to the right (+X), the picture's up is +Y.
        let mesh = Mesh::new(quad()).unwrap().with_tangents().unwrap();
        assert_eq!(mesh.positions().len(), 4);
        for i in 0..4 {
            let frame = mesh.vertex_frame(i).unwrap();
            assert_eq!((frame.tangent, frame.bitangent, frame.normal), (Vec3::X, Vec3::Y, Vec3::Z));
            assert_eq!(mesh.tangents()[i].w, 1.0);
        }
        assert_eq!(mesh.clone().with_tangents().unwrap(), mesh);
    }

    #[test]
    fn mirrored_picture_still_points_up() {
        let mut parts = quad();
        for uv in &mut parts.uvs {
            uv.x = 1.0 - uv.x;
        }
        let mesh = Mesh::new(parts).unwrap().with_tangents().unwrap();
        let frame = mesh.vertex_frame(0).unwrap();
        assert_eq!((frame.tangent, frame.bitangent), (-Vec3::X, Vec3::Y));
        assert_eq!(mesh.tangents()[0].w, -1.0);
    }

    #[test]
    fn mirror_seam_splits_its_vertices_only() {
        // Two quads side by side that share the picture's right edge, mirrored.
        let x = |i: usize| [-1.0, 0.0, 1.0][i % 3];
        let positions: Vec<_> = (0..6).map(|i| Vec3::new(x(i), if i < 3 { 1.0 } else { 0.0 }, 0.0)).collect();
        let uvs = positions.iter().map(|p| Vec2::new(1.0 - p.x.abs(), 1.0 - p.y)).collect();
        let triangles = vec![[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]];
        let mesh = Mesh::new(MeshParts { positions, normals: vec![], uvs, triangles }).unwrap();
        let mesh = mesh.with_tangents().unwrap();
        finite_frames(&mesh);
        assert_eq!(mesh.positions().len(), 8);
        for (k, triangle) in mesh.triangles().iter().enumerate() {
            for &i in triangle {
                let frame = mesh.vertex_frame(i as usize).unwrap();
                let right = if k < 2 { Vec3::X } else { -Vec3::X };
                assert_eq!((frame.tangent, frame.bitangent), (right, Vec3::Y), "{k}");
            }
        }
    }

    #[test]
    fn degenerate_uvs_get_some_frame() {
        for uvs in [
            vec![Vec2::splat(0.25); 4],
            vec![Vec2::splat(f32::MAX), Vec2::splat(-f32::MAX), Vec2::ZERO, Vec2::X],
            vec![Vec2::ZERO, Vec2::X * 1e-40, Vec2::Y * 1e-40, Vec2::ONE],
        ] {
            finite_frames(&Mesh::new(MeshParts { uvs, ..quad() }).unwrap().with_tangents().unwrap());
        }
        let bare = Mesh::new(MeshParts { uvs: vec![], ..quad() }).unwrap();
        assert!(matches!(bare.with_tangents(), Err(Error::Missing { what: "texture coordinates", .. })));
    }

    #[test]
    fn scale_does_not_change_tangents() {
        for scale in [2.0f32.powi(-120), 2.0f32.powi(-20), 2.0f32.powi(100)] {
            let mut parts = quad();
            for p in &mut parts.positions {
                *p *= scale;
            }
            let mesh = Mesh::new(parts).unwrap().with_tangents().unwrap();
            assert!(mesh.tangents().iter().all(|t| *t == Vec4::new(1.0, 0.0, 0.0, 1.0)), "{scale}");
        }
    }

    fn fan(blades: u32) -> Mesh {
        let rim = |i: u32| {
            let (sin, cos) = (f64::from(i) / f64::from(blades) * std::f64::consts::TAU).sin_cos();
            Vec3::new(cos as f32, sin as f32, 0.0)
        };
        let positions: Vec<_> = std::iter::once(Vec3::ZERO).chain((0..blades).map(rim)).collect();
        let uvs = positions.iter().map(|p| p.truncate()).collect();
        let triangles = (0..blades).map(|i| [0, 1 + i, 1 + (i + 1) % blades]).collect();
        Mesh::new(MeshParts { positions, normals: vec![], uvs, triangles }).unwrap()
    }

    #[test]
    fn fans_are_bounded() {
        // The widest that is accepted must fit the stack of a test's thread.
        let mesh = fan(MAX_CORNERS_AT_A_POINT).with_tangents().unwrap();
        assert_eq!(mesh.positions().len() as u32, MAX_CORNERS_AT_A_POINT + 1);
        finite_frames(&mesh);
        assert!(matches!(fan(MAX_CORNERS_AT_A_POINT + 1).with_tangents(), Err(Error::Parameter { .. })));
    }
}
