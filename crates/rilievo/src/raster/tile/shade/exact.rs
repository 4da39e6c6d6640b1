//! Normal, frame and view direction of every pixel.
//!
//! Nothing that is normalised in the end is divided by w: normal and tangent, and the way to the eye, are linear on the screen
//! once divided by w at the vertices, and a factor that all three share is none for a direction. Only texture coordinates, the
//! bitangent's share and the place for point lights need w itself.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use glam::Vec3;

use super::glossy::{Answer, Lit};
use super::{Fetched, Finish, Grain, NormalTexture, add_share, of_material};
use crate::raster::tile::batch::{Block, Seen, Shader};
use crate::raster::tile::front::Vertex;
use crate::raster::tile::planes::Planes;
use crate::raster::tile::texture::{Footprints, Look, Texture};
use crate::simd::{Vec3x16, cross, dot, gather, scale, splat, splat3, three};

/// Texture coordinates and 1/w, the way to the eye, normal, tangent, sign of the bitangent; up to whole vectors.
const ATTRIBUTES: usize = 16;
const EYE: usize = 3;
const NORMAL: usize = 6;
const TANGENT: usize = 9;
const SIGN: usize = 12;

/// Where a pixel's normal comes from.
pub(in crate::raster::tile) enum Relief<'a> {
    Smooth,
    Tangent(NormalTexture<'a>),
    Object(NormalTexture<'a>),
    /// Indices, and x, y, z and the material of each entry.
    Indexed(&'a Texture, Look, Vec<u32>),
}

/// Materials whose light is evaluated by the pixel.
pub(in crate::raster::tile) struct Exact<'a, A> {
    pub(in crate::raster::tile) relief: Relief<'a>,
    /// Of each material that the map may name; the first alone unless there may be many ([`Answer::MANY`]).
    pub(in crate::raster::tile) answers: Vec<A>,
    pub(in crate::raster::tile) eye: Vec3,
    pub(in crate::raster::tile) finish: Finish<'a>,
    /// Whether maps have mip levels.
    pub(in crate::raster::tile) with_levels: bool,
}

/// A triangle.
pub(in crate::raster::tile) struct SetUp {
    planes: Planes<ATTRIBUTES>,
    /// Of the bitangent.
    sign: f32,
    back_facing: bool,
}

impl<A: Answer> Shader<ATTRIBUTES> for Exact<'_, A> {
    type SetUp = SetUp;

    fn attributes(&self, vertex: &Vertex, inv_w: f32) -> [f32; ATTRIBUTES] {
        let [e, n, t] = [self.eye - vertex.position, vertex.normal, vertex.tangent.truncate()].map(|v| v * inv_w);
        let uv = vertex.uv * inv_w;
        let sign = vertex.tangent.w;
        [uv.x, uv.y, inv_w, e.x, e.y, e.z, n.x, n.y, n.z, t.x, t.y, t.z, sign, 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn set_up(&self, seen: &Seen<'_, ATTRIBUTES>) -> SetUp {
        SetUp {
            planes: seen.sides.planes(seen.attributes),
            sign: seen.attributes[0][SIGN],
            back_facing: seen.triangle.back_facing(),
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
        let map = match &self.relief {
            Relief::Tangent(map) | Relief::Object(map) => Some(map),
            Relief::Smooth | Relief::Indexed(..) => None,
        };
        Fetched::new(simd, footprints.get(), map)
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, block: &Block<'_, S, SetUp>, fetched: &Fetched<S>) -> u32x16<S> {
        let [mut to_eye, mut smooth, mut tangent] = [splat3(simd, [0.0; 3]); 3];
        let (mut sign, mut side, mut behind) = (splat(simd, 1.0), splat(simd, 1.0), false);
        for i in 0..block.parts() {
            let part = block.part(simd, i);
            let SetUp { planes, sign: of_part, back_facing } = part.set_up;
            planes.enter(simd, &part, EYE, &mut to_eye);
            planes.enter(simd, &part, NORMAL, &mut smooth);
            planes.enter(simd, &part, TANGENT, &mut tangent);
            sign = part.lanes.select(splat(simd, *of_part), sign);
            if *back_facing {
                behind = true;
                side = part.lanes.select(splat(simd, -1.0), side);
            }
        }
        let at = &fetched.at;
        let frame = Frame { smooth, tangent, sign };
        let mut sum = [splat3(simd, [0.0; 3]); 2];
        if let (false, Some(answer)) = (A::MANY, self.answers.first()) {
            let (normal, _) = self.normal(simd, fetched, &frame, 0);
            let normal = if behind { scale(normal, side) } else { normal };
            let [diffuse, specular] = answer.shade(simd, &Lit { normal, to_eye, w: at.w, inv_w: at.inv_w });
            return self.finish.encode(simd, diffuse, specular, at);
        }
        for (material, answer) in self.answers.iter().enumerate() {
            let (normal, share) = self.normal(simd, fetched, &frame, material as u32);
            if !share.simd_gt(splat(simd, 0.0)).any_true() {
                continue;
            }
            let normal = if behind { scale(normal, side) } else { normal };
            add_share(&mut sum, answer.shade(simd, &Lit { normal, to_eye, w: at.w, inv_w: at.inv_w }), share);
        }
        self.finish.encode(simd, sum[0], sum[1], at)
    }
}

impl<A: Answer> Exact<'_, A> {
    /// The normal of a material under each pixel, not normalised, and the material's share of it.
    #[inline(always)]
    fn normal<S: Simd>(
        &self,
        simd: S,
        fetched: &Fetched<S>,
        frame: &Frame<S>,
        material: u32,
    ) -> (Vec3x16<S>, f32x16<S>) {
        let smooth = frame.smooth;
        let (sum, share) = match &self.relief {
            Relief::Smooth => (smooth, splat(simd, 1.0)),
            Relief::Tangent(map) | Relief::Object(map) => {
                let Grain { sum, share } = fetched.grain(simd, map, material);
                let tangent = matches!(self.relief, Relief::Tangent(_));
                (if tangent { frame.bend(fetched.at.w, sum) } else { sum }, share)
            }
            Relief::Indexed(texture, look, entries) => {
                let mut grain = Grain::none(simd);
                texture.taps(
                    simd,
                    look,
                    &fetched.at,
                    #[inline(always)]
                    |texel, weight| {
                        let entry = texture.index(simd, texel) << 2;
                        let normal = three!(k => gather(simd, entries, entry + k as u32).bitcast::<f32x16<S>>());
                        let weight = if A::MANY {
                            of_material(simd, gather(simd, entries, entry + 3), material, weight)
                        } else {
                            weight
                        };
                        grain.add(normal, weight);
                    },
                );
                (grain.sum, grain.share)
            }
        };
        // Where normals cancel, the mesh's own.
        let gone = dot(sum, sum).simd_lt(splat(simd, 1e-20));
        (if gone.any_true() { three!(k => gone.select(smooth[k], sum[k])) } else { sum }, share)
    }
}

/// The frames of sixteen pixels, interpolated and divided by w.
struct Frame<S: Simd> {
    smooth: Vec3x16<S>,
    tangent: Vec3x16<S>,
    /// Of the bitangent.
    sign: f32x16<S>,
}

impl<S: Simd> Frame<S> {
    /// A tangent-space normal in object space, by the interpolated frame as it is (MikkTSpace).
    #[inline(always)]
    fn bend(&self, w: f32x16<S>, n: Vec3x16<S>) -> Vec3x16<S> {
        let Self { smooth, tangent, sign } = self;
        // The cross product of two vectors that are both divided by w has one division too many.
        let bitangent = cross(*smooth, *tangent);
        let up = n[1] * (w * *sign);
        three!(k => tangent[k].mul_add(n[0], bitangent[k].mul_add(up, smooth[k] * n[2])))
    }
}
