//! The methods, one room each, of the same shape: what they want of a vertex, of a triangle, of sixteen pixels.

mod exact;
mod glossy;
mod pixel;
mod table;
mod vectors;

pub(super) use exact::{Exact, Relief};
pub(super) use glossy::{General, Glossy, Terms};
pub(super) use pixel::Pixelwise;
pub(super) use table::{Filtered, Nearest, Shades, Static};
pub(super) use vectors::Vectors;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

use super::texture::{Footprint, Look, Texture};
use crate::light::Blend;
use crate::raster::texture::TextureFilter;
use crate::simd::{Vec3x16, splat, splat3, srgb_pixel, three};

/// A base colour, as lanes read it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base<'a> {
    pub(super) texture: &'a Texture,
    pub(super) look: Look,
}

/// What becomes of light on the way to the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Finish<'a> {
    pub(super) base: Option<Base<'a>>,
    pub(super) blend: Blend,
}

impl Finish<'_> {
    /// Diffuse and specular light over the base colour, encoded.
    #[inline(always)]
    pub(super) fn encode<S: Simd>(
        &self,
        simd: S,
        diffuse: Vec3x16<S>,
        specular: Vec3x16<S>,
        at: &Footprint<S>,
    ) -> u32x16<S> {
        let base = match self.base {
            None => [f32x16::splat(simd, 1.0); 3],
            Some(base) => mean(
                simd,
                base.texture,
                &base.look,
                at,
                #[inline(always)]
                |texel| base.texture.vector(simd, texel, false),
            ),
        };
        srgb_pixel(simd, three!(k => self.blend.over(simd, diffuse[k], specular[k], base[k])))
    }
}

/// A map of normals, as lanes read it.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalTexture<'a> {
    pub(super) texture: &'a Texture,
    pub(super) look: Look,
    /// Which material each texel has; without it, all have the first.
    pub(super) materials: Option<&'a Texture>,
}

/// The normals of one material under each pixel.
#[derive(Clone, Copy)]
pub(super) struct Grain<S: Simd> {
    /// Their weighted sum.
    sum: Vec3x16<S>,
    /// Their share of the pixel.
    share: f32x16<S>,
}

/// Where a block's pixels look, and which texel is under them if that is all they see of a map.
#[derive(Clone, Copy)]
pub(super) struct Fetched<S: Simd> {
    at: Footprint<S>,
    nearest: u32x16<S>,
}

impl<S: Simd> Fetched<S> {
    #[inline(always)]
    fn new(simd: S, at: Footprint<S>, map: Option<&NormalTexture<'_>>) -> Self {
        let nearest = match map {
            // Smaller levels are near at hand already, and for four texels it does not pay.
            Some(map) if map.is_plain() => map.texture.send_for(simd, &map.look, &at),
            _ => u32x16::splat(simd, 0),
        };
        Self { at, nearest }
    }

    /// What a map says of a material, filtered.
    #[inline(always)]
    fn grain(&self, simd: S, map: &NormalTexture<'_>, material: u32) -> Grain<S> {
        if map.is_plain() {
            return Grain { sum: map.texture.vector(simd, self.nearest, true), share: splat(simd, 1.0) };
        }
        let mut grain = Grain::none(simd);
        map.texture.taps(
            simd,
            &map.look,
            &self.at,
            #[inline(always)]
            |texel, weight| {
                let weight = match map.materials {
                    Some(materials) => of_material(simd, materials.index(simd, texel), material, weight),
                    None => weight,
                };
                grain.add(map.texture.vector(simd, texel, true), weight);
            },
        );
        grain
    }
}

impl NormalTexture<'_> {
    /// Whether a pixel sees one texel, and all texels have one material.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.look.filter == TextureFilter::Nearest && self.materials.is_none()
    }
}

impl<S: Simd> Grain<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        Self { sum: splat3(simd, [0.0; 3]), share: splat(simd, 0.0) }
    }

    #[inline(always)]
    fn add(&mut self, normal: Vec3x16<S>, weight: f32x16<S>) {
        self.sum = three!(k => normal[k].mul_add(weight, self.sum[k]));
        self.share += weight;
    }
}

/// `weight` where the material is this one.
#[inline(always)]
fn of_material<S: Simd>(simd: S, found: u32x16<S>, material: u32, weight: f32x16<S>) -> f32x16<S> {
    found.simd_eq(u32x16::splat(simd, material)).select(weight, splat(simd, 0.0))
}

/// Adds a share of a shade, diffuse and specular.
#[inline(always)]
fn add_share<S: Simd>(sum: &mut [Vec3x16<S>; 2], shade: [Vec3x16<S>; 2], share: f32x16<S>) {
    for (sum, shade) in sum.iter_mut().zip(shade) {
        *sum = three!(k => shade[k].mul_add(share, sum[k]));
    }
}

/// The weighted mean of what a map says under each pixel.
#[inline(always)]
pub(super) fn mean<S: Simd, const N: usize>(
    simd: S,
    texture: &Texture,
    look: &Look,
    at: &Footprint<S>,
    values: impl Fn(u32x16<S>) -> [f32x16<S>; N],
) -> [f32x16<S>; N] {
    let mut sums = [f32x16::splat(simd, 0.0); N];
    texture.taps(
        simd,
        look,
        at,
        #[inline(always)]
        |texel, weight| {
            let found = values(texel);
            for k in 0..N {
                sums[k] = found[k].mul_add(weight, sums[k]);
            }
        },
    );
    sums
}
