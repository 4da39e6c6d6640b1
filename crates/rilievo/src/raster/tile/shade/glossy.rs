//! The models most surfaces have: ambient, Lambert, one half-vector highlight; any number of lights.
//!
//! The general way ([`crate::light::Prepared`]) wants unit vectors and a place. Here lengths are divided out where they are met,
//! two at a time, and nothing is divided by w.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use glam::Vec3;

use crate::color::LinearRgb;
use crate::light::{Light, Lighting, LightingModel, Material, Prepared};
use crate::normal::Object as ObjectSpace;
use crate::simd::{Power, Vec3x16, dot, normalize, rsqrt, splat, splat3, three};

/// What a pixel is lit with: directions of any length.
pub(in crate::raster::tile) struct Lit<S: Simd> {
    pub(in crate::raster::tile) normal: Vec3x16<S>,
    /// From the surface to the eye, divided by w.
    pub(in crate::raster::tile) to_eye: Vec3x16<S>,
    pub(in crate::raster::tile) w: f32x16<S>,
    pub(in crate::raster::tile) inv_w: f32x16<S>,
}

/// How a surface answers light.
pub(in crate::raster::tile) trait Answer: Sync {
    /// Diffuse and specular light.
    fn shade<S: Simd>(&self, simd: S, lit: &Lit<S>) -> [Vec3x16<S>; 2];
}

/// Any material.
pub(in crate::raster::tile) struct General {
    pub(in crate::raster::tile) material: Prepared<ObjectSpace>,
    pub(in crate::raster::tile) eye: Vec3,
}

impl Answer for General {
    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, lit: &Lit<S>) -> [Vec3x16<S>; 2] {
        let position = if self.material.needs_position() {
            let eye = self.eye.to_array();
            three!(k => eye[k] - lit.to_eye[k] * lit.w)
        } else {
            splat3(simd, [0.0; 3])
        };
        let (normal, view) = (normalize(simd, lit.normal), normalize(simd, lit.to_eye));
        let [r, g, b, sr, sg, sb] = self.material.shade(simd, normal, view, position);
        [[r, g, b], [sr, sg, sb]]
    }
}

/// Ambient, Lambert and a half-vector highlight.
#[derive(Debug)]
pub(in crate::raster::tile) struct Glossy {
    even: [f32; 3],
    lights: Vec<Term>,
    power: Option<Power>,
}

/// A light, multiplied by what the material makes of it.
#[derive(Debug)]
struct Term {
    from: From,
    lambert: [f32; 3],
    highlight: [f32; 3],
}

#[derive(Debug)]
enum From {
    /// A unit vector to the light.
    Far([f32; 3]),
    /// From the eye to the light.
    Near([f32; 3]),
}

impl Glossy {
    /// `None` for a material with other models, or more highlights than one, or a light that falls off.
    pub(in crate::raster::tile) fn new(material: &Material, lighting: &Lighting<ObjectSpace>, eye: Vec3) -> Option<Self> {
        let (mut even, mut lambert) = (LinearRgb::BLACK, LinearRgb::BLACK);
        let mut highlight = None;
        for layer in material.layers() {
            match layer.model {
                LightingModel::Ambient { color } => even += lighting.ambient * color * layer.weight,
                LightingModel::Lambert { color } => lambert += color * layer.weight,
                LightingModel::BlinnPhong { color, shininess } if highlight.is_none() => {
                    highlight = Some((color * layer.weight, shininess));
                }
                _ => return None,
            }
        }
        let highlight = highlight.filter(|(color, _)| *color != LinearRgb::BLACK);
        let array = |c: LinearRgb| [c.r, c.g, c.b];
        let term = |light: &Light<ObjectSpace>| {
            let (from, color) = match *light {
                Light::Directional { toward, color } => (From::Far(toward.vec().to_array()), color),
                Light::Point { position, color, reference_distance: None } => {
                    (From::Near((position - eye).to_array()), color)
                }
                Light::Point { .. } => return None,
            };
            let highlight = highlight.map_or(LinearRgb::BLACK, |(specular, _)| specular);
            Some(Term { from, lambert: array(color * lambert), highlight: array(color * highlight) })
        };
        let lights = lighting.lights.iter().map(term).collect::<Option<_>>()?;
        Some(Self { even: array(even), lights, power: highlight.map(|(_, shininess)| Power::new(shininess)) })
    }
}

impl Answer for Glossy {
    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, lit: &Lit<S>) -> [Vec3x16<S>; 2] {
        let (mut diffuse, mut specular) = (splat3(simd, self.even), splat3(simd, [0.0; 3]));
        let zero = splat(simd, 0.0);
        let inv_normal = rsqrt(simd, dot(lit.normal, lit.normal));
        let view = if self.power.is_some() { normalize(simd, lit.to_eye) } else { lit.to_eye };
        for term in &self.lights {
            let toward = match &term.from {
                From::Far(toward) => splat3(simd, *toward),
                From::Near(from_eye) => {
                    normalize(simd, three!(k => lit.inv_w.mul_add(splat(simd, from_eye[k]), lit.to_eye[k])))
                }
            };
            let cosine = dot(lit.normal, toward) * inv_normal;
            let lit_cosine = cosine.max(zero);
            diffuse = three!(k => lit_cosine.mul_add(splat(simd, term.lambert[k]), diffuse[k]));
            let Some(power) = self.power else { continue };
            let half = three!(k => toward[k] + view[k]);
            // A light straight opposite the eye has no half vector and no highlight.
            let square = dot(half, half).max(splat(simd, 1e-12));
            let base = dot(lit.normal, half) * inv_normal * rsqrt(simd, square);
            let strength = cosine.simd_gt(zero).select(power.of(simd, base), zero);
            specular = three!(k => strength.mul_add(splat(simd, term.highlight[k]), specular[k]));
        }
        [diffuse, specular]
    }
}
