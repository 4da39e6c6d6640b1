//! Mirrors in surroundings, sixteen at a time: [`super::Environment::reflected`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use glam::Mat3;

use crate::light::environment::{LEAST_SIDE, Level, MATCAP_RADIUS};
use crate::light::{Environment, Projection};
use crate::simd::{Vec3x16, cross, dot, gather, recip, rsqrt, scale, splat, splat3, three};

/// `v` mirrored at `n`.
#[inline(always)]
pub(super) fn mirrored<S: Simd>(simd: S, n: Vec3x16<S>, v: Vec3x16<S>) -> Vec3x16<S> {
    let twice = dot(n, v) * splat(simd, 2.0);
    three!(k => n[k].mul_sub(twice, v[k]))
}

/// What mirrors show; `to_sky` takes normals and eyes to the space of the environment.
#[inline(always)]
pub(super) fn reflected<S: Simd>(
    simd: S,
    environment: &Environment,
    to_sky: &Mat3,
    n: Vec3x16<S>,
    view: Vec3x16<S>,
    roughness: f32,
) -> Vec3x16<S> {
    match environment.projection() {
        Projection::Equirectangular => {
            let at = to_square(simd, turned(simd, to_sky, mirrored(simd, n, view)));
            let (level, share) = environment.blend(roughness);
            let near = bilinear(simd, environment.level(level), at);
            if share == 0.0 {
                return near;
            }
            let far = bilinear(simd, environment.level(level + 1), at);
            three!(k => (far[k] - near[k]).mul_add(splat(simd, share), near[k]))
        }
        Projection::Matcap => {
            let (n, view) = (turned(simd, to_sky, n), turned(simd, to_sky, view));
            let squared = view[2].mul_add(view[2], view[0] * view[0]);
            let aside = squared.simd_gt(splat(simd, LEAST_SIDE * LEAST_SIDE));
            let by_length = rsqrt(simd, squared.max(splat(simd, LEAST_SIDE * LEAST_SIDE)));
            let right = [
                aside.select(view[2] * by_length, splat(simd, 1.0)),
                splat(simd, 0.0),
                aside.select(-view[0] * by_length, splat(simd, 0.0)),
            ];
            let at = [dot(n, right) * MATCAP_RADIUS, dot(n, cross(view, right)) * MATCAP_RADIUS];
            bilinear(simd, environment.level(0), at)
        }
    }
}

#[inline(always)]
fn turned<S: Simd>(simd: S, by: &Mat3, v: Vec3x16<S>) -> Vec3x16<S> {
    let rows = by.transpose().to_cols_array_2d();
    three!(k => dot(v, splat3(simd, rows[k])))
}

/// `environment::to_square`.
#[inline(always)]
fn to_square<S: Simd>(simd: S, d: Vec3x16<S>) -> [f32x16<S>; 2] {
    let sum = d[0].abs() + d[1].abs() + d[2].abs();
    let [s, t, _] = scale(d, recip(sum));
    let upper = d[2].simd_ge(splat(simd, 0.0));
    [upper.select(s, (1.0 - t.abs()).copysign(s)), upper.select(t, (1.0 - s.abs()).copysign(t))]
}

/// `Level::bilinear`.
#[inline(always)]
fn bilinear<S: Simd>(simd: S, level: &Level, [s, t]: [f32x16<S>; 2]) -> Vec3x16<S> {
    let (width, height) = level.size();
    let (column, fx) = place(simd, s * 0.5, width);
    let (row, fy) = place(simd, t * -0.5, height);
    let stride = u32x16::splat(simd, level.stride() * 3);
    let first = row * stride + column * 3;
    let below = first + stride;
    let words = level.words();
    three!(k => {
        let top = across(simd, words, first + k as u32, fx);
        let bottom = across(simd, words, below + k as u32, fx);
        (bottom - top).mul_add(fy, top)
    })
}

/// Column or row of `c` (−½ … ½) on a bordered side, and the fraction.
#[inline(always)]
fn place<S: Simd>(simd: S, c: f32x16<S>, side: u32) -> (u32x16<S>, f32x16<S>) {
    let at = c.mul_add(splat(simd, side as f32), splat(simd, side as f32 * 0.5 + 0.5));
    let at = at.max(splat(simd, 0.0)).min(splat(simd, side as f32 + 0.999));
    let whole = at.floor().min(splat(simd, side as f32));
    (whole.to_int::<u32x16<S>>(), at - whole)
}

/// A component between a texel and the next in its row.
#[inline(always)]
fn across<S: Simd>(simd: S, words: &[u32], at: u32x16<S>, share: f32x16<S>) -> f32x16<S> {
    let left = gather(simd, words, at).bitcast::<f32x16<S>>();
    let right = gather(simd, words, at + 3).bitcast::<f32x16<S>>();
    (right - left).mul_add(share, left)
}
