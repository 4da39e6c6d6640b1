//! The vectors at a vertex, and three ways to get them at the middle of an edge.

use std::ops::{Add, Mul, Sub};

use glam::{Vec3, Vec4};

use crate::surface::Frame;

/// What of a mesh's vertex, or of any point of its surface, light depends on. Object space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Where it is.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Unit tangent along +u, and the sign of the bitangent as w.
    pub tangent: Vec4,
}

impl Corner {
    /// The point of a triangle with the given barycentric weights: a new corner, where a triangle was cut.
    ///
    /// Normal and tangent are the weighted means, made unit vectors at right angles.
    pub fn mixed(corners: &[Self; 3], weights: [f32; 3]) -> Self {
        let [a, b, c] = corners;
        let [u, v, w] = weights;
        let normal = unit_or(a.normal * u + b.normal * v + c.normal * w, a.normal);
        let tangent = (a.tangent * u + b.tangent * v + c.tangent * w).truncate();
        Self {
            position: a.position * u + b.position * v + c.position * w,
            normal,
            tangent: orthogonal(normal, tangent).extend(a.tangent.w),
        }
    }

    /// The middle between two corners with a frame of its own.
    fn middle(a: &Self, b: &Self, right_angle: bool) -> Self {
        let normal = unit_or(a.normal + b.normal, a.normal);
        let sum = a.tangent.truncate() + b.tangent.truncate();
        let tangent = if right_angle { orthogonal(normal, sum) } else { unit_or(sum, a.tangent.truncate()) };
        Self { position: (a.position + b.position) * 0.5, normal, tangent: tangent.extend(a.tangent.w) }
    }
}

/// `v` as a unit vector, or `otherwise` if it has no direction.
fn unit_or(v: Vec3, otherwise: Vec3) -> Vec3 {
    v.try_normalize().unwrap_or(otherwise)
}

/// The unit vector at right angles to unit vector `n` that is nearest to `t` (Gram-Schmidt).
fn orthogonal(n: Vec3, t: Vec3) -> Vec3 {
    (t - n * n.dot(t)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector())
}

/// One light and the eye, in object space.
#[derive(Debug, Clone, Copy)]
pub struct Viewer<F> {
    /// The unit vector from a point to the light; `None` where it has no direction.
    pub toward: F,
    /// Where the eye is.
    pub eye: Vec3,
}

/// L' and H': directions to the light and of the half vector in a frame's own coordinates (along T, B, N).
///
/// Unit vectors where they were computed, if the frame is orthonormal; in between whatever interpolation makes of
/// them. Both are zero where there is no direction to the light: such light does not count.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rotated {
    /// L'.
    pub light: Vec3,
    /// H'.
    pub half: Vec3,
}

impl Rotated {
    /// At a point, with that point's frame: six products with T, B and N.
    pub fn at<F: Fn(Vec3) -> Option<Vec3>>(corner: &Corner, viewer: &Viewer<F>) -> Self {
        let Some(light) = (viewer.toward)(corner.position) else { return Self::default() };
        let view = (viewer.eye - corner.position).normalize_or_zero();
        let half = (light + view).normalize_or_zero();
        let frame = Frame::from_mikk(corner.normal, corner.tangent);
        let rotate = |v: Vec3| Vec3::new(frame.tangent.dot(v), frame.bitangent.dot(v), frame.normal.dot(v));
        Self { light: rotate(light), half: rotate(half) }
    }

    /// Each vector made a unit vector; one without direction becomes zero.
    pub fn normalized(self) -> Self {
        Self { light: self.light.normalize_or_zero(), half: self.half.normalize_or_zero() }
    }
}

impl Add for Rotated {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { light: self.light + other.light, half: self.half + other.half }
    }
}

impl Sub for Rotated {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { light: self.light - other.light, half: self.half - other.half }
    }
}

impl Mul<f32> for Rotated {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self { light: self.light * factor, half: self.half * factor }
    }
}

/// Where the vectors at the middle of an edge come from.
///
/// Any of them depends on the edge's two ends alone and treats them alike, so triangles that share an edge agree on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Midpoints {
    /// A new frame from the normalised means of normals and of tangents, and the vectors computed anew in it.
    ///
    /// The first way of the source. The means are not at right angles where the surface turns both ways, which lengthens
    /// or shortens the vectors there.
    NewFrames,
    /// The normalised means of the vectors at the ends: the second way of the source.
    ///
    /// The length is right, but the direction misses how the surface, or the light, turns in between.
    AveragedVectors,
    /// As [`Self::NewFrames`], with the tangent made orthogonal to the normal.
    #[default]
    GramSchmidt,
}

impl Midpoints {
    /// The vectors in the middle between two corners, whose own vectors are `at_a` and `at_b`.
    pub fn between<F: Fn(Vec3) -> Option<Vec3>>(
        self,
        (a, at_a): (&Corner, &Rotated),
        (b, at_b): (&Corner, &Rotated),
        viewer: &Viewer<F>,
    ) -> Rotated {
        match self {
            Self::NewFrames => Rotated::at(&Corner::middle(a, b, false), viewer),
            Self::AveragedVectors => (*at_a + *at_b).normalized(),
            Self::GramSchmidt => Rotated::at(&Corner::middle(a, b, true), viewer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(position: [f32; 3], normal: [f32; 3], tangent: [f32; 3], sign: f32) -> Corner {
        Corner { position: position.into(), normal: normal.into(), tangent: Vec3::from(tangent).extend(sign) }
    }

    fn far_away(direction: Vec3) -> Viewer<impl Fn(Vec3) -> Option<Vec3>> {
        Viewer { toward: move |_| direction.try_normalize(), eye: Vec3::new(0.0, 0.0, 1e6) }
    }

    #[test]
    fn light_from_u_is_along_the_tangent_and_the_sign_turns_the_bitangent() {
        // A wall that faces +X; u runs to −Z (to the right as seen from +X), up the picture is +Y.
        let wall = corner([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], 1.0);
        assert_eq!(Rotated::at(&wall, &far_away(Vec3::NEG_Z)).light, Vec3::X);
        assert_eq!(Rotated::at(&wall, &far_away(Vec3::Y)).light, Vec3::Y);
        assert_eq!(Rotated::at(&wall, &far_away(Vec3::X)).light, Vec3::Z);
        let mirrored = Corner { tangent: wall.tangent.truncate().extend(-1.0), ..wall };
        assert_eq!(Rotated::at(&mirrored, &far_away(Vec3::Y)).light, Vec3::NEG_Y);
    }

    #[test]
    fn half_vector_is_between_light_and_eye() {
        let floor = corner([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 1.0);
        let half = Rotated::at(&floor, &far_away(Vec3::X)).half;
        assert!((half - Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())).length() < 1e-6, "{half}");
        // A light straight opposite the eye has no half vector, one in the point itself no direction.
        assert_eq!(Rotated::at(&floor, &far_away(Vec3::NEG_Z)).half, Vec3::ZERO);
        assert_eq!(Rotated::at(&floor, &far_away(Vec3::ZERO)), Rotated::default());
    }

    #[test]
    fn middle_of_a_bent_strip_is_between_its_ends_and_averaging_agrees_where_nothing_twists() {
        let (s, c) = 0.4f32.sin_cos();
        let a = corner([-1.0, 0.0, 0.0], [-s, 0.0, c], [c, 0.0, s], 1.0);
        let b = corner([1.0, 0.0, 0.0], [s, 0.0, c], [c, 0.0, -s], 1.0);
        let viewer = far_away(Vec3::new(0.3, 0.5, 0.8));
        let (at_a, at_b) = (Rotated::at(&a, &viewer), Rotated::at(&b, &viewer));
        let expected = Vec3::new(0.3, 0.5, 0.8).normalize();
        for way in [Midpoints::NewFrames, Midpoints::GramSchmidt] {
            let middle = way.between((&a, &at_a), (&b, &at_b), &viewer);
            assert!((middle.light - expected).length() < 1e-6, "{way:?}: {}", middle.light);
            let swapped = way.between((&b, &at_b), (&a, &at_a), &viewer);
            assert_eq!(middle, swapped, "{way:?} depends on the order of the ends");
        }
        // The component along the axis of the bend stays, and the mean of the others is too short before it is normalised:
        // averaging leans to the axis.
        let averaged = Midpoints::AveragedVectors.between((&a, &at_a), (&b, &at_b), &viewer);
        assert!(averaged.light.is_normalized() && averaged.light.y > expected.y + 0.02, "{}", averaged.light);
    }

    #[test]
    fn gram_schmidt_keeps_unit_length_where_new_frames_do_not() {
        // Twisted: normals turn about Y from one end to the other, tangents about Z.
        let a = corner([0.0; 3], [0.0, 0.0, 1.0], [0.8, 0.6, 0.0], 1.0);
        let b = corner([1.0, 0.0, 0.0], [0.8, 0.0, 0.6], [0.6, 0.0, -0.8], 1.0);
        let viewer = far_away(Vec3::new(-0.5, 0.2, 0.9));
        let (at_a, at_b) = (Rotated::at(&a, &viewer), Rotated::at(&b, &viewer));
        let length = |way: Midpoints| way.between((&a, &at_a), (&b, &at_b), &viewer).light.length();
        assert!((length(Midpoints::GramSchmidt) - 1.0).abs() < 1e-6);
        assert!((length(Midpoints::AveragedVectors) - 1.0).abs() < 1e-6);
        assert!((length(Midpoints::NewFrames) - 1.0).abs() > 1e-3, "{}", length(Midpoints::NewFrames));
    }

    #[test]
    fn opposite_frames_still_give_finite_vectors() {
        let a = corner([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 1.0);
        let b = corner([0.0; 3], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], 1.0);
        let viewer = far_away(Vec3::X);
        let (at_a, at_b) = (Rotated::at(&a, &viewer), Rotated::at(&b, &viewer));
        for way in [Midpoints::NewFrames, Midpoints::AveragedVectors, Midpoints::GramSchmidt] {
            let middle = way.between((&a, &at_a), (&b, &at_b), &viewer);
            assert!(middle.light.is_finite() && middle.half.is_finite(), "{way:?}");
        }
    }

    #[test]
    fn mixed_corner_is_a_vertex_at_its_weight_and_orthonormal_between() {
        let a = corner([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], -1.0);
        let b = corner([1.0, 0.0, 0.0], [0.6, 0.0, 0.8], [0.8, 0.0, -0.6], -1.0);
        let c = corner([0.0, 1.0, 0.0], [0.0, 0.6, 0.8], [1.0, 0.0, 0.0], -1.0);
        assert_eq!(Corner::mixed(&[a, b, c], [0.0, 0.0, 1.0]), c);
        let inside = Corner::mixed(&[a, b, c], [0.2, 0.5, 0.3]);
        let tangent = inside.tangent.truncate();
        assert!((inside.position - Vec3::new(0.5, 0.3, 0.0)).length() < 1e-6);
        assert!(inside.normal.is_normalized() && tangent.is_normalized() && inside.normal.dot(tangent).abs() < 1e-6);
        assert_eq!(inside.tangent.w, -1.0);
    }
}
