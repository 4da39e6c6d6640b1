//! The polar units in f64, straight from their equations.
//!
//! Numbers of equations are those of Lee et al., "An effective bump mapping hardware architecture using polar coordinate
//! system", with their misprints mended.

use core::f64::consts::{FRAC_PI_2, PI, TAU};
use glam::DVec3;
use rilievo_polar::{Direction, Sample};

use crate::Random;

/// A direction by its azimuth from x and its polar angle from z, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polar {
    /// φ.
    pub phi: f64,
    /// θ.
    pub theta: f64,
}

impl Polar {
    /// What a vector's angles are.
    pub fn of(v: DVec3) -> Self {
        Self { phi: v.y.atan2(v.x), theta: v.truncate().length().atan2(v.z) }
    }

    /// The unit vector.
    pub fn cartesian(self) -> DVec3 {
        let (sin, cos) = self.theta.sin_cos();
        DVec3::new(sin * self.phi.cos(), sin * self.phi.sin(), cos)
    }

    /// Uniform on the upper half of the sphere.
    pub fn upper(random: &mut Random) -> Self {
        Self { phi: TAU * random.unit(), theta: random.unit().acos() }
    }

    /// The nearest binary angles.
    pub fn words(self) -> Direction {
        let word = |angle: f64| (angle / TAU * 65536.0).round() as i64 as u16;
        Direction { azimuth: word(self.phi), polar: word(self.theta) }
    }
}

impl From<Direction> for Polar {
    fn from(words: Direction) -> Self {
        let angle = |word: u16| f64::from(word) / 65536.0 * TAU;
        Self { phi: angle(words.azimuth), theta: angle(words.polar) }
    }
}

/// An angle between −π and π.
pub fn wrap(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// R_y(−θN)·R_z(−φN) applied to `a`: the meridian frame of `n`.
pub fn exact(a: Polar, n: Polar) -> DVec3 {
    let delta = a.phi - n.phi;
    let [x, y, z] = [a.theta.sin() * delta.cos(), a.theta.sin() * delta.sin(), a.theta.cos()];
    let (sin, cos) = n.theta.sin_cos();
    DVec3::new(x * cos - z * sin, y, x * sin + z * cos)
}

/// The published rotation, eqs. (5)-(9) and (16)-(18).
pub fn published(a: Polar, n: Polar) -> Polar {
    let (x, y) = plane(a, n);
    let theta_x = x.clamp(-1.0, 1.0).asin();
    // The arc sine loses the sign of z.
    let theta_x = if a.theta > FRAC_PI_2 { PI.copysign(x) - theta_x } else { theta_x };
    place(wrap(theta_x - n.theta), y)
}

/// The published rotation with exact Z.
pub fn exact_z(a: Polar, n: Polar) -> Polar {
    let rotated = exact(a, n);
    let z = rotated.x.clamp(-1.0, 1.0).asin();
    let z = if rotated.z < 0.0 { PI.copysign(rotated.x) - z } else { z };
    place(wrap(z), rotated.y)
}

/// `(sin X + sin Y)/2` and `(cos Y − cos X)/2`, X = θ + Δ, Y = θ − Δ.
fn plane(a: Polar, n: Polar) -> (f64, f64) {
    let delta = wrap(a.phi - n.phi);
    let (x, y) = (a.theta + delta, a.theta - delta);
    ((x.sin() + y.sin()) / 2.0, (y.cos() - x.cos()) / 2.0)
}

/// Eqs. (9), (16), (18).
fn place(z: f64, y: f64) -> Polar {
    let proportion = (y.abs() / z.cos().abs()).min(1.0).asin() / FRAC_PI_2;
    Polar { phi: y.atan2(z.sin()), theta: z.abs() + (FRAC_PI_2 - z.abs()) * proportion }
}

/// `(u, v, w)` without a matrix, as E1 and E2 have it.
pub fn uvw(a: Polar, n: Polar) -> DVec3 {
    let delta = a.phi - n.phi;
    let k = (delta / 2.0).cos().powi(2);
    let (sum, difference) = (a.theta + n.theta, a.theta - n.theta);
    DVec3::new(
        (sum.sin() + difference.sin()) * k - sum.sin(),
        ((a.theta - delta).cos() - (a.theta + delta).cos()) / 2.0,
        sum.cos() + (difference.cos() - sum.cos()) * k,
    )
}

/// Inner product of polar directions, eqs. (24), (25).
pub fn polar_product(a: Polar, b: Polar) -> f64 {
    let (sum, difference) = ((a.theta + b.theta).cos(), (a.theta - b.theta).cos());
    0.5 * (sum + difference) + 0.5 * (difference - sum) * (a.phi - b.phi).cos()
}

/// Inner product with a bump vector in the meridian frame, as E3 has it.
pub fn e3(a: Polar, n: Polar, bump: DVec3) -> f64 {
    let delta = a.phi - n.phi;
    let (xi, rho) = (bump.x.atan2(bump.z), bump.x.hypot(bump.z));
    let tau = xi + n.theta;
    let (sum, difference) = ((a.theta + tau).cos(), (a.theta - tau).cos());
    let g = sum + (difference - sum) * (delta / 2.0).cos().powi(2);
    rho * g + bump.y * ((a.theta - delta).cos() - (a.theta + delta).cos()) / 2.0
}

/// Inner product with a bump vector in the meridian frame, as E4 has it.
pub fn e4(a: Polar, n: Polar, bump: DVec3) -> f64 {
    let delta = a.phi - n.phi;
    let eta = (a.theta.sin() * delta.sin()).asin();
    let xi = (a.theta.sin() * delta.cos()).atan2(a.theta.cos());
    let (bump_xi, bump_eta) = (bump.x.atan2(bump.z), bump.y.clamp(-1.0, 1.0).asin());
    let (sum, difference) = ((bump_eta + eta).cos(), (bump_eta - eta).cos());
    (difference + sum) * ((bump_xi + n.theta - xi) / 2.0).cos().powi(2) - sum
}

/// `N'·L'` and `N'·H'` of a sample, exactly.
pub fn exact_products(sample: &Sample) -> [f64; 2] {
    let bump = Polar::from(sample.bump).cartesian();
    [sample.light, sample.half].map(|vector| exact(vector.into(), sample.normal.into()).dot(bump))
}
