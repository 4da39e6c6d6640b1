//! From object space to the screen, the same bits for every renderer here.
//!
//! Coverage is decided by where vertices snap to, so all renderers must snap them to the same place: one at a time or
//! sixteen, it is the same multiplications, additions and divisions in the same order, none of them fused.
//!
//! - **Determinism:** class A.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x16};
use glam::{DMat4, Mat4, Vec4};

use crate::fill::SUBPIXEL_BITS;
use crate::pose::Pose;
use crate::simd::three;
use crate::surface::Camera;

/// The longest side of a picture, in pixels. Differences of snapped coordinates then fit 23 bits (see [`Projection::guard_band`]).
pub(super) const MAX_PICTURE_SIDE: u32 = 16_384;

/// The farthest that clip coordinates may lie from the centre, in half-pictures, before a triangle is cut: as far as the
/// widest triangle stays within [`MAX_PICTURE_SIDE`], and no farther than this.
const WIDEST_GUARD_BAND: f32 = 8.0;

/// Sub-pixels in a pixel.
const ONE: f32 = (1 << SUBPIXEL_BITS) as f32;

/// How one object's points come to the screen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projection {
    /// Object → clip space, by columns.
    columns: [[f32; 4]; 4],
    size: [f32; 2],
    guard_band: f32,
}

/// A vertex on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ScreenVertex {
    /// Right and down, in sub-pixels.
    pub(super) x: i32,
    pub(super) y: i32,
    /// Depth: 0 at the near plane, 1 at the far plane.
    pub(super) z: f32,
    /// 1/w.
    pub(super) inv_w: f32,
}

impl Projection {
    /// For an object at `pose`, seen by `camera` on a picture of `size` pixels.
    pub(super) fn new(camera: &Camera, pose: &Pose, size: (u32, u32)) -> Self {
        let (width, height) = (size.0 as f32, size.1 as f32);
        let to_world =
            Mat4::from_scale_rotation_translation(glam::Vec3::splat(pose.scale), pose.rotation, pose.translation);
        let to_clip: DMat4 = camera.view_projection(width / height).as_dmat4() * to_world.as_dmat4();
        let longest = size.0.max(size.1) as f32;
        Self {
            columns: to_clip.as_mat4().to_cols_array_2d(),
            size: [width, height],
            guard_band: (MAX_PICTURE_SIDE as f32 / longest).clamp(1.0, WIDEST_GUARD_BAND),
        }
    }

    /// Clip coordinates x and y may be this many times w.
    pub(super) fn guard_band(&self) -> f64 {
        f64::from(self.guard_band)
    }

    /// Clip coordinates of a point (x, y within ±w on the picture, z from 0 to w).
    pub(super) fn clip_position(&self, p: glam::Vec3) -> Vec4 {
        let c = &self.columns;
        Vec4::from_array([0, 1, 2, 3].map(|i| c[0][i] * p.x + c[1][i] * p.y + c[2][i] * p.z + c[3][i]))
    }

    /// A clip-space point inside the guard band and in front of the near plane, snapped to the sub-pixel grid.
    pub(super) fn snap(&self, clip: Vec4) -> ScreenVertex {
        let x = (clip.x / clip.w * 0.5 + 0.5) * self.size[0];
        let y = (0.5 - clip.y / clip.w * 0.5) * self.size[1];
        let snap = |v: f32| (v * ONE).round_ties_even() as i32;
        ScreenVertex { x: snap(x), y: snap(y), z: clip.z / clip.w, inv_w: 1.0 / clip.w }
    }

    /// The planes of the clip volume that a point lies outside of, a bit for each.
    #[cfg(test)]
    pub(super) fn outside(&self, p: Vec4) -> u8 {
        let g = self.guard_band * p.w;
        let distances = [p.z, p.w - p.z, g - p.x, g + p.x, g - p.y, g + p.y];
        // What is no number is outside of everything.
        distances.iter().enumerate().fold(0, |bits, (i, &d)| bits | u8::from(d < 0.0 || d.is_nan()) << i)
    }

    /// [`Self::clip_position`] and [`Self::snap`] of sixteen points, given as x, y and z, and for each the planes of the clip
    /// volume that it lies outside of, a bit for each: near, far, right, left, top, bottom.
    ///
    /// Coordinates of points that are outside are garbage.
    #[inline(always)]
    pub(super) fn project<S: Simd>(&self, simd: S, p: [f32x16<S>; 3]) -> ([ScreenVertex; 16], [u8; 16]) {
        let [cx, cy, cz] = three!(i => self.row(p, i));
        let cw = self.row(p, 3);
        let g = cw * self.guard_band;
        let zero = f32x16::splat(simd, 0.0);
        let mut inside_all = u64::MAX;
        let mut inside = [0; 6];
        for (bits, distance) in inside.iter_mut().zip([cz, cw - cz, g - cx, g + cx, g - cy, g + cy]) {
            *bits = distance.simd_ge(zero).to_bitmask();
            inside_all &= *bits;
        }
        let x = ((cx / cw * 0.5 + 0.5) * self.size[0] * ONE).round_ties_even().to_int::<i32x16<S>>();
        let y = ((0.5 - cy / cw * 0.5) * self.size[1] * ONE).round_ties_even().to_int::<i32x16<S>>();
        let (z, inv_w) = (cz / cw, 1.0 / cw);
        let mut vertices = [ScreenVertex::default(); 16];
        let mut outside = [0; 16];
        for i in 0..16 {
            vertices[i] = ScreenVertex { x: x[i], y: y[i], z: z[i], inv_w: inv_w[i] };
            if inside_all >> i & 1 == 0 {
                for (plane, bits) in inside.iter().enumerate() {
                    outside[i] |= u8::from(bits >> i & 1 == 0) << plane;
                }
            }
        }
        (vertices, outside)
    }

    /// One of the four clip coordinates.
    #[inline(always)]
    fn row<S: Simd>(&self, p: [f32x16<S>; 3], i: usize) -> f32x16<S> {
        let c = &self.columns;
        p[0] * c[0][i] + p[1] * c[1][i] + p[2] * c[2][i] + c[3][i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::levels;
    use fearless_simd::dispatch;
    use glam::Vec3;

    fn projection(size: (u32, u32)) -> Projection {
        let camera = Camera::new(Vec3::new(0.3, 0.9, 2.5), Vec3::ZERO, Vec3::Y, 1.1, 0.5, 6.0).unwrap();
        let pose =
            Pose { rotation: glam::Quat::from_rotation_x(0.4), scale: 0.8, translation: Vec3::new(0.1, 0.2, -0.3) };
        Projection::new(&camera, &pose, size)
    }

    #[test]
    fn sixteen_at_a_time_are_the_same_bits_on_every_level() {
        let mut random = testkit_random();
        for size in [(640, 480), (1, 1), (16_384, 3)] {
            let projection = projection(size);
            for level in levels() {
                for _ in 0..200 {
                    let points: [Vec3; 16] =
                        std::array::from_fn(|_| Vec3::new(random() * 4.0, random() * 4.0, random() * 6.0));
                    let (vertices, outside) = dispatch!(level, simd => {
                        let lane = |k: usize| f32x16::from_fn(simd, |i| points[i][k]);
                        projection.project(simd, [lane(0), lane(1), lane(2)])
                    });
                    for (i, p) in points.into_iter().enumerate() {
                        let clip = projection.clip_position(p);
                        assert_eq!(outside[i], projection.outside(clip), "{level:?}");
                        if outside[i] == 0 {
                            assert_eq!(vertices[i], projection.snap(clip), "{level:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn no_number_is_outside() {
        let projection = projection((64, 64));
        assert_ne!(projection.outside(projection.clip_position(Vec3::new(f32::NAN, 0.0, 0.0))), 0);
        assert_eq!(projection.outside(projection.clip_position(Vec3::ZERO)), 0);
    }

    /// Values of −1 … 1. (The testkit is another copy of this crate to unit tests.)
    fn testkit_random() -> impl FnMut() -> f32 {
        let mut state = 0x9e37_79b9_7f4a_7c15u64;
        move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        }
    }
}
