//! Tangent frames.
use crate::{Normal, Object, Tangent};
use glam::{Vec3, Vec4};
/// Tangent, bitangent and normal of a point, interpolated and NOT normalised (MikkTSpace's convention).
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
    /// From an interpolated normal and tangent: bitangent = sign · cross(normal, tangent).
    pub fn from_mikk(normal: Vec3, tangent: Vec4) -> Self {
        let t = tangent.truncate();
        Self { tangent: t, bitangent: normal.cross(t) * tangent.w, normal }
    }
    /// The tangent-space normal `n` in object space: normalize(n.x T + n.y B + n.z N).
    pub fn to_object(&self, n: Normal<Tangent>) -> Normal<Object> {
        let v = n.vec();
        Normal::new_or(self.tangent * v.x + self.bitangent * v.y + self.normal * v.z, Normal::Z)
    }
}
