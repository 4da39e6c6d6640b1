//! Interpolation alone: setup, inner loops and depth, without texture, lighting and colour.

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::raster::reference::{ScreenTriangle, set_up};
use crate::raster::scanline::difference::{OnEdge, OnRow, Walk};
use crate::raster::scanline::packed::{self, Packed, PackedNormalized};
use crate::raster::scanline::place::Place;
use crate::raster::scene::{Object, Scene};
use crate::raster::vectors::{Field, Interpolation, Linear, Rotated, ToNormalized, Vertices};

/// What is done for a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Vertices are transformed and triangles clipped, and that is all: the empty loop of the source.
    Empty,
    /// Edges are walked and depths compared.
    Depth,
    /// The same, and vectors are interpolated.
    Interpolate(Interpolation),
}

/// Interpolates the vectors of the first light over all visible pixels of a scene, and forgets them.
///
/// `depth` has to hold the depths to compare with, 1 at the far plane; it gets those of what is nearer. Returned is the sum
/// of all components at the pixels that passed, which says nothing but cannot be had without the work.
///
/// - **Source:** Table 2: only the setup, the computation in the two inner loops, and the Z buffer.
///
/// # Errors
/// [`Error::Missing`] if there is no light or an object's mesh has no tangents.
pub fn interpolate(scene: &Scene<'_>, stage: Stage, depth: &mut Grid<f32>) -> Result<f32> {
    if scene.lighting.lights.is_empty() {
        return Err(Error::Missing { what: "light", remedy: "vectors point to a light; add one" });
    }
    let mut sum = 0.0;
    for object in &scene.objects {
        if object.mesh.tangents().is_empty() {
            let remedy = "vectors are turned into tangent frames (Mesh::with_tangents)";
            return Err(Error::Missing { what: "tangents", remedy });
        }
        let triangles = set_up(object, scene, depth.size());
        sum += match stage {
            Stage::Empty => triangles.iter().map(|t| t.vertices[0] as f32).sum(),
            Stage::Depth => triangles.iter().map(|t| triangle_sum(Nothing, t, &Place::new(&t.shape), depth)).sum(),
            Stage::Interpolate(how) => object_sum(object, scene, &triangles, how, depth),
        };
    }
    Ok(sum)
}

fn object_sum(
    object: &Object<'_>,
    scene: &Scene<'_>,
    triangles: &[ScreenTriangle],
    how: Interpolation,
    depth: &mut Grid<f32>,
) -> f32 {
    let lighting = scene.lighting.to_object(&object.pose);
    let eye = object.pose.point_to_object(scene.camera.eye());
    let vertices = Vertices::new(object.mesh, &lighting.lights[..1], eye);
    let viewer = vertices.viewer(0);
    let shininess = object.highest_shininess();
    let mut sum = 0.0;
    for triangle in triangles {
        let lit = vertices.triangle(triangle.vertices, &triangle.corners.map(|c| c.weights), 0);
        let place = Place::new(&triangle.shape);
        let field = Field::new(how, (&lit.corners, &lit.vectors), &place.sides, &viewer, shininess);
        sum += match field {
            Some(Field::Linear(f)) => triangle_sum(packed::linear(&f), triangle, &place, depth),
            Some(Field::Normalized(f)) => triangle_sum(PackedNormalized::from(&f), triangle, &place, depth),
            Some(Field::Quadratic(f)) => triangle_sum(packed::quadratic(&f), triangle, &place, depth),
            None => 0.0,
        };
    }
    sum
}

/// Walks a triangle: sum of the vectors at the pixels that pass the depth test.
fn triangle_sum<W>(field: W, triangle: &ScreenTriangle, place: &Place, depth: &mut Grid<f32>) -> f32
where
    W: Walk<Edge: OnEdge<Row: OnRow<Value = Packed>>>,
{
    let Some(map) = ToNormalized::new(&place.sides) else { return 0.0 };
    let depths = triangle.corners.map(|c| (c.position.z / c.position.w) as f32);
    let plane = Linear::on_normalized(depths).to_screen(&map);
    let (width, height) = depth.size();
    // By components: a sum across them in every pixel would be work that no method has.
    let mut sum = Packed::default();
    for side in place.left(height) {
        let ([x, y], slope) = (side.start, side.left.slope);
        let (mut vectors, mut plane) = (field.on_edge(x, y, slope), plane.on_edge(x, y, slope));
        side.for_each_row(width, |row, columns, ahead| {
            let (mut along, mut z) = (vectors.row(ahead), plane.row(ahead));
            for kept in &mut depth.texels_mut()[row as usize * width as usize..][columns] {
                if z.value() < *kept {
                    *kept = z.value();
                    sum = sum + along.value();
                }
                z.right();
                along.right();
            }
            vectors.down();
            plane.down();
        });
    }
    let Rotated { light, half } = sum.vectors();
    light.element_sum() + half.element_sum()
}

/// No vectors at all.
#[derive(Debug, Clone, Copy)]
struct Nothing;

impl Walk for Nothing {
    type Edge = Self;

    fn on_edge(&self, _: f32, _: f32, _: f32) -> Self {
        Self
    }
}

impl OnEdge for Nothing {
    type Row = Self;

    fn row(&self, _: f32) -> Self {
        Self
    }

    fn down(&mut self) {}
}

impl OnRow for Nothing {
    type Value = Packed;

    fn value(&self) -> Packed {
        Packed::default()
    }

    fn right(&mut self) {}
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::color::LinearRgb;
    use crate::light::{Light, Lighting};
    use crate::raster::scene::Detail;
    use crate::raster::vectors::{Midpoints, Order};
    use crate::surface::{Camera, shapes};

    const SIDE: u32 = 128;

    /// The same sum and depths by the fill rule and direct evaluation, summed in f64.
    fn direct(scene: &Scene<'_>, how: Interpolation) -> (f64, Grid<f32>) {
        let object = &scene.objects[0];
        let lighting = scene.lighting.to_object(&object.pose);
        let vertices = Vertices::new(object.mesh, &lighting.lights, scene.camera.eye());
        let mut depth = Grid::filled(SIDE, SIDE, 1.0f32).unwrap();
        let mut sum = 0.0;
        for triangle in set_up(object, scene, depth.size()) {
            let lit = vertices.triangle(triangle.vertices, &triangle.corners.map(|c| c.weights), 0);
            let sides = Place::new(&triangle.shape).sides;
            let field = Field::new(how, (&lit.corners, &lit.vectors), &sides, &vertices.viewer(0), 0.0).unwrap();
            let origin = triangle.shape.corners()[0];
            triangle.shape.for_each_pixel(0..SIDE, 0..SIDE, |x, y, weights| {
                let z = triangle.depth(weights);
                if z < depth[(x, y)] {
                    depth[(x, y)] = z;
                    let p = (glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - origin).as_vec2();
                    let at = field.at(p.x, p.y);
                    sum += f64::from(at.light.element_sum() + at.half.element_sum());
                }
            });
        }
        (sum, depth)
    }

    #[test]
    fn sums_and_depths_are_those_of_direct_evaluation() {
        let mesh = shapes::torus(12, 12, 1.0, 0.45).unwrap().with_tangents().unwrap();
        let camera = Camera::orbit(mesh.bounding_sphere(), 0.4, 0.85, 1.02, 0.97, 1.0).unwrap();
        let lamp = Light::point(camera.eye() + Vec3::new(2.0, 3.0, 0.0), LinearRgb::WHITE);
        let objects = vec![Object::new(&mesh, Detail::Smooth, &[])];
        let scene = Scene { objects, lighting: Lighting::new(LinearRgb::BLACK, vec![lamp]), camera };
        let quadratic = Interpolation::Quadratic { midpoints: Midpoints::GramSchmidt, order: Order::Quadratic };
        for how in [Interpolation::Linear, Interpolation::Normalized, quadratic] {
            let (expected, expected_depth) = direct(&scene, how);
            let mut depth = Grid::filled(SIDE, SIDE, 1.0f32).unwrap();
            let sum = f64::from(interpolate(&scene, Stage::Interpolate(how), &mut depth).unwrap());
            assert!(expected > 1000.0 && (sum - expected).abs() < 1e-3 * expected, "{how:?}: {sum}, not {expected}");
            let off = depth.texels().iter().zip(expected_depth.texels()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f32::max) < 1e-4, "{how:?}");
        }
        let mut depth = Grid::filled(SIDE, SIDE, 1.0f32).unwrap();
        assert_eq!(interpolate(&scene, Stage::Depth, &mut depth).unwrap(), 0.0);
        assert!(depth.texels().iter().any(|&z| z < 1.0));
    }

    #[test]
    fn lights_and_tangents_are_asked_for() {
        let mesh = shapes::sphere(8, 4).unwrap();
        let camera = Camera::orbit(mesh.bounding_sphere(), 0.0, 0.0, 1.1, 0.6, 1.0).unwrap();
        let objects = vec![Object::new(&mesh, Detail::Smooth, &[])];
        let dark = Scene { objects, lighting: Lighting::default(), camera };
        let mut depth = Grid::filled(8, 8, 1.0f32).unwrap();
        let refused = interpolate(&dark, Stage::Empty, &mut depth).unwrap_err().to_string();
        assert!(refused.contains("light"), "{refused}");
        let lit = Scene {
            lighting: Lighting::new(LinearRgb::BLACK, vec![Light::point(Vec3::ONE, LinearRgb::WHITE)]),
            ..dark
        };
        let refused = interpolate(&lit, Stage::Empty, &mut depth).unwrap_err().to_string();
        assert!(refused.contains("with_tangents"), "{refused}");
    }
}
