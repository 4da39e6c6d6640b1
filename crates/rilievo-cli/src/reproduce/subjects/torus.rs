//! The bumpy torus of Hast et al., and the ways its light vectors are interpolated.

use std::f32::consts::TAU;

use anyhow::Result;
use glam::{Vec2, Vec3};
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Light, Lighting, Material};
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::raster::vectors::{Interpolation, Midpoints, Order};
use rilievo::raster::{Detail, Method, Object, Scene};
use rilievo::surface::{Camera, Mesh, MeshParts, shapes};
use rilievo::{Edges, Grid, LinearRgb, Tangent};

/// Elevation and azimuth of the eye, in radians: from above, nearly from the side, nearly from the top.
pub(crate) const VIEWS: [[f32; 2]; 3] = [[0.85, 0.4], [0.35, 1.3], [1.25, -0.7]];

/// How the relief repeats around the axis and around the tube.
const REPEAT: Vec2 = Vec2::new(4.0, 2.0);
/// Height of the relief as a share of its width.
const DEPTH: f32 = 0.05;
/// Where the lamp stands, to the right of the eye and above it.
const LAMP: [f32; 2] = [2.0, 3.0];

/// A way to interpolate.
pub(crate) struct Way {
    /// As the page calls it.
    pub(crate) name: &'static str,
    /// As keys call it.
    pub(crate) key: &'static str,
    pub(crate) how: Interpolation,
}

/// All ways, the papers' first.
pub(crate) const METHODS: [Way; 5] = [
    Way { name: "linear", key: "linear", how: Interpolation::Linear },
    Way { name: "normalised", key: "normalised", how: Interpolation::Normalized },
    Way { name: "quadratic, new frames", key: "quadratic_new_frames", how: quadratic(Midpoints::NewFrames) },
    Way { name: "quadratic, averaged vectors", key: "quadratic_averaged", how: quadratic(Midpoints::AveragedVectors) },
    Way { name: "quadratic, orthogonal frames", key: "quadratic_gram_schmidt", how: quadratic(Midpoints::GramSchmidt) },
];

/// Quadratic on all triangles, as in the paper.
pub(crate) const fn quadratic(midpoints: Midpoints) -> Interpolation {
    Interpolation::Quadratic { midpoints, order: Order::Quadratic }
}

impl Way {
    /// The renderer's name of it.
    pub(crate) fn method(&self) -> Method {
        match self.how {
            Interpolation::Linear => Method::Linear,
            Interpolation::Normalized => Method::Normalized,
            Interpolation::Quadratic { midpoints, order } => Method::Quadratic { midpoints, order },
        }
    }
}

/// A torus with its relief.
pub(crate) struct Torus {
    mesh: Mesh,
    bumps: NormalLevels<Tangent>,
    materials: [Material; 1],
}

impl Torus {
    /// Of 2 · `n` · `n` triangles, under a relief `side` texels wide.
    pub(crate) fn new(n: u32, side: u32) -> Result<Self> {
        let materials = [Material::blinn_phong(LinearRgb::new(0.75, 0.45, 0.3), LinearRgb::gray(0.5), 32.0)];
        Ok(Self { mesh: shapes::torus(n, n, 1.0, 0.45)?.with_tangents()?, bumps: bumps(side)?, materials })
    }

    /// The mesh, with tangents.
    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// With its relief, under the lamp.
    pub(crate) fn scene(&self, view: [f32; 2]) -> Result<Scene<'_>> {
        let detail = Detail::Tangent { normals: &self.bumps.normals, repeat: REPEAT, materials: None };
        scene(Object::new(&self.mesh, detail, &self.materials), view)
    }

    /// The mesh alone: what the scan-line stages walk.
    pub(crate) fn bare_scene(&self, view: [f32; 2]) -> Result<Scene<'_>> {
        scene(Object::new(&self.mesh, Detail::Smooth, &[]), view)
    }

    /// The polygons, each with its own normal.
    pub(crate) fn flat_scene<'a>(&'a self, flat: &'a Mesh, view: [f32; 2]) -> Result<Scene<'a>> {
        scene(Object::new(flat, Detail::Smooth, &self.materials), view)
    }
}

/// A mesh whose faces share no vertex, so that each is as flat as it is.
pub(crate) fn flat_shaded(mesh: &Mesh) -> Result<Mesh> {
    let corners = || mesh.triangles().iter().flatten().map(|&i| i as usize);
    let positions: Vec<Vec3> = corners().map(|i| mesh.positions()[i]).collect();
    let uvs = if mesh.uvs().is_empty() { vec![] } else { corners().map(|i| mesh.uvs()[i]).collect() };
    let triangles = (0..mesh.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Ok(Mesh::new(MeshParts { positions, normals: vec![], uvs, triangles })?)
}

fn scene<'a>(object: Object<'a>, [elevation, azimuth]: [f32; 2]) -> Result<Scene<'a>> {
    let camera = Camera::orbit(object.mesh.bounding_sphere(), azimuth, elevation, 1.02, 0.97, 1.0)?;
    let ahead = camera.eye().normalize();
    let right = Vec3::Y.cross(ahead).normalize();
    let lamp = camera.eye() + right * LAMP[0] + ahead.cross(right) * LAMP[1];
    let lighting = Lighting::new(LinearRgb::gray(0.08), vec![Light::point(lamp, LinearRgb::WHITE)]);
    Ok(Scene { objects: vec![object], lighting, camera })
}

/// A relief of waves that tiles, with its normals.
fn bumps(side: u32) -> Result<NormalLevels<Tangent>> {
    let wave = |x: u32, y: u32, a: f32, b: f32| (TAU / side as f32 * (a * x as f32 + b * y as f32)).sin();
    let height = Grid::from_fn(side, side, |x, y| {
        0.5 + 0.2 * wave(x, y, 3.0, 2.0) + 0.12 * wave(x, y, -5.0, 7.0) + 0.05 * wave(x, y, 17.0, -11.0)
    })?;
    let map = HeightMap::new(height, DEPTH)?;
    Ok(normal_levels(to_normals(&map, Filter::Plane4, Edges::Wrap), None, None)?)
}
