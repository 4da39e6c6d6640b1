//! The metallic-roughness BRDF sixteen normals at a time: [`super::microfacet`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

use crate::light::microfacet::{ALBEDO, DIELECTRIC, LEAST_COSINE, Microfacet};
use crate::simd::{Vec3x16, cross, dot, exp2, recip, splat};

/// [`Microfacet::by_light`]: diffuse, dielectric, tinted and white parts.
#[inline(always)]
pub(super) fn facet_by_light<S: Simd>(
    simd: S,
    facet: &Microfacet,
    n: Vec3x16<S>,
    h: Vec3x16<S>,
    view: Vec3x16<S>,
    nl: f32x16<S>,
    nh: f32x16<S>,
) -> [f32x16<S>; 4] {
    let a = facet.alpha;
    let nv = dot(n, view).max(splat(simd, LEAST_COSINE));
    let vh = dot(view, h).max(splat(simd, 0.0)).min(splat(simd, 1.0));
    let across = cross(n, h);
    let anh = nh.max(splat(simd, 0.0)) * a;
    let k = splat(simd, a) / anh.mul_add(anh, dot(across, across));
    let visibility = 0.5 * recip(nv.mul_add(masking(simd, a, nl), nl * masking(simd, a, nv)));
    let glossy = k * k * visibility * nl;
    let t = 1.0 - vh;
    let t2 = t * t;
    let s = t2 * t2 * t;
    let dielectric = s.mul_add(splat(simd, 1.0 - DIELECTRIC), splat(simd, DIELECTRIC));
    [nl * (1.0 - dielectric), glossy * dielectric, glossy * (1.0 - s), glossy * s]
}

/// `√(α² + (1 − α²) c²)`
#[inline(always)]
fn masking<S: Simd>(simd: S, a: f32, c: f32x16<S>) -> f32x16<S> {
    (c * c).mul_add(splat(simd, 1.0 - a * a), splat(simd, a * a)).sqrt()
}

/// [`super::microfacet::albedo`].
#[inline(always)]
pub(super) fn albedo<S: Simd>(simd: S, roughness: f32, nv: f32x16<S>) -> [f32x16<S>; 2] {
    let r = ALBEDO.map(|[slope, offset]| roughness * slope + offset);
    let a004 = exp2(simd, nv * -9.28).min(splat(simd, r[0] * r[0])).mul_add(splat(simd, r[0]), splat(simd, r[1]));
    [a004.mul_add(splat(simd, -1.04), splat(simd, r[2])), a004.mul_add(splat(simd, 1.04), splat(simd, r[3]))]
}
