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

use super::buffer::pack;
use super::texture::{Footprint, Look, Texture};
use crate::light::Blend;
use crate::raster::texture::TextureFilter;
use crate::simd::{Vec3x16, srgb_code, three};

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
        encode(simd, three!(k => self.over(simd, diffuse[k], specular[k], base[k])))
    }

    /// One component, as [`crate::light::Shade::over`] has it.
    #[inline(always)]
    fn over<S: Simd>(&self, simd: S, diffuse: f32x16<S>, specular: f32x16<S>, base: f32x16<S>) -> f32x16<S> {
        let zero = f32x16::splat(simd, 0.0);
        match self.blend {
            Blend::Exact => {
                let under = diffuse * base;
                (1.0 - under).max(zero).mul_add(specular, under)
            }
            Blend::Approximate => (1.0 - base).max(zero).mul_add(specular, diffuse * base),
            Blend::Material => diffuse + specular,
            Blend::Add => diffuse.mul_add(base, specular),
        }
    }
}

/// Linear light as a pixel.
#[inline(always)]
pub(super) fn encode<S: Simd>(simd: S, light: Vec3x16<S>) -> u32x16<S> {
    pack(simd, three!(k => srgb_code(simd, light[k])))
}

/// Where a block's pixels look, and what is under them where that is a single texel.
#[derive(Clone, Copy)]
pub(super) struct Fetched<S: Simd> {
    at: Footprint<S>,
    nearest: [u32x16<S>; 2],
}

impl<S: Simd> Fetched<S> {
    #[inline(always)]
    fn new(simd: S, at: Footprint<S>, map: Option<(&Texture, &Look)>) -> Self {
        let nearest = match map {
            Some((texture, look)) if look.filter == TextureFilter::Nearest => texture.fetch_nearest(simd, look, &at),
            _ => [u32x16::splat(simd, 0); 2],
        };
        Self { at, nearest }
    }

    /// What a map of vectors says, filtered.
    #[inline(always)]
    fn normal(&self, simd: S, texture: &Texture, look: &Look) -> Vec3x16<S> {
        if look.filter == TextureFilter::Nearest {
            return texture.vector_of(simd, self.nearest, true);
        }
        mean(
            simd,
            texture,
            look,
            &self.at,
            #[inline(always)]
            |texel| texture.vector(simd, texel, true),
        )
    }
}

/// The weighted mean of what a map says under each pixel.
#[inline(always)]
pub(super) fn mean<S: Simd>(
    simd: S,
    texture: &Texture,
    look: &Look,
    at: &Footprint<S>,
    vector: impl Fn(u32x16<S>) -> Vec3x16<S>,
) -> Vec3x16<S> {
    let mut sum = [f32x16::splat(simd, 0.0); 3];
    texture.taps(
        simd,
        look,
        at,
        #[inline(always)]
        |texel, weight| {
            let v = vector(texel);
            sum = three!(k => v[k].mul_add(weight, sum[k]));
        },
    );
    sum
}
