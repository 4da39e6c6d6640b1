//! Tangent frames.

use glam::{Vec3, Vec4};

use crate::{Normal, Object, Tangent};

/// Tangent, bitangent and normal of a point, interpolated and NOT normalised.
///
/// MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited") prescribes that the three are interpolated
/// over the triangle as they are and that only the resulting normal is normalised. A baker that does the same and a
/// renderer that does the same undo each other exactly; normalising or orthogonalising the frame at the pixel breaks that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Along +u.
    pub tangent: Vec3,
    /// Up the picture (−v).
    pub bitangent: Vec3,
    /// Out of the surface.
    pub normal: Vec3,
}

impl Frame {
    /// From a normal and a tangent whose w is the sign: bitangent = w · cross(normal, tangent).
    ///
    /// Both may be interpolated (w is the same at all corners of a triangle).
    pub fn from_mikk(normal: Vec3, tangent: Vec4) -> Self {
        let t = tangent.truncate();
        Self { tangent: t, bitangent: normal.cross(t) * tangent.w, normal }
    }

    /// The tangent-space normal `n` in object space: normalize(n.x T + n.y B + n.z N).
    ///
    /// Where the three cancel, the direction of the interpolated normal, and failing that +Z.
    pub fn to_object(&self, n: Normal<Tangent>) -> Normal<Object> {
        let v = n.vec();
        Normal::new(self.tangent * v.x + self.bitangent * v.y + self.normal * v.z)
            .unwrap_or_else(|| Normal::new_or(self.normal, Normal::Z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_normal_is_the_surface_normal() {
        let frame = Frame::from_mikk(Vec3::new(0.0, 3.0, 0.0), Vec4::new(0.0, 0.0, 0.5, -1.0));
        assert_eq!(frame.to_object(Normal::Z).vec(), Vec3::Y);
        assert_eq!(frame.bitangent, Vec3::new(-1.5, 0.0, 0.0));
    }

    #[test]
    fn lengths_of_the_frame_count() {
        let frame = Frame { tangent: Vec3::X * 2.0, bitangent: Vec3::Y, normal: Vec3::Z };
        let n = Normal::<Tangent>::new(Vec3::new(1.0, 0.0, 1.0)).unwrap();
        let expected = Normal::<Object>::new(Vec3::new(2.0, 0.0, 1.0)).unwrap();
        assert!(frame.to_object(n).angle_to(expected) < 1e-6);
    }

    #[test]
    fn cancelled_frame_has_a_direction() {
        let frame = Frame { tangent: Vec3::ZERO, bitangent: Vec3::ZERO, normal: Vec3::ZERO };
        assert_eq!(frame.to_object(Normal::X), Normal::Z);
        let frame = Frame { normal: Vec3::Y, ..frame };
        assert_eq!(frame.to_object(Normal::X), Normal::Y);
    }
}
