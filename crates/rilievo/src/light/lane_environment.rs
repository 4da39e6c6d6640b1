//! Mirrors in surroundings, sixteen at a time: [`super::Environment::reflected`].

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use glam::Mat3;

use crate::light::environment::{LEAST_SIDE, Level, MATCAP_RADIUS};
use crate::light::{Environment, Projection};
use crate::simd::{Vec3x16, cross, dot, gather, recip, rsqrt, scale, splat};

/// `v` mirrored at `n`.
#[inline(always)]
pub(super) fn mirrored<S: Simd>(simd: S, n: Vec3x16<S>, v: Vec3x16<S>) -> Vec3x16<S> {
    let twice = dot(n, v) * splat(simd, 2.0);
    [0, 1, 2].map(|i| n[i].mul_sub(twice, v[i]))
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
            [0, 1, 2].map(|i| (far[i] - near[i]).mul_add(splat(simd, share), near[i]))
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
            let at = [dot(n, right), dot(n, cross(view, right))].map(|c| c * MATCAP_RADIUS);
            bilinear(simd, environment.level(0), at)
        }
    }
}

#[inline(always)]
fn turned<S: Simd>(simd: S, by: &Mat3, v: Vec3x16<S>) -> Vec3x16<S> {
    let rows = by.transpose().to_cols_array_2d();
    rows.map(|row| dot(v, row.map(|m| splat(simd, m))))
}

/// `environment::to_square`.
#[inline(always)]
fn to_square<S: Simd>(simd: S, d: Vec3x16<S>) -> [f32x16<S>; 2] {
    let sum = d[0].abs() + d[1].abs() + d[2].abs();
    let [s, t, _] = scale(d, recip(sum));
    let upper = d[2].simd_ge(splat(simd, 0.0));
    let folded = |a: f32x16<S>, other: f32x16<S>| upper.select(a, (1.0 - other.abs()).copysign(a));
    [folded(s, t), folded(t, s)]
}

/// `Level::bilinear`.
#[inline(always)]
fn bilinear<S: Simd>(simd: S, level: &Level, [s, t]: [f32x16<S>; 2]) -> Vec3x16<S> {
    let (width, height) = level.size();
    let place = |c: f32x16<S>, half: f32, side: u32| {
        let at = c.mul_add(splat(simd, half), splat(simd, side as f32 * 0.5 + 0.5));
        at.max(splat(simd, 0.0)).min(splat(simd, side as f32 + 0.999))
    };
    let (x, y) = (place(s, width as f32 * 0.5, width), place(t, height as f32 * -0.5, height));
    let whole = |at: f32x16<S>, side: u32| at.floor().min(splat(simd, side as f32));
    let (column, row) = (whole(x, width), whole(y, height));
    let (fx, fy) = (x - column, y - row);
    let stride = u32x16::splat(simd, level.stride() * 3);
    let first = row.to_int::<u32x16<S>>() * stride + column.to_int::<u32x16<S>>() * 3;
    let below = first + stride;
    let words = level.words();
    let texel = |at: u32x16<S>, i: u32| gather(simd, words, at + i).bitcast::<f32x16<S>>();
    [0, 1, 2].map(|i| {
        let across = |row: u32x16<S>| {
            let (left, right) = (texel(row, i), texel(row, i + 3));
            (right - left).mul_add(fx, left)
        };
        let (top, bottom) = (across(first), across(below));
        (bottom - top).mul_add(fy, top)
    })
}
