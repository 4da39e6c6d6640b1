//! Who looks, from where.

use glam::{Quat, Vec3};
use rilievo::Result;
use rilievo::surface::Camera;

/// A camera that is placed once the size of the scene is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum CameraSpec {
    /// On an orbit about everything, or about a point.
    Orbit {
        azimuth_rad: f32,
        elevation_rad: f32,
        /// In multiples of the distance at which everything just fits the picture.
        distance: f32,
        fov_y_rad: f32,
        /// The middle of the scene without it.
        target: Option<Vec3>,
    },
    /// At a place in the world.
    Eye {
        eye: Vec3,
        /// The middle of the scene without it.
        target: Option<Vec3>,
        up: Vec3,
        fov_y_rad: f32,
        /// Clipping planes, in the world's units; about the scene without them.
        near: Option<f32>,
        far: Option<f32>,
    },
}

impl CameraSpec {
    /// The camera for a scene within a sphere and a picture of this aspect, carried `turn_rad` further round the vertical
    /// axis through what it looks at.
    pub(crate) fn resolve(&self, (middle, radius): (Vec3, f32), aspect: f32, turn_rad: f32) -> Result<Camera> {
        match *self {
            Self::Orbit { azimuth_rad, elevation_rad, distance, fov_y_rad, target } => {
                let target = target.unwrap_or(middle);
                // All of the scene stays between the clipping planes.
                let reach = radius + target.distance(middle);
                let distance = distance * (radius / reach);
                Camera::orbit((target, reach), azimuth_rad + turn_rad, elevation_rad, distance, fov_y_rad, aspect)
            }
            Self::Eye { eye, target, up, fov_y_rad, near, far } => {
                let target = target.unwrap_or(middle);
                let turn = Quat::from_rotation_y(turn_rad);
                let (eye, up) = (target + turn * (eye - target), turn * up);
                let away = eye.distance(middle);
                let near = near.unwrap_or((away - radius * 1.5).max(radius * 0.01));
                let far = far.unwrap_or(away + radius * 1.5);
                Camera::new(eye, target, up, fov_y_rad, near, far)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: (Vec3, f32) = (Vec3::new(1.0, 2.0, 3.0), 2.0);

    fn orbit(target: Option<Vec3>) -> CameraSpec {
        CameraSpec::Orbit { azimuth_rad: 0.0, elevation_rad: 0.0, distance: 1.2, fov_y_rad: 0.6, target }
    }

    fn at(eye: Vec3) -> CameraSpec {
        CameraSpec::Eye { eye, target: None, up: Vec3::Y, fov_y_rad: 0.6, near: None, far: None }
    }

    #[test]
    fn an_orbit_is_as_far_away_whatever_it_is_about() {
        let distance = |target: Vec3| {
            let camera = orbit(Some(target)).resolve(SCENE, 1.0, 0.0).unwrap();
            (camera.eye() - target).length()
        };
        let about_middle = (orbit(None).resolve(SCENE, 1.0, 0.0).unwrap().eye() - SCENE.0).length();
        assert!((distance(SCENE.0) - about_middle).abs() < 1e-5);
        assert!((distance(Vec3::ZERO) - about_middle).abs() < 1e-4);
    }

    #[test]
    fn cameras_go_round_what_they_look_at() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let eye = at(SCENE.0 + Vec3::Z * 9.0).resolve(SCENE, 1.0, quarter).unwrap().eye();
        assert!((eye - SCENE.0 - Vec3::X * 9.0).length() < 1e-4, "{eye}");
        let eye = orbit(None).resolve(SCENE, 1.0, quarter).unwrap().eye();
        assert!((eye - SCENE.0).x > 1.0 && (eye - SCENE.0).z.abs() < 1e-4, "{eye}");
    }

    #[test]
    fn an_eye_within_the_scene_sees_what_is_near() {
        assert!(at(SCENE.0 + Vec3::Z * 0.5).resolve(SCENE, 1.0, 0.0).is_ok());
        assert!(at(SCENE.0).resolve(SCENE, 1.0, 0.0).is_err());
    }
}
