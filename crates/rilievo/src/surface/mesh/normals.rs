//! Vertex normals weighted by corner angles (Thürmer and Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets").

use glam::{DVec3, Vec3};

use super::angle::angle_of;
use super::{area_vector, corners};
use crate::{Normal, Object};

/// Below this share of the weights, a sum of unit normals is what is left of opposite faces, not a direction: the
/// positions themselves are known to 6e-8 only.
const CANCELLED: f64 = 1e-6;

/// Makes `normals` one unit normal per vertex: normalises those that have a direction, computes the others.
pub(super) fn complete(normals: &mut Vec<Vec3>, positions: &[Vec3], triangles: &[[u32; 3]]) {
    for n in normals.iter_mut() {
        *n = Normal::<Object>::new(*n).map_or(Vec3::NAN, Normal::vec);
    }
    normals.resize(positions.len(), Vec3::NAN);
    if normals.iter().all(|n| n.is_finite()) {
        return;
    }
    // Sums in f64 and in the order of the triangles: the same bits whatever the number of threads elsewhere.
    let mut sums = vec![(DVec3::ZERO, 0.0f64); positions.len()];
    for triangle in triangles {
        let corner = corners(positions, triangle);
        let face = face_normal(corner);
        for k in 0..3 {
            let (out, back) = (corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
            let angle = angle_of(out.cross(back).length(), out.dot(back));
            let (sum, weight) = &mut sums[triangle[k] as usize];
            *sum += face * angle;
            *weight += angle;
        }
    }
    let mut cancelled = 0usize;
    for (normal, &(sum, weight)) in normals.iter_mut().zip(&sums).filter(|(n, _)| !n.is_finite()) {
        let length = sum.length();
        if weight == 0.0 {
            *normal = Vec3::Z; // of no triangle; any unit vector will do
        } else if length > CANCELLED * weight {
            *normal = (sum / length).as_vec3();
        } else {
            cancelled += 1;
        }
    }
    if cancelled == 0 {
        return;
    }
    for triangle in triangles {
        for &i in triangle {
            if !normals[i as usize].is_finite() {
                normals[i as usize] = face_normal(corners(positions, triangle)).as_vec3();
            }
        }
    }
}

/// The unit normal of a triangle that has an area.
fn face_normal(corners: [DVec3; 3]) -> DVec3 {
    let n = area_vector(corners);
    n / n.length()
}

#[cfg(test)]
mod tests {
    use super::super::{Mesh, MeshParts};
    use super::*;

    fn fan(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> MeshParts {
        MeshParts { positions, triangles, ..MeshParts::default() }
    }

    #[test]
    fn cube_corner_does_not_depend_on_the_diagonals() {
        // Three faces at the origin; one of them is cut through that corner, so it holds two of the four triangles.
        let p = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 0.0)];
        let mesh = Mesh::new(fan(p, vec![[0, 4, 1], [0, 2, 4], [0, 3, 2], [0, 1, 3]])).unwrap();
        assert!(mesh.normals()[0].distance(Vec3::splat(-1.0 / 3.0f32.sqrt())) < 1e-6, "{}", mesh.normals()[0]);
    }

    #[test]
    fn opposite_windings_do_not_cancel() {
        let p = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh::new(fan(p, vec![[0, 1, 2], [0, 2, 1]])).unwrap();
        assert_eq!(mesh.normals(), [Vec3::Z; 3]);
    }

    #[test]
    fn given_normals_are_repaired_one_by_one() {
        let p = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
        let normals = vec![Vec3::X * 1e-30, Vec3::ZERO, Vec3::NAN, Vec3::ZERO];
        let mesh = Mesh::new(MeshParts { normals, ..fan(p, vec![[0, 1, 2]]) }).unwrap();
        assert_eq!(mesh.normals(), [Vec3::X, Vec3::Z, Vec3::Z, Vec3::Z]);
    }
}
