//! The methods, one room each, of the same shape: what they want of a vertex, of a triangle, of sixteen pixels.

mod exact;
mod pixel;
mod table;

pub(super) use exact::{Exact, Lit};
pub(super) use pixel::Pixelwise;
pub(super) use table::{Filtered, Nearest, Shades};

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

use super::buffer::pack;
use super::texture::{Footprint, Look, Texture};
use crate::light::Blend;
use crate::simd::{Vec3x16, srgb_code};

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
        let one = f32x16::splat(simd, 1.0);
        let base = self.base.map_or([one; 3], |base| {
            let mut sum = [f32x16::splat(simd, 0.0); 3];
            base.texture.taps(simd, &base.look, at, |texel, weight| {
                let color = base.texture.vector(simd, texel, false);
                sum = [0, 1, 2].map(|k| color[k].mul_add(weight, sum[k]));
            });
            sum
        });
        let rest = |c: f32x16<S>| (1.0 - c).max(f32x16::splat(simd, 0.0));
        let over = |k: usize| {
            let (diffuse, specular, base) = (diffuse[k], specular[k], base[k]);
            match self.blend {
                Blend::Exact => {
                    let under = diffuse * base;
                    rest(under).mul_add(specular, under)
                }
                Blend::Approximate => rest(base).mul_add(specular, diffuse * base),
                Blend::Material => diffuse + specular,
                Blend::Add => diffuse.mul_add(base, specular),
            }
        };
        encode(simd, [over(0), over(1), over(2)])
    }
}

/// Linear light as a pixel.
#[inline(always)]
pub(super) fn encode<S: Simd>(simd: S, light: Vec3x16<S>) -> u32x16<S> {
    pack(simd, light.map(|c| srgb_code(simd, c)))
}
