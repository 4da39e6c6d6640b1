//! Pixel by pixel, with the scalar code of the reference: for what has no lanes of its own.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use glam::{Vec2, Vec3, Vec4};

use crate::raster::frame::Shading;
use crate::raster::reference::color;
use crate::raster::scene::{Fragment, Object};
use crate::raster::texture::{Footprint, Sampling};
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::buffer::word;
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;

/// Any method, as the reference has it.
pub(in crate::raster::tile) struct Pixelwise<'a> {
    pub(in crate::raster::tile) object: &'a Object<'a>,
    pub(in crate::raster::tile) shading: Shading<'a>,
    pub(in crate::raster::tile) sampling: Sampling,
}

/// A triangle of the mesh: its vertices' weights divided by w, and 1/w, over the screen.
pub(in crate::raster::tile) struct Weights {
    planes: Planes<4>,
    vertices: [Vertex; 3],
    back_facing: bool,
}

impl Shader<1> for Pixelwise<'_> {
    type SetUp = Weights;

    fn attributes(&self, _: &Vertex, inv_w: f32) -> [f32; 1] {
        [inv_w]
    }

    fn set_up(&self, seen: &Seen<'_, 1>) -> Weights {
        let vertices = self.object.mesh.triangles()[seen.triangle.source() as usize];
        let corners: [[f32; 4]; 3] = std::array::from_fn(|i| {
            let own = || vertices.map(|v| f32::from(u8::from(v == seen.triangle.corners[i])));
            let inv_w = seen.attributes[i][0];
            let [a, b, c] = seen.cut_weights(i).unwrap_or_else(own).map(|w| w * inv_w);
            [a, b, c, inv_w]
        });
        let [a, b, c] = &corners;
        Weights {
            planes: seen.sides.planes([a, b, c]),
            vertices: vertices.map(|v| Vertex::of(self.object.mesh, v)),
            back_facing: seen.triangle.back_facing(),
        }
    }

    fn shade<S: Simd>(&self, simd: S, set_up: &Weights, block: &Block<S>) -> u32x16<S> {
        let mut colors = [0; 16];
        let mut left = block.visible.to_bitmask();
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let fragment = set_up.fragment(block.x[lane], block.y[lane]);
            colors[lane] = word(color(self.object, &self.shading, &fragment, self.sampling).to_srgb());
        }
        colors.simd_into(simd)
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
