//! Where an object stands in the world.

use glam::{Quat, Vec3};

use crate::normal::{Normal, Object, World};

/// Rotation, uniform scale and translation from object space to world space.
///
/// No shear and no uneven scale, so normals and directions turn by the rotation alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Object → world rotation.
    pub rotation: Quat,
    /// Uniform scale, positive.
    pub scale: f32,
    /// World position of the object's origin.
    pub translation: Vec3,
}

impl Pose {
    /// The object's own space is the world.
    pub const IDENTITY: Self = Self { rotation: Quat::IDENTITY, scale: 1.0, translation: Vec3::ZERO };

    /// A turn about +Y by `angle_rad` (counter-clockwise seen from above).
    pub fn turned(angle_rad: f32) -> Self {
        Self { rotation: Quat::from_rotation_y(angle_rad), ..Self::IDENTITY }
    }

    /// A turn about the vertical axis through `center`.
    pub fn turned_about(center: Vec3, angle_rad: f32) -> Self {
        let turned = Self::turned(angle_rad);
        Self { translation: center - turned.rotation * center, ..turned }
    }

    /// A point taken to the world.
    pub fn point_to_world(&self, p: Vec3) -> Vec3 {
        self.rotation * (p * self.scale) + self.translation
    }

    /// A point of the world taken to the object.
    pub fn point_to_object(&self, p: Vec3) -> Vec3 {
        self.rotation.inverse() * ((p - self.translation) / self.scale)
    }

    /// A direction taken to the world.
    pub fn to_world(&self, d: Normal<Object>) -> Normal<World> {
        Normal::new_or(self.rotation * d.vec(), d.relabel())
    }

    /// A direction of the world taken to the object (the inverse of the modelling transform: Tarini 2000, § 5).
    pub fn to_object(&self, d: Normal<World>) -> Normal<Object> {
        Normal::new_or(self.rotation.inverse() * d.vec(), d.relabel())
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_pose() {
        let pose = Pose { rotation: Quat::from_rotation_x(0.7), scale: 2.5, translation: Vec3::new(1.0, -2.0, 3.0) };
        let p = Vec3::new(0.3, 0.2, -0.9);
        assert!((pose.point_to_object(pose.point_to_world(p)) - p).length() < 1e-6);
        let d = Normal::new(p).unwrap();
        assert!(pose.to_object(pose.to_world(d)).angle_to(d) < 1e-6);
    }

    #[test]
    fn turning_about_a_centre_keeps_it() {
        let centre = Vec3::new(3.0, 1.0, -2.0);
        assert!((Pose::turned_about(centre, 1.3).point_to_world(centre) - centre).length() < 1e-6);
    }

    #[test]
    fn turning_left_takes_z_to_x() {
        let d = Pose::turned(std::f32::consts::FRAC_PI_2).to_world(Normal::Z);
        assert!(d.angle_to(Normal::X) < 1e-6);
    }
}
