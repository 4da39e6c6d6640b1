//! Light and half vectors interpolated over the screen: a pixel multiplies them with its normal as the map has it.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use glam::Vec3;

use super::glossy::{Products, Terms};
use super::{Fetched, Finish, Grain, NormalTexture, add_share};
use crate::raster::reference::Interpolated;
use crate::raster::tile::batch::{Block, Part, Seen, Shader};
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::Footprints;
use crate::raster::vectors::{Field, Linear, Quadratic, Rotated, Vertices};
use crate::simd::{Vec3x16, dot, rsqrt, scale, splat, splat3, three};

/// Texture coordinates and 1/w.
const ATTRIBUTES: usize = 3;

/// Materials lit by interpolated vectors; one alone unless there may be `MANY` (see [`super::glossy::Answer::MANY`]).
pub(in crate::raster::tile) struct Vectors<'a, const MANY: bool> {
    /// The map of tangent-space normals; the mesh's own without it.
    pub(in crate::raster::tile) relief: Option<NormalTexture<'a>>,
    pub(in crate::raster::tile) shading: Interpolated<'a>,
    pub(in crate::raster::tile) vertices: Vertices,
    pub(in crate::raster::tile) mesh: &'a crate::surface::Mesh,
    /// Of each material that the map may name.
    pub(in crate::raster::tile) terms: Vec<Terms>,
    pub(in crate::raster::tile) finish: Finish<'a>,
    /// Whether maps have mip levels.
    pub(in crate::raster::tile) with_levels: bool,
}

/// A triangle.
pub(in crate::raster::tile) struct SetUp {
    planes: Planes<ATTRIBUTES>,
    /// One for each light.
    fields: Vec<Field>,
    side: f32,
}

impl<const MANY: bool> Shader<ATTRIBUTES> for Vectors<'_, MANY> {
    type SetUp = SetUp;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        [vertex.uv.x * inv_w, vertex.uv.y * inv_w, inv_w]
    }

    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> SetUp {
        let vertices = self.mesh.triangles()[seen.triangle.source() as usize];
        let weights = seen.weights(vertices).map(|w| w.map(f64::from));
        SetUp {
            planes: seen.sides.planes(seen.attributes),
            fields: self.shading.over_triangle(vertices, &weights, &seen.sides.for_vectors(), &self.vertices),
            side: if seen.triangle.back_facing() { -1.0 } else { 1.0 },
        }
    }

    type Fetched<S: Simd> = Fetched<S>;

    #[inline(always)]
    fn fetch<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>) -> Fetched<S> {
        let mut footprints = Footprints::new(simd);
        for i in 0..block.parts() {
            let part = block.part(simd, i);
            footprints.add(simd, &part.set_up.planes, &part, self.with_levels);
        }
        Fetched::new(simd, footprints.get(), self.relief.as_ref())
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>, fetched: &Fetched<S>) -> u32x16<S> {
        let mut side = splat(simd, 1.0);
        for i in 0..block.parts() {
            let part = block.part(simd, i);
            side = part.lanes.select(splat(simd, part.set_up.side), side);
        }
        if let (false, Some(terms)) = (MANY, self.terms.first()) {
            let (normal, _) = self.normal(simd, fetched, side, 0);
            let [diffuse, specular] = lit(simd, terms, block, normal);
            return self.finish.encode(simd, diffuse, specular, &fetched.at);
        }
        let mut total = [splat3(simd, [0.0; 3]); 2];
        for (material, terms) in self.terms.iter().enumerate() {
            let (normal, share) = self.normal(simd, fetched, side, material as u32);
            if share.simd_gt(splat(simd, 0.0)).any_true() {
                add_share(&mut total, lit(simd, terms, block, normal), share);
            }
        }
        self.finish.encode(simd, total[0], total[1], &fetched.at)
    }
}

impl<const MANY: bool> Vectors<'_, MANY> {
    /// The unit normal of a material under each pixel, turned to the eye's side, and the material's share of it.
    #[inline(always)]
    fn normal<S: Simd>(
        &self,
        simd: S,
        fetched: &Fetched<S>,
        side: f32x16<S>,
        material: u32,
    ) -> (Vec3x16<S>, f32x16<S>) {
        let Some(map) = &self.relief else {
            return ([splat(simd, 0.0), splat(simd, 0.0), side], splat(simd, 1.0));
        };
        let Grain { sum, share } = fetched.grain(simd, map, material);
        let length = rsqrt(simd, dot(sum, sum).max(splat(simd, 1e-20))) * side;
        (scale(sum, length), share)
    }
}

/// Diffuse and specular light of all lamps on normals.
#[inline(always)]
fn lit<S: Simd>(simd: S, terms: &Terms, block: &Block<'_, S, SetUp>, normal: Vec3x16<S>) -> [Vec3x16<S>; 2] {
    let mut sum = terms.start(simd);
    for light in 0..terms.lights() {
        let [mut light_cosine, mut half_cosine] = [splat(simd, 0.0); 2];
        for i in 0..block.parts() {
            let part = block.part(simd, i);
            let Some(field) = part.set_up.fields.get(light) else { continue };
            let (l, h) = match field {
                Field::Linear(field) => linear(simd, field, &part),
                Field::Normalized(field) => linear(simd, &field.vectors, &part),
                Field::Quadratic(field) => quadratic(simd, field, &part),
            };
            let (mut to_light, mut to_half) = (dot(normal, l), dot(normal, h));
            if matches!(field, Field::Normalized(_)) {
                to_light *= inverse_length(simd, l);
                to_half *= inverse_length(simd, h);
            }
            light_cosine = part.lanes.select(to_light, light_cosine);
            half_cosine = part.lanes.select(to_half, half_cosine);
        }
        terms.add(simd, light, &Products { light: light_cosine, half: half_cosine }, &mut sum);
    }
    sum
}

#[inline(always)]
fn inverse_length<S: Simd>(simd: S, v: Vec3x16<S>) -> f32x16<S> {
    rsqrt(simd, dot(v, v).max(splat(simd, 1e-20)))
}

#[inline(always)]
fn linear<S: Simd>(simd: S, f: &Linear<Rotated>, at: &Part<'_, S, SetUp>) -> (Vec3x16<S>, Vec3x16<S>) {
    let Linear { a, b, c } = f;
    (linear3(simd, [a.light, b.light, c.light], at), linear3(simd, [a.half, b.half, c.half], at))
}

/// a x + b y + c.
#[inline(always)]
fn linear3<S: Simd>(simd: S, [a, b, c]: [Vec3; 3], at: &Part<'_, S, SetUp>) -> Vec3x16<S> {
    let row = three!(k => splat(simd, b[k]).mul_add(at.y, splat(simd, c[k])));
    three!(k => splat(simd, a[k]).mul_add(at.x, row[k]))
}

#[inline(always)]
fn quadratic<S: Simd>(simd: S, f: &Quadratic<Rotated>, at: &Part<'_, S, SetUp>) -> (Vec3x16<S>, Vec3x16<S>) {
    let Quadratic { a, b, c, d, e, f } = f;
    (
        quadratic3(simd, [a.light, b.light, c.light, d.light, e.light, f.light], at),
        quadratic3(simd, [a.half, b.half, c.half, d.half, e.half, f.half], at),
    )
}

/// (a x + (c y + d)) x + ((b y + e) y + f): Horner's scheme; what has no x in it is the same along a row of blocks.
#[inline(always)]
fn quadratic3<S: Simd>(simd: S, [a, b, c, d, e, f]: [Vec3; 6], at: &Part<'_, S, SetUp>) -> Vec3x16<S> {
    let slope = three!(k => splat(simd, c[k]).mul_add(at.y, splat(simd, d[k])));
    let level = three!(k => splat(simd, b[k]).mul_add(at.y, splat(simd, e[k])).mul_add(at.y, splat(simd, f[k])));
    three!(k => splat(simd, a[k]).mul_add(at.x, slope[k]).mul_add(at.x, level[k]))
}
