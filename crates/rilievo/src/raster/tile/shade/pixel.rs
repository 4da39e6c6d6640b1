//! Pixel by pixel, with the scalar code of the reference: for what has no lanes of its own.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use glam::{Vec2, Vec3, Vec4};

use crate::raster::frame::Shading;
use crate::raster::reference::{base_color, shade};
use crate::raster::scene::{Fragment, Object};
use crate::raster::texture::{Footprint, Sampling};
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::vectors::{Field, Rotated, Vertices};

/// Any method, as the reference has it.
pub(in crate::raster::tile) struct Pixelwise<'a> {
    pub(in crate::raster::tile) object: &'a Object<'a>,
    pub(in crate::raster::tile) shading: Shading<'a>,
    pub(in crate::raster::tile) sampling: Sampling,
    /// For interpolated vectors: those of the mesh's corners.
    pub(in crate::raster::tile) vertices: Option<Vertices>,
}

/// A triangle of the mesh: its vertices' weights divided by w, and 1/w, over the screen.
pub(in crate::raster::tile) struct Weights {
    planes: Planes<4>,
    vertices: [Vertex; 3],
    back_facing: bool,
    /// Interpolated vectors of each light.
    fields: Vec<Field>,
}

impl Shader<1> for Pixelwise<'_> {
    type SetUp = Weights;

    fn attributes(&self, _: &Vertex, inv_w: f32) -> [f32; 1] {
        [inv_w]
    }

    fn set_up(&self, seen: &Seen<'_, 1>) -> Weights {
        let vertices = self.object.mesh.triangles()[seen.triangle.source() as usize];
        let weights = seen.weights(vertices);
        let corners: [[f32; 4]; 3] = std::array::from_fn(|i| {
            let inv_w = seen.attributes[i][0];
            let [a, b, c] = weights[i].map(|w| w * inv_w);
            [a, b, c, inv_w]
        });
        let fields = match (&self.shading, &self.vertices) {
            (Shading::Interpolated(shading), Some(corners)) => {
                let weights = weights.map(|w| w.map(f64::from));
                shading.over_triangle(vertices, &weights, &seen.sides.for_vectors(), corners)
            }
            _ => Vec::new(),
        };
        let [a, b, c] = &corners;
        Weights {
            planes: seen.sides.planes([a, b, c]),
            vertices: vertices.map(|v| Vertex::of(self.object.mesh, v)),
            back_facing: seen.triangle.back_facing(),
            fields,
        }
    }

    type Fetched<S: Simd> = ();

    fn fetch<S: Simd>(&self, _: S, _: &Block<'_, S, Weights>) {}

    fn shade<S: Simd>(&self, simd: S, block: &Block<'_, S, Weights>, (): &()) -> u32x16<S> {
        let mut colors = [0; 16];
        for i in 0..block.parts() {
            let part = block.part(simd, i);
            let mut left = part.lanes.to_bitmask();
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                colors[lane] = self.color(part.set_up, part.x[lane], part.y[lane]);
            }
        }
        colors.simd_into(simd)
    }
}

impl Pixelwise<'_> {
    /// The encoded colour of a pixel.
    fn color(&self, set_up: &Weights, x: f32, y: f32) -> u32 {
        let fragment = set_up.fragment(x, y);
        let shade = match &self.shading {
            Shading::Interpolated(shading) => shading.shade_by(&fragment, self.sampling, |light| {
                set_up.fields.get(light).map_or_else(Rotated::default, |field| field.at(x, y))
            }),
            other => shade(other, &fragment, self.sampling),
        };
        let base = base_color(self.object, &fragment, self.sampling);
        word(shade.over(base, self.object.blend).to_srgb())
    }
}

impl Weights {
    fn fragment(&self, x: f32, y: f32) -> Fragment {
        let planes = [0, 1, 2, 3].map(|i| self.planes.get(i));
        let [a, b, c, inv_w] = planes.map(|p| p.at_corner + p.dx * x + p.dy * y);
        let weights = [a, b, c].map(|w| w / inv_w);
        // d(n / d) = (dn − n / d · dd) / d, at the pixel itself.
        let change = |of: [f32; 4]| [0, 1, 2].map(|k| (of[k] - weights[k] * of[3]) / inv_w);
        let uv = |w: [f32; 3]| self.mix(|v| v.uv.extend(0.0).extend(0.0), w);
        let uv = |w: [f32; 3]| {
            let uv = uv(w);
            Vec2::new(uv.x, uv.y)
        };
        let footprint = Footprint {
            uv: uv(weights),
            uv_dx: uv(change(planes.map(|p| p.dx))),
            uv_dy: uv(change(planes.map(|p| p.dy))),
        };
        let vector = |of: fn(&Vertex) -> Vec3| self.mix(|v| of(v).extend(0.0), weights).truncate();
        Fragment {
            footprint,
            position: vector(|v| v.position),
            normal: vector(|v| v.normal),
            tangent: self.mix(|v| v.tangent, weights),
            back_facing: self.back_facing,
        }
    }

    fn mix(&self, of: impl Fn(&Vertex) -> Vec4, [a, b, c]: [f32; 3]) -> Vec4 {
        of(&self.vertices[0]) * a + of(&self.vertices[1]) * b + of(&self.vertices[2]) * c
    }
}
