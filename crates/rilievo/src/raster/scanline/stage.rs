//! Interpolation alone: setup, inner loops and depth, without texture, lighting and colour.

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::raster::reference::{ScreenTriangle, set_up};
use crate::raster::scanline::difference::{OnEdge, OnRow, Walk};
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
            Some(Field::Linear(f)) => triangle_sum(f, triangle, &place, depth),
            Some(Field::Normalized(f)) => triangle_sum(f, triangle, &place, depth),
            Some(Field::Quadratic(f)) => triangle_sum(f, triangle, &place, depth),
            None => 0.0,
        };
    }
    sum
}

/// Walks a triangle: sum of the vectors at the pixels that pass the depth test.
fn triangle_sum<W>(field: W, triangle: &ScreenTriangle, place: &Place, depth: &mut Grid<f32>) -> f32
where
    W: Walk<Edge: OnEdge<Row: OnRow<Value = Rotated>>>,
{
    let Some(map) = ToNormalized::new(&place.sides) else { return 0.0 };
    let depths = triangle.corners.map(|c| (c.position.z / c.position.w) as f32);
    let plane = Linear::on_normalized(depths).to_screen(&map);
    let (width, height) = depth.size();
    let mut sum = 0.0;
    for side in place.left(height) {
        let ([x, y], slope) = (side.start, side.left.slope);
        let (mut vectors, mut plane) = (field.on_edge(x, y, slope), plane.on_edge(x, y, slope));
        side.for_each_row(width, |row, columns, ahead| {
            let (mut along, mut z) = (vectors.row(ahead), plane.row(ahead));
            for kept in &mut depth.texels_mut()[row as usize * width as usize..][columns] {
                if z.value() < *kept {
                    *kept = z.value();
                    let Rotated { light: l, half: h } = along.value();
                    sum += (l.x + l.y + l.z) + (h.x + h.y + h.z);
                }
                z.right();
                along.right();
            }
            vectors.down();
            plane.down();
        });
    }
    sum
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
    type Value = Rotated;

    fn value(&self) -> Rotated {
        Rotated::default()
    }

    fn right(&mut self) {}
}
