//! Interpolated light vectors: what interpolation costs by scan lines, and how true its pictures are.

mod cost;
mod truth;

use crate::report::Report;
use anyhow::Result;
use glam::Vec3;
use rilievo::LinearRgb;
use rilievo::light::{Light, Lighting};
use rilievo::raster::vectors::{Interpolation, Midpoints, Order};
use rilievo::raster::{Detail, Object, Scene};
use rilievo::surface::{Camera, Mesh, shapes};

/// Width and height of the pictures.
const SIDE: u32 = 1024;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    cost::run(rounds, report)?;
    truth::run(report)
}

/// A quadratic method on all triangles.
const fn quadratic(midpoints: Midpoints) -> Interpolation {
    Interpolation::Quadratic { midpoints, order: Order::Quadratic }
}

/// A torus of 2 · `n` · `n` triangles.
fn torus(n: u32) -> Result<Mesh> {
    Ok(shapes::torus(n, n, 1.0, 0.45)?.with_tangents()?)
}

/// The torus from the given side, lit by a lamp at the upper right of the eye.
fn scene<'a>(object: Object<'a>, elevation: f32, azimuth: f32) -> Result<Scene<'a>> {
    let camera = Camera::orbit(object.mesh.bounding_sphere(), azimuth, elevation, 1.02, 0.97, 1.0)?;
    let ahead = camera.eye().normalize();
    let right = Vec3::Y.cross(ahead).normalize();
    let up = ahead.cross(right);
    let lamp = Light::point(camera.eye() + right * 2.0 + up * 3.0, LinearRgb::WHITE);
    Ok(Scene { objects: vec![object], lighting: Lighting::new(LinearRgb::gray(0.08), vec![lamp]), camera })
}

/// The mesh alone.
fn bare(mesh: &Mesh) -> Object<'_> {
    Object::new(mesh, Detail::Smooth, &[])
}
