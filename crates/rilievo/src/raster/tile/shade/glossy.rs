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
    /// Whether several materials may answer. A kernel for one alone is a twentieth faster than one that asks how many there are.
    const MANY: bool;

    /// Diffuse and specular light.
    fn shade<S: Simd>(&self, simd: S, lit: &Lit<S>) -> [Vec3x16<S>; 2];
}

/// Any material.
pub(in crate::raster::tile) struct General {
    pub(in crate::raster::tile) material: Prepared<ObjectSpace>,
    pub(in crate::raster::tile) eye: Vec3,
}

impl Answer for General {
    const MANY: bool = true;

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

/// What a material of ambient light, Lambert's law and at most one half-vector highlight makes of each light.
#[derive(Debug)]
pub(in crate::raster::tile) struct Terms {
    even: [f32; 3],
    /// For each light, its colour times the reflectances: diffuse and specular.
    colors: Vec<[[f32; 3]; 2]>,
    power: Option<Power>,
}

/// What light hangs on: the products of the unit normal with the unit vectors to the light and half way to the eye.
pub(in crate::raster::tile) struct Products<S: Simd> {
    pub(in crate::raster::tile) light: f32x16<S>,
    pub(in crate::raster::tile) half: f32x16<S>,
}

impl Terms {
    /// `None` for a material with other models or more highlights than one, and for lights that fall off.
    pub(in crate::raster::tile) fn new(material: &Material, lighting: &Lighting<ObjectSpace>) -> Option<Self> {
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
        let specular = highlight.map_or(LinearRgb::BLACK, |(color, _)| color);
        let array = |c: LinearRgb| [c.r, c.g, c.b];
        let both = |light: &Light<ObjectSpace>| match *light {
            Light::Directional { color, .. } | Light::Point { color, reference_distance: None, .. } => {
                Some([lambert, specular].map(|c| array(color * c)))
            }
            Light::Point { .. } => None,
        };
        let colors = lighting.lights.iter().map(both).collect::<Option<_>>()?;
        Some(Self { even: array(even), colors, power: highlight.map(|(_, shininess)| Power::new(shininess)) })
    }

    /// How many lights there are.
    #[inline(always)]
    pub(in crate::raster::tile) fn lights(&self) -> usize {
        self.colors.len()
    }

    /// Light that is the same for all normals: diffuse, and no specular yet.
    #[inline(always)]
    pub(in crate::raster::tile) fn start<S: Simd>(&self, simd: S) -> [Vec3x16<S>; 2] {
        [splat3(simd, self.even), splat3(simd, [0.0; 3])]
    }

    /// Adds a light.
    #[inline(always)]
    pub(in crate::raster::tile) fn add<S: Simd>(
        &self,
        simd: S,
        light: usize,
        products: &Products<S>,
        sum: &mut [Vec3x16<S>; 2],
    ) {
        let Some([lambert, specular]) = self.colors.get(light) else { return };
        let zero = splat(simd, 0.0);
        let cosine = products.light.max(zero);
        sum[0] = three!(k => cosine.mul_add(splat(simd, lambert[k]), sum[0][k]));
        let Some(power) = self.power else { return };
        let strength = products.light.simd_gt(zero).select(power.of(simd, products.half), zero);
        sum[1] = three!(k => strength.mul_add(splat(simd, specular[k]), sum[1][k]));
    }
}

/// [`Terms`] with the directions of the lights.
#[derive(Debug)]
pub(in crate::raster::tile) struct Glossy {
    terms: Terms,
    from: Vec<From>,
}

/// Where a light is.
#[derive(Debug)]
enum From {
    /// A unit vector to the light.
    Far([f32; 3]),
    /// From the eye to the light.
    Near([f32; 3]),
}

impl Glossy {
    /// `None` where [`Terms::new`] has none.
    pub(in crate::raster::tile) fn new(
        material: &Material,
        lighting: &Lighting<ObjectSpace>,
        eye: Vec3,
    ) -> Option<Self> {
        let from = |light: &Light<ObjectSpace>| match *light {
            Light::Directional { toward, .. } => From::Far(toward.vec().to_array()),
            Light::Point { position, .. } => From::Near((position - eye).to_array()),
        };
        Some(Self { terms: Terms::new(material, lighting)?, from: lighting.lights.iter().map(from).collect() })
    }
}

impl Answer for Glossy {
    const MANY: bool = false;

    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, lit: &Lit<S>) -> [Vec3x16<S>; 2] {
        let mut sum = self.terms.start(simd);
        let inv_normal = rsqrt(simd, dot(lit.normal, lit.normal));
        let glossy = self.terms.power.is_some();
        let view = if glossy { normalize(simd, lit.to_eye) } else { lit.to_eye };
        for (light, from) in self.from.iter().enumerate() {
            let toward = match from {
                From::Far(toward) => splat3(simd, *toward),
                From::Near(from_eye) => {
                    normalize(simd, three!(k => lit.inv_w.mul_add(splat(simd, from_eye[k]), lit.to_eye[k])))
                }
            };
            let cosine = dot(lit.normal, toward) * inv_normal;
            let half = if glossy {
                let half = three!(k => toward[k] + view[k]);
                // A light straight opposite the eye has no half vector and no highlight.
                let square = dot(half, half).max(splat(simd, 1e-12));
                dot(lit.normal, half) * inv_normal * rsqrt(simd, square)
            } else {
                cosine
            };
            self.terms.add(simd, light, &Products { light: cosine, half }, &mut sum);
        }
        sum
    }
}
