//! A bumpy torus under a lamp.

use glam::{Vec2, Vec3};
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Light, Lighting, Material};
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::raster::{Detail, Object, Scene};
use rilievo::surface::{Camera, Mesh, shapes};
use rilievo::{Edges, Grid, LinearRgb, Tangent};

/// Elevation and azimuth of the eye, in radians.
pub(crate) const VIEWS: [[f32; 2]; 3] = [[0.85, 0.4], [0.35, 1.3], [1.25, -0.7]];

/// A torus of 2 · `n` · `n` triangles.
pub(crate) fn torus(n: u32) -> Mesh {
    shapes::torus(n, n, 1.0, 0.45).unwrap().with_tangents().unwrap()
}

/// A relief of waves and scratches that tiles.
pub(crate) fn bumps() -> NormalLevels<Tangent> {
    let side = 256;
    let wave = |x: u32, y: u32, a: f32, b: f32| {
        let turn = std::f32::consts::TAU / side as f32;
        (turn * (a * x as f32 + b * y as f32)).sin()
    };
    let height = Grid::from_fn(side, side, |x, y| {
        0.5 + 0.2 * wave(x, y, 3.0, 2.0) + 0.12 * wave(x, y, -5.0, 7.0) + 0.05 * wave(x, y, 17.0, -11.0)
    });
    let map = HeightMap::new(height.unwrap(), 0.05).unwrap();
    normal_levels(to_normals(&map, Filter::Plane4, Edges::Wrap), None, None).unwrap()
}

pub(crate) fn materials() -> [Material; 1] {
    [Material::blinn_phong(LinearRgb::new(0.75, 0.45, 0.3), LinearRgb::gray(0.5), 32.0)]
}

pub(crate) fn object<'a>(mesh: &'a Mesh, bumps: &'a NormalLevels<Tangent>, materials: &'a [Material]) -> Object<'a> {
    let detail = Detail::Tangent { normals: &bumps.normals, repeat: Vec2::new(4.0, 2.0), materials: None };
    Object::new(mesh, detail, materials)
}

/// Seen from one of the views, with a lamp above and to the right of the eye.
pub(crate) fn scene<'a>(object: Object<'a>, [elevation, azimuth]: [f32; 2]) -> Scene<'a> {
    let camera = Camera::orbit(object.mesh.bounding_sphere(), azimuth, elevation, 1.02, 0.97, 1.0).unwrap();
    let ahead = camera.eye().normalize();
    let right = Vec3::Y.cross(ahead).normalize();
    let lamp = Light::point(camera.eye() + right * 2.0 + ahead.cross(right) * 3.0, LinearRgb::WHITE);
    Scene { objects: vec![object], lighting: Lighting::new(LinearRgb::gray(0.08), vec![lamp]), camera }
}
