//! Pictures by scan lines.

use glam::{DVec2, Vec2};

use crate::color::LinearRgb;
use crate::error::{Error, Result};
use crate::raster::frame::{Frame, Shading};
use crate::raster::reference::{ScreenTriangle, base_color, set_up};
use crate::raster::scanline::difference::{OnEdge, OnRow, Walk};
use crate::raster::scanline::field::{FieldEdge, FieldRow};
use crate::raster::scanline::place::Place;
use crate::raster::scene::{Fragment, Object};
use crate::raster::target::{Pixel, Target};
use crate::raster::texture::Sampling;
use crate::raster::vectors::{Field, Rotated};

/// Draws a frame as [`crate::raster::draw`] does, with vectors that are carried along scan lines by forward differences.
///
/// For the methods of interpolated vectors. Pixels are the same; colours differ by the rounding errors that add up along a
/// row and an edge.
///
/// # Errors
/// [`Error::Missing`] if the frame was prepared for a method without interpolated vectors.
pub fn draw_scan_lines(frame: &Frame<'_>, target: &mut Target) -> Result<()> {
    for (object, shading) in frame.scene.objects.iter().zip(&frame.shadings) {
        let Shading::Interpolated(shading) = shading else {
            let remedy =
                "scan lines carry light vectors; prepare the frame for the linear, quadratic or normalised method";
            return Err(Error::Missing { what: "interpolated vectors", remedy });
        };
        let triangles = set_up(object, frame.scene, target.size());
        let sampling = Sampling { filter: frame.filter, edges: object.edges, repeat: Vec2::ONE };
        for (triangle, fields) in triangles.iter().zip(shading.fields(&triangles)) {
            draw_triangle(triangle, &fields.fields, target, object, |fragment, vectors| {
                let shade = shading.shade_by(fragment, sampling, |light| {
                    vectors.get(light).map_or_else(Rotated::default, OnRow::value)
                });
                shade.over(base_color(object, fragment, sampling), object.blend)
            });
        }
    }
    Ok(())
}

fn draw_triangle(
    triangle: &ScreenTriangle,
    fields: &[Field],
    target: &mut Target,
    object: &Object<'_>,
    color: impl Fn(&Fragment, &[FieldRow]) -> LinearRgb,
) {
    let (width, height) = target.size();
    let weights = Weights::new(triangle);
    let mut along: Vec<FieldRow> = Vec::with_capacity(fields.len());
    for side in Place::new(&triangle.shape).left(height) {
        let ([x, y], slope) = (side.start, side.left.slope);
        let mut edges: Vec<FieldEdge> = fields.iter().map(|f| f.on_edge(x, y, slope)).collect();
        side.for_each_row(width, |row, columns, ahead| {
            along.clear();
            along.extend(edges.iter().map(|edge| edge.row(ahead)));
            let start = row as usize * width as usize;
            let mut weights = weights.at(columns.start, row);
            for pixel in &mut target.pixels.texels_mut()[start..][columns] {
                let depth = triangle.depth(weights.here);
                if depth < pixel.depth {
                    let fragment = triangle.fragment(object.mesh, weights.here);
                    *pixel = Pixel { color: color(&fragment, &along), depth };
                }
                weights.right();
                along.iter_mut().for_each(OnRow::right);
            }
            edges.iter_mut().for_each(OnEdge::down);
        });
    }
}

/// The barycentric coordinates over a triangle, linear on the screen, in f64: depth and texture have to be right.
#[derive(Debug, Clone, Copy)]
struct Weights {
    corners: [DVec2; 3],
    here: [f64; 3],
    step: [f64; 3],
}

impl Weights {
    fn new(triangle: &ScreenTriangle) -> Self {
        let corners = triangle.shape.corners();
        let [a, b, c] = corners;
        let area = (b - a).perp_dot(c - a);
        Self { corners, here: [0.0; 3], step: [b - c, c - a, a - b].map(|e| e.y / area) }
    }

    /// At the centre of a pixel, computed anew.
    fn at(self, column: usize, row: u32) -> Self {
        let [a, b, c] = self.corners;
        let p = DVec2::new(column as f64 + 0.5, f64::from(row) + 0.5);
        let area = (b - a).perp_dot(c - a);
        let over = |from: DVec2, to: DVec2| (to - from).perp_dot(p - from) / area;
        Self { here: [over(b, c), over(c, a), over(a, b)], ..self }
    }

    fn right(&mut self) {
        for (here, step) in self.here.iter_mut().zip(self.step) {
            *here += step;
        }
    }
}
