//! The camera.
use glam::camera::rh::{proj::directx, view::look_at_mat4};
use glam::{Mat4, Vec3};

use crate::error::{Error, Result};

/// A perspective camera in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: Vec3,
    target: Vec3,
    up: Vec3,
    fov_y_rad: f32,
    near: f32,
    far: f32,
}

impl Camera {
    /// At `eye`, looking at `target`, with `up` up the picture and a vertical field of view of `fov_y_rad`.
    ///
    /// The clipping planes stand at `near` and `far` from the eye.
    ///
    /// # Errors
    /// [`Error::Parameter`] if eye and target coincide, `up` is along the view, the field of view is not inside
    /// (0, π), or not 0 < near < far.
    pub fn new(eye: Vec3, target: Vec3, up: Vec3, fov_y_rad: f32, near: f32, far: f32) -> Result<Self> {
        let view = target - eye;
        if !(view.is_finite() && view.length_squared() > 0.0) {
            return Err(Error::parameter("camera eye", eye, "a finite point away from the target"));
        }
        let sideways = view.normalize().cross(up).length_squared();
        if !sideways.is_finite() || sideways <= 1e-12 {
            return Err(Error::parameter("camera up", up, "a direction that is not along the view"));
        }
        if !(fov_y_rad > 0.0 && fov_y_rad < std::f32::consts::PI) {
            return Err(Error::parameter("field of view", fov_y_rad, "an angle between 0 and π"));
        }
        if !(near > 0.0 && near < far && far.is_finite()) {
            return Err(Error::parameter("clipping planes", format_args!("{near} … {far}"), "0 < near < far"));
        }
        Ok(Self { eye, target, up, fov_y_rad, near, far })
    }

    /// A camera on an orbit about a sphere that fits it into the picture.
    ///
    /// Azimuth is counter-clockwise from +Z seen from above, elevation up from the horizon; `distance` is in multiples
    /// of the distance at which the sphere just fits the narrower side of a picture of the given `aspect` (width / height).
    ///
    /// # Errors
    /// As [`Camera::new`], and for a radius or distance that is not positive.
    pub fn orbit(
        (center, radius): (Vec3, f32),
        azimuth_rad: f32,
        elevation_rad: f32,
        distance: f32,
        fov_y_rad: f32,
        aspect: f32,
    ) -> Result<Self> {
        if !(radius > 0.0 && distance > 0.0) {
            return Err(Error::parameter("camera distance", distance, "a positive multiple of the fitting distance"));
        }
        let half_y = fov_y_rad * 0.5;
        let half = half_y.min((half_y.tan() * aspect).atan());
        let away = radius / half.sin() * distance;
        let (sin_e, cos_e) = elevation_rad.sin_cos();
        let (sin_a, cos_a) = azimuth_rad.sin_cos();
        let eye = center + away * Vec3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        // Straight above or below, "up" is where the azimuth points away.
        let up = Vec3::new(-sin_e * sin_a, cos_e, -sin_e * cos_a);
        let near = (away - radius * 1.5).max(radius * 0.01);
        Self::new(eye, center, up, fov_y_rad, near, away + radius * 1.5)
    }

    /// Where the eye is.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// World space → clip space (x, y in ±w, z in 0 … w from near to far), for a picture of the given aspect.
    pub fn view_projection(&self, aspect: f32) -> Mat4 {
        // y up and z from 0 to w, as in Direct3D, Metal and WebGPU.
        directx::perspective(self.fov_y_rad, aspect, self.near, self.far) * look_at_mat4(self.eye, self.target, self.up)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orbit_fits_the_sphere() {
        for aspect in [0.5f32, 1.0, 2.0] {
            let c = Camera::orbit((Vec3::new(1.0, 2.0, 3.0), 2.0), 0.4, 0.3, 1.0, 0.8, aspect).unwrap();
            let vp = c.view_projection(aspect);
            let centre = vp.project_point3(Vec3::new(1.0, 2.0, 3.0));
            assert!(centre.truncate().length() < 1e-5 && (0.0..1.0).contains(&centre.z));
            let worst = (0..1000).fold(0.0f32, |m, i| {
                let (z, t) = (1.0 - (2.0 * i as f32 + 1.0) / 1000.0, i as f32 * 2.4);
                let r = (1.0 - z * z).sqrt();
                let p = vp.project_point3(Vec3::new(1.0, 2.0, 3.0) + 2.0 * Vec3::new(r * t.cos(), r * t.sin(), z));
                m.max(p.x.abs()).max(p.y.abs())
            });
            assert!((0.98..=1.001).contains(&worst), "{aspect}: {worst}");
        }
    }

    #[test]
    fn straight_down_has_an_up() {
        assert!(Camera::orbit((Vec3::ZERO, 1.0), 0.0, std::f32::consts::FRAC_PI_2, 1.0, 0.6, 1.0).is_ok());
        assert!(Camera::new(Vec3::ZERO, Vec3::ZERO, Vec3::Y, 0.6, 0.1, 10.0).is_err());
        assert!(Camera::new(Vec3::Y, Vec3::ZERO, Vec3::Y, 0.6, 0.1, 10.0).is_err());
    }
}
