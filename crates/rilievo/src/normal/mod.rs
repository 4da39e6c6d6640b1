//! Unit normals that know their space, and the integers they are stored as.

mod blue_noise;
mod dither;
mod encode;
mod levels;
mod spread;

use std::marker::PhantomData;

use bytemuck::{TransparentWrapper, TransparentWrapperAlloc};
use glam::Vec3;

pub(crate) use blue_noise::BlueNoise;
pub use dither::{DitherU8, encode_map_u8};
pub use encode::{decode_u8, decode_u16, encode_u8, encode_u16};
pub(crate) use levels::{Cascade, Texel};
pub use levels::{NormalLevels, normal_levels};
pub use spread::spread_normals;

use crate::grid::Grid;
use crate::order::greater;

/// A coordinate space that normals and directions can live in.
pub trait Space: sealed::Sealed + Copy + std::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// The space's name in files and on the command line.
    const NAME: &'static str;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! space {
    ($(#[$doc:meta])* $name:ident, $text:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $name;
        impl sealed::Sealed for $name {}
        impl Space for $name {
            const NAME: &'static str = $text;
        }
    };
}

space!(
    /// The frame of the surface itself: +X along u, +Y up the picture, +Z out.
    Tangent, "tangent"
);
space!(
    /// The space the mesh is modelled in.
    Object, "object"
);
space!(
    /// The space lights and camera are placed in.
    World, "world"
);

/// A unit vector in space `S`: a surface normal, or a direction to a light or an eye.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, TransparentWrapper)]
#[transparent(Unit)]
pub struct Normal<S>(Unit, PhantomData<S>);

/// A unit vector; private, so that nobody makes normals of vectors that are none.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit(Vec3);

/// A normal whose space does not matter.
///
/// A space is a label that no code depends on. Long work is done without it, so that there is one code for it: compiled
/// with this crate, and not for each label in every crate that asks for it.
pub(crate) type Bare = Normal<Object>;

impl<S: Space> Normal<S> {
    /// +X.
    pub const X: Self = Self::of(Vec3::X);
    /// +Y.
    pub const Y: Self = Self::of(Vec3::Y);
    /// +Z: in tangent space, the undisturbed surface.
    pub const Z: Self = Self::of(Vec3::Z);

    const fn of(unit: Vec3) -> Self {
        Self(Unit(unit), PhantomData)
    }

    /// The direction of `v`; `None` if it has none (zero, NaN or infinite).
    ///
    /// Scaled by the largest component first, so that the tiniest and the largest vectors keep their direction.
    pub fn new(v: Vec3) -> Option<Self> {
        let largest = greater(greater(v.x.abs(), v.y.abs()), v.z.abs());
        if !(largest > 0.0 && v.is_finite()) {
            return None;
        }
        let scaled = v / largest;
        // Division, not multiplication by a reciprocal: one rounding less, and the same bits everywhere.
        Some(Self::of(scaled / scaled.length()))
    }

    /// The direction of `v`, or `fallback` if it has none.
    pub fn new_or(v: Vec3, fallback: Self) -> Self {
        Self::new(v).unwrap_or(fallback)
    }

    /// Takes back a vector that came out of a normal: the same bits, where [`Normal::new`] may change the last one.
    pub(crate) fn from_unit(v: Vec3) -> Self {
        debug_assert!((v.length() - 1.0).abs() < 1e-5);
        Self::of(v)
    }

    /// The vector, of unit length within a few ulps.
    pub fn vec(self) -> Vec3 {
        self.0.0
    }

    /// Angle to another direction in the same space, in radians, accurate for small angles too.
    ///
    /// 2·asin(chord / 2) in f64: acos of a dot product loses everything below 0.02°.
    pub fn angle_to(self, other: Self) -> f64 {
        let chord = (self.vec().as_dvec3() - other.vec().as_dvec3()).length();
        2.0 * (chord * 0.5).min(1.0).asin()
    }

    /// The same numbers, declared to be in another space.
    pub fn relabel<T: Space>(self) -> Normal<T> {
        Normal(self.0, PhantomData)
    }

    /// [`Self::relabel`] for many, which stay where they are.
    pub(crate) fn relabel_all<T: Space>(normals: &[Self]) -> &[Normal<T>] {
        Normal::wrap_slice(Self::peel_slice(normals))
    }

    /// [`Self::relabel_all`] for those that are owned.
    pub(crate) fn relabel_vec<T: Space>(normals: Vec<Self>) -> Vec<Normal<T>> {
        Normal::wrap_vec(Self::peel_vec(normals))
    }
}

impl Normal<Tangent> {
    /// The normal of a relief with slopes dh/dx (to the right) and dh/dy (up): `normalize(−dh/dx, −dh/dy, 1)`.
    ///
    /// The slopes must be at most [`crate::height::MAX_HEIGHT`] in size for their squares to stay finite. No branch, so
    /// that loops over texels become vector code.
    pub(crate) fn from_slopes(dx: f32, dy: f32) -> Self {
        let length = (dx * dx + dy * dy + 1.0).sqrt();
        // 0 − x instead of −x: flat ground has no negative zeros.
        Self::of(Vec3::new((0.0 - dx) / length, (0.0 - dy) / length, 1.0 / length))
    }
}

/// One unit normal per texel.
pub type NormalMap<S> = Grid<Normal<S>>;

/// Which way the green channel of a tangent-space normal map points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Convention {
    /// +Y up the picture, as OpenGL, glTF, Blender and Godot have it.
    #[default]
    Gl,
    /// +Y down the picture, as DirectX and Unreal have it.
    Dx,
}

impl Convention {
    /// Converts between this convention and the library's own (+Y up); its own inverse.
    pub fn apply<S: Space>(self, n: Normal<S>) -> Normal<S> {
        match self {
            Self::Gl => n,
            Self::Dx => Normal::of(Vec3::new(n.vec().x, -n.vec().y, n.vec().z)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_keeps_extreme_directions_and_refuses_none() {
        for scale in [1e-38f32, 1e-20, 1.0, 1e20, 1e38] {
            let n = Normal::<Object>::new(Vec3::new(scale, scale, 0.0)).unwrap();
            assert!((n.vec() - Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0)).length() < 1e-6, "{scale}");
        }
        for v in [Vec3::ZERO, Vec3::NAN, Vec3::new(f32::INFINITY, 0.0, 0.0)] {
            assert_eq!(Normal::<Object>::new(v), None);
        }
    }

    #[test]
    fn angle_is_accurate_for_small_angles() {
        let a = Normal::<Tangent>::Z;
        let b = Normal::new(Vec3::new(1e-4, 0.0, 1.0)).unwrap();
        assert!((a.angle_to(b) - 1e-4).abs() < 1e-9);
        assert!((a.angle_to(Normal::new(-Vec3::Z).unwrap()) - std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn dx_is_its_own_inverse() {
        let n = Normal::<Tangent>::new(Vec3::new(0.3, 0.4, 0.5)).unwrap();
        assert_eq!(Convention::Dx.apply(n).vec().y, -n.vec().y);
        assert_eq!(Convention::Dx.apply(Convention::Dx.apply(n)), n);
    }
}
