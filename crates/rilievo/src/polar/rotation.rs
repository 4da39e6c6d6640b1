//! The paper's rotation into the reference space in floating point: what it makes of a vector, and what it should.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use rilievo_polar::Direction;

use super::encode::angle;

/// A direction in radians: φ from +X, θ from the pole +Z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polar {
    /// Azimuth.
    pub phi: f64,
    /// Polar angle.
    pub theta: f64,
}

impl Polar {
    /// The unit vector.
    pub(super) fn cartesian(self) -> DVec3 {
        let (sin, cos) = self.theta.sin_cos();
        DVec3::new(sin * self.phi.cos(), sin * self.phi.sin(), cos)
    }
}

impl From<Direction> for Polar {
    fn from(words: Direction) -> Self {
        let angle = |word: u16| f64::from(word) / 65_536.0 * TAU;
        Self { phi: angle(words.azimuth), theta: angle(words.polar) }
    }
}

impl From<Polar> for Direction {
    /// The nearest binary angles.
    fn from(polar: Polar) -> Self {
        Self { azimuth: angle(polar.phi), polar: angle(polar.theta) }
    }
}

/// A way to rotate a vector into a normal's meridian frame that is not exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rotation {
    /// Eqs. (5) to (9) and (16) to (18) of Lee et al. with their misprints mended.
    Published,
    /// The same with exact Z: what the “angular proportion” of eq. (10) alone leaves.
    ExactZ,
}

impl Rotation {
    /// A vector in the frame of a normal.
    pub fn rotate(self, a: Polar, n: Polar) -> Polar {
        let delta = wrap(a.phi - n.phi);
        // The sines and cosines of θ ± Δ, of which eqs. (5) to (7) take half the sum or difference.
        let (x, y) = (a.theta.sin() * delta.cos(), a.theta.sin() * delta.sin());
        let z = match self {
            Self::Published => arc(x, a.theta.cos()) - n.theta,
            Self::ExactZ => {
                let rotated = exact(a, n);
                arc(rotated.x, rotated.z)
            }
        };
        let z = wrap(z);
        let proportion = (y.abs() / z.cos().abs()).min(1.0).asin() / FRAC_PI_2;
        Polar { phi: y.atan2(z.sin()), theta: z.abs() + (FRAC_PI_2 - z.abs()) * proportion }
    }

    /// The angle between the rotated vector and where it should be, in radians.
    pub fn error_rad(self, a: Polar, n: Polar) -> f64 {
        let (found, expected) = (self.rotate(a, n).cartesian(), exact(a, n));
        found.cross(expected).length().atan2(found.dot(expected))
    }
}

/// R_y(−θN)·R_z(−φN) of a direction, as a unit vector.
pub(super) fn exact(a: Polar, n: Polar) -> DVec3 {
    let v = Polar { phi: a.phi - n.phi, ..a }.cartesian();
    let (sin, cos) = n.theta.sin_cos();
    DVec3::new(v.x * cos - v.z * sin, v.y, v.x * sin + v.z * cos)
}

/// The arc sine of `x`, on the side of the sphere that `z` is on.
fn arc(x: f64, z: f64) -> f64 {
    let arc = x.clamp(-1.0, 1.0).asin();
    if z < 0.0 { PI.copysign(x) - arc } else { arc }
}

/// Between −π and π.
fn wrap(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polar(phi_deg: f64, theta_deg: f64) -> Polar {
        Polar { phi: phi_deg.to_radians(), theta: theta_deg.to_radians() }
    }

    #[test]
    fn the_published_rotation_errs_by_the_known_answers() {
        for (delta, theta_a, theta_n, expected) in [
            (90.0, 90.0, 90.0, 45.0),
            (45.0, 90.0, 90.0, 60.0),
            (45.0, 60.0, 0.0, 7.229),
            (60.0, 45.0, 45.0, 16.20),
            (90.0, 60.0, 30.0, 28.96),
            (0.0, 70.0, 20.0, 0.0),
            (180.0, 35.0, 50.0, 0.0),
        ] {
            let error = Rotation::Published.error_rad(polar(delta, theta_a), polar(0.0, theta_n)).to_degrees();
            assert!((error - expected).abs() < 0.01, "{delta} {theta_a} {theta_n}: {error}");
        }
    }

    #[test]
    fn with_exact_z_the_proportion_is_left() {
        let all = (0..90).flat_map(|t| (0..90).flat_map(move |d| [20, 60].map(|n| (t, d, n))));
        let worst = all.map(|(theta, delta, n)| {
            let (a, n) = (polar(f64::from(delta) * 2.0, f64::from(theta)), polar(0.0, f64::from(n)));
            if exact(a, n).z > 0.0 { Rotation::ExactZ.error_rad(a, n).to_degrees() } else { 0.0 }
        });
        let worst = worst.fold(0.0, f64::max);
        assert!((8.5..8.611).contains(&worst), "{worst}");
    }
}
