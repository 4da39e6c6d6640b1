//! How long interpolated vectors are, over the pixels of a mesh.

use glam::{DVec2, DVec3};
use rilievo::Object;
use rilievo::fill::Triangle;
use rilievo::light::Light;
use rilievo::raster::vectors::{Field, Interpolation, Sides, Vertices};
use rilievo::surface::{Camera, Mesh};

/// Deviations from unit length, of L' and H' alike; 0.01 is a hundredth too long or too short.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LengthStats {
    /// Mean of the absolute deviations.
    pub mean: f64,
    /// Largest absolute deviation.
    pub max: f64,
    /// How many vectors were looked at.
    pub vectors: u64,
}

/// Over all pixel centres in front faces of a mesh that lies wholly in the picture, `side` × `side` pixels.
///
/// The mesh needs tangents and stands at the world's origin. Hidden faces count as well.
pub fn length_stats(mesh: &Mesh, camera: &Camera, light: Light<Object>, how: Interpolation, side: u32) -> LengthStats {
    let view_projection = camera.view_projection(1.0).as_dmat4();
    let to_screen = |p: DVec3| {
        let ndc = view_projection.project_point3(p);
        DVec2::new(ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5) * f64::from(side)
    };
    let lights = [light];
    let vertices = Vertices::new(mesh, &lights, camera.eye());
    let viewer = vertices.viewer(0);
    let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut stats = LengthStats::default();
    for &triangle in mesh.triangles() {
        let corners = triangle.map(|v| to_screen(mesh.positions()[v as usize].as_dvec3()));
        let Some(shape) = Triangle::new(corners).filter(|shape| !shape.is_clockwise()) else { continue };
        let sides = Sides { first: (corners[1] - corners[0]).as_vec2(), second: (corners[2] - corners[0]).as_vec2() };
        let lit = vertices.triangle(triangle, &whole, 0);
        let Some(field) = Field::new(how, (&lit.corners, &lit.vectors), &sides, &viewer, 1.0) else { continue };
        shape.for_each_pixel(0..side, 0..side, |x, y, _| {
            let p = (DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - corners[0]).as_vec2();
            let at = field.at(p.x, p.y);
            for vector in [at.light, at.half] {
                let deviation = (f64::from(vector.length()) - 1.0).abs();
                stats.mean += deviation;
                stats.max = stats.max.max(deviation);
                stats.vectors += 1;
            }
        });
    }
    stats.mean /= stats.vectors.max(1) as f64;
    stats
}
