//! The vase as geometry: so many triangles that it needs no bump map.

use std::collections::HashMap;

use anyhow::Result;
use glam::{Vec2, Vec3};
use rilievo::Edges;
use rilievo::height::HeightMap;
use rilievo::sample::vase;
use rilievo::surface::{Mesh, MeshParts};

/// The vase of about (`segments` / 24)² · 1200 triangles with its relief as geometry: no texture, smooth normals.
///
/// Vertices in one place become one, so that the surface stays closed where the texture has seams.
pub(crate) fn dense(segments: u32, relief: &HeightMap) -> Result<Mesh> {
    let smooth = vase::mesh(segments)?;
    let width = width_of_map(&smooth);
    // The mean of the relief lies on the mesh.
    let heights = relief.heights();
    let mean = heights.texels().iter().sum::<f32>() / heights.texels().len() as f32;
    let scale = relief.depth() * width;
    let mut number = HashMap::new();
    let (mut positions, mut sums) = (Vec::new(), Vec::<(Vec3, f32, f32)>::new());
    let mut joined = Vec::with_capacity(smooth.positions().len());
    for (i, &p) in smooth.positions().iter().enumerate() {
        let index = *number.entry(p.to_array().map(f32::to_bits)).or_insert_with(|| {
            positions.push(p);
            sums.push((Vec3::ZERO, 0.0, 0.0));
            positions.len() as u32 - 1
        });
        let (normal, height, count) = &mut sums[index as usize];
        *normal += smooth.normals()[i];
        *height += height_at(relief, smooth.uvs()[i]) - mean;
        *count += 1.0;
        joined.push(index);
    }
    for (p, (normal, height, count)) in positions.iter_mut().zip(sums) {
        *p += normal.normalize_or_zero() * (scale * height / count);
    }
    let triangles = smooth.triangles().iter().map(|t| t.map(|i| joined[i as usize])).collect();
    Ok(Mesh::new(MeshParts { positions, normals: vec![], uvs: vec![], triangles })?)
}

/// Length of the map's width on the mesh: the mean of |∂P/∂u| over its area.
fn width_of_map(mesh: &Mesh) -> f32 {
    let (mut sum, mut total) = (0.0, 0.0);
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
        let [ua, ub, uc] = t.map(|i| mesh.uvs()[i as usize]);
        let (p1, p2, t1, t2) = (b - a, c - a, ub - ua, uc - ua);
        let determinant = t1.perp_dot(t2);
        let area = p1.cross(p2).length();
        if determinant != 0.0 {
            sum += ((p1 * t2.y - p2 * t1.y) / determinant).length() * area;
            total += area;
        }
    }
    if total > 0.0 { sum / total } else { 0.0 }
}

/// The relief between texel centres, wrapped.
fn height_at(relief: &HeightMap, uv: Vec2) -> f32 {
    let (width, height) = relief.heights().size();
    let p = uv * Vec2::new(width as f32, height as f32) - 0.5;
    let (first, part) = (p.floor(), p - p.floor());
    let at = |dx: i64, dy: i64| {
        let x = Edges::Wrap.resolve(first.x as i64 + dx, width);
        let y = Edges::Wrap.resolve(first.y as i64 + dy, height);
        relief.heights()[(x, y)]
    };
    let row = |dy: i64| at(0, dy) * (1.0 - part.x) + at(1, dy) * part.x;
    row(0) * (1.0 - part.y) + row(1) * part.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::Grid;

    #[test]
    fn an_even_relief_changes_nothing_and_the_number_of_faces_is_known() {
        let flat = HeightMap::new(Grid::filled(64, 48, 0.3).unwrap(), 0.1).unwrap();
        let mesh = dense(48, &flat).unwrap();
        assert!((4000..5000).contains(&mesh.triangles().len()), "{}", mesh.triangles().len());
        let same = vase::mesh(48).unwrap();
        let place = |m: &Mesh| m.positions().iter().fold(Vec3::ZERO, |s, p| s.max(p.abs()));
        assert!((place(&mesh) - place(&same)).length() < 1e-5);
        assert!(mesh.positions().len() < same.positions().len());
    }

    #[test]
    fn heights_are_read_between_texels_and_across_the_border() {
        let ramp = HeightMap::new(Grid::from_fn(4, 1, |x, _| x as f32).unwrap(), 0.1).unwrap();
        assert_eq!(height_at(&ramp, Vec2::new(0.5, 0.5)), 1.5);
        assert_eq!(height_at(&ramp, Vec2::new(0.0, 0.5)), 1.5);
        assert_eq!(height_at(&ramp, Vec2::new(0.125, 0.2)), 0.0);
    }
}
