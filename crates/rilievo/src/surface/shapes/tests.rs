use glam::{DVec2, DVec3};

use super::*;

fn shapes() -> Vec<(&'static str, Mesh)> {
    vec![
        ("plane", plane(1.5).unwrap()),
        ("plane_grid", plane_grid(0.7, 5, 3).unwrap()),
        ("cube", cube(CubeUvs::EachFace).unwrap()),
        ("cube atlas", cube(CubeUvs::Atlas).unwrap()),
        ("sphere", sphere(16, 9).unwrap()),
        ("smallest sphere", sphere(3, 2).unwrap()),
        ("torus", torus(16, 9, 1.0, 0.4).unwrap()),
        ("smallest torus", torus(3, 3, 1.0, 0.4).unwrap()),
    ]
}

/// Positions, texture coordinates and normals of the corners of triangle `t`.
fn corners(mesh: &Mesh, t: [u32; 3]) -> ([DVec3; 3], [DVec2; 3], [DVec3; 3]) {
    let at = |i: u32| i as usize;
    (
        t.map(|i| mesh.positions()[at(i)].as_dvec3()),
        t.map(|i| mesh.uvs()[at(i)].as_dvec2()),
        t.map(|i| mesh.normals()[at(i)].as_dvec3()),
    )
}

#[test]
fn front_faces_are_counter_clockwise_and_textures_are_not_mirrored() {
    for (name, mesh) in shapes() {
        for &t in mesh.triangles() {
            let (p, uv, n) = corners(&mesh, t);
            let face = (p[1] - p[0]).cross(p[2] - p[0]);
            for n in n {
                assert!((n.length() - 1.0).abs() < 1e-6, "{name}");
                assert!(face.dot(n) > 0.0, "{name}: a face looks inwards");
            }
            // Counter-clockwise from outside and u right, v down: clockwise in (u, v) read as (right, up).
            let (a, b) = (uv[1] - uv[0], uv[2] - uv[0]);
            assert!(a.x * b.y - a.y * b.x < 0.0, "{name}: the texture is mirrored");
        }
    }
}

#[test]
fn closed_shapes_have_every_edge_twice_in_position() {
    use std::collections::HashMap;
    for (name, mesh) in shapes().into_iter().filter(|(name, _)| !name.starts_with("plane")) {
        let key = |i: u32| mesh.positions()[i as usize].to_array().map(|c| (c + 0.0).to_bits());
        let mut edges: HashMap<_, i32> = HashMap::new();
        for t in mesh.triangles() {
            for k in 0..3 {
                let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
                let (edge, way) = if a < b { ((a, b), 1) } else { ((b, a), -1) };
                assert_ne!(a, b, "{name}");
                *edges.entry(edge).or_default() += way;
            }
        }
        assert!(edges.values().all(|&sum| sum == 0), "{name}: the seam gapes");
        // Euler: V − E + F = 2 (sphere, cube) or 0 (torus).
        let vertices: std::collections::HashSet<_> = (0..mesh.positions().len() as u32).map(key).collect();
        let euler = vertices.len() as i64 - edges.len() as i64 + mesh.triangles().len() as i64;
        assert_eq!(euler, if name.ends_with("torus") { 0 } else { 2 }, "{name}");
    }
}

#[test]
fn textures_fill_the_square_exactly_once() {
    for (name, mesh) in shapes() {
        let area: f64 = mesh
            .triangles()
            .iter()
            .map(|&t| {
                let (_, uv, _) = corners(&mesh, t);
                ((uv[1] - uv[0]).perp_dot(uv[2] - uv[0]) * 0.5).abs()
            })
            .sum();
        // The triangles at a pole leave out half their cells: the other half would have no area on the sphere.
        let expected = match name {
            "cube" => 6.0,
            "cube atlas" => (1.0 - 2.0 * f64::from(CUBE_ATLAS_MARGIN)).powi(2),
            "sphere" => 1.0 - 1.0 / 9.0,
            "smallest sphere" => 0.5,
            _ => 1.0,
        };
        assert!((area - expected).abs() < 1e-5, "{name}: {area}");
    }
}

/// The vertices at texture coordinates (u, v).
fn at_uv(mesh: &Mesh, u: f32, v: f32) -> Vec<Vec3> {
    let near = |p: &Vec2| (*p - Vec2::new(u, v)).length() < 1e-6;
    mesh.uvs().iter().zip(mesh.positions()).filter(|(uv, _)| near(uv)).map(|(_, p)| *p).collect()
}

fn assert_at(mesh: &Mesh, (u, v): (f32, f32), expected: Vec3) {
    let found = at_uv(mesh, u, v);
    assert!(!found.is_empty(), "no vertex at ({u}, {v})");
    for p in found {
        assert!((p - expected).length() < 1e-6, "({u}, {v}): {p}, not {expected}");
    }
}

#[test]
fn a_world_map_lies_on_the_sphere_as_on_a_globe() {
    let mesh = sphere(8, 4).unwrap();
    assert_at(&mesh, (0.5, 0.5), Vec3::Z);
    assert_at(&mesh, (0.75, 0.5), Vec3::X); // 90° east
    assert_at(&mesh, (0.25, 0.5), Vec3::NEG_X);
    assert_at(&mesh, (0.0, 0.5), Vec3::NEG_Z);
    assert_at(&mesh, (1.0, 0.5), Vec3::NEG_Z);
    assert_at(&mesh, (0.5, 0.25), Vec3::new(0.0, 0.5f32.sqrt(), 0.5f32.sqrt()));
    assert_at(&mesh, (0.5625, 0.0), Vec3::Y);
    assert_at(&mesh, (0.5625, 1.0), Vec3::NEG_Y);
    assert_eq!(mesh.positions().iter().filter(|p| **p == Vec3::Y).count(), 8);
}

#[test]
fn torus_has_its_seam_inside_and_the_papers_sizes() {
    let mesh = torus(16, 8, 1.0, 0.25).unwrap();
    assert_at(&mesh, (0.5, 0.5), Vec3::new(0.0, 0.0, 1.25));
    assert_at(&mesh, (0.75, 0.25), Vec3::new(1.0, 0.25, 0.0));
    assert_at(&mesh, (0.5, 0.0), Vec3::new(0.0, 0.0, 0.75));
    assert_at(&mesh, (0.5, 1.0), Vec3::new(0.0, 0.0, 0.75));
    for (segments, sides, triangles) in [(16, 9, 288), (16, 16, 512), (20, 20, 800)] {
        assert_eq!(torus(segments, sides, 1.0, 0.4).unwrap().triangles().len(), triangles);
    }
}

#[test]
fn plane_is_upright_and_keeps_its_aspect() {
    let mesh = plane(2.0).unwrap();
    assert_at(&mesh, (0.0, 0.0), Vec3::new(-0.5, 0.25, 0.0));
    assert_at(&mesh, (1.0, 1.0), Vec3::new(0.5, -0.25, 0.0));
}

#[test]
fn cube_faces_are_upright_and_atlas_cells_stay_apart() {
    let mesh = cube(CubeUvs::EachFace).unwrap();
    for &t in mesh.triangles() {
        let (p, uv, n) = corners(&mesh, t);
        if n[0].y == 0.0 {
            (0..3).for_each(|k| assert!((p[k].y - (0.5 - uv[k].y)).abs() < 1e-6));
        }
    }
    let atlas = cube(CubeUvs::Atlas).unwrap();
    let mut cells = [0; 6];
    for quad in atlas.uvs().chunks_exact(4) {
        let centre = quad.iter().sum::<Vec2>() / 4.0 * Vec2::from(CUBE_ATLAS_REPEAT);
        cells[centre.x as usize + 3 * centre.y as usize] += 1;
        assert!((centre.fract() - 0.5).length() < 1e-6);
        for uv in quad {
            let inside = (*uv * Vec2::from(CUBE_ATLAS_REPEAT) - centre).abs() - 0.5 + CUBE_ATLAS_MARGIN;
            assert!(inside.max_element().abs() < 1e-6);
        }
    }
    assert_eq!(cells, [1; 6]);
}

#[test]
fn impossible_shapes_are_refused() {
    for aspect in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-45] {
        assert!(plane(aspect).is_err(), "{aspect}");
    }
    assert!(plane_grid(1.0, 0, 1).is_err());
    assert!(sphere(2, 2).is_err() && sphere(3, 1).is_err());
    assert!(sphere(u32::MAX, u32::MAX).is_err());
    assert!(torus(3, 2, 1.0, 0.5).is_err());
    assert!(torus(3, 3, 0.5, 0.5).is_err() && torus(3, 3, f32::NAN, 0.5).is_err() && torus(3, 3, 1.0, 0.0).is_err());
}
