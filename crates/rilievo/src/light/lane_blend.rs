//! How shades meet a base colour, sixteen at a time: [`super::Shade::over`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use super::Blend;
use crate::simd::splat;

impl Blend {
    /// One component of the light that leaves surfaces of a base colour.
    #[inline(always)]
    pub(crate) fn over<S: Simd>(self, simd: S, diffuse: f32x16<S>, specular: f32x16<S>, base: f32x16<S>) -> f32x16<S> {
        let zero = splat(simd, 0.0);
        match self {
            Self::Exact => {
                let under = diffuse * base;
                (1.0 - under).max(zero).mul_add(specular, under)
            }
            Self::Approximate => (1.0 - base).max(zero).mul_add(specular, diffuse * base),
            Self::Material => diffuse + specular,
            Self::Add => diffuse.mul_add(base, specular),
        }
    }
}
