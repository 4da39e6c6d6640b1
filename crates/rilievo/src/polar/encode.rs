//! Directions and normals as the 16-bit words of a polar unit.

use glam::Vec3;
use rilievo_polar::{Bump, FRACTION, Port, Vector};

/// What the words of a pixel stand for: vectors in object space, [`upright`], of unit length, T and B at right angles to N.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Geometry {
    pub(crate) light: Vec3,
    pub(crate) half: Vec3,
    pub(crate) tangent: Vec3,
    pub(crate) bitangent: Vec3,
    pub(crate) normal: Vec3,
}

impl Geometry {
    /// The word at a port that is not the map's.
    pub(crate) fn word(&self, port: Port) -> Option<u16> {
        match port {
            Port::Azimuth(vector) => Some(azimuth(self.vector(vector))),
            Port::Polar(vector) => Some(polar_angle(self.vector(vector))),
            Port::Component(vector, k) => Some(value(self.vector(vector)[k], FRACTION)),
            Port::Bump(_) => None,
        }
    }

    fn vector(&self, vector: Vector) -> Vec3 {
        match vector {
            Vector::Light => self.light,
            Vector::Half => self.half,
            Vector::Tangent => self.tangent,
            Vector::Bitangent => self.bitangent,
            Vector::Normal => self.normal,
        }
    }
}

/// A vector of the object in the axes of a unit, whose pole is +Z: objects stand upright on +Y, and a pole at the top and the
/// bottom shows less than one that looks at the viewer.
pub(crate) fn upright(v: Vec3) -> Vec3 {
    Vec3::new(v.z, v.x, v.y)
}

/// A word of a bump-vector map for the unit normal `n` in reference space.
pub(crate) fn bump_word(bump: Bump, n: Vec3) -> u16 {
    match bump {
        Bump::Azimuth => azimuth(n),
        Bump::Polar => polar_angle(n),
        Bump::Along => angle(n.x.atan2(n.z)),
        Bump::Across => angle(n.y.clamp(-1.0, 1.0).asin()),
        Bump::Radius => value(n.x.hypot(n.z), FRACTION),
        Bump::Component(k) => value(n[k], FRACTION),
        // Lying normals end at the steepest slope there is.
        Bump::Slope(k) => value(-n[k] / n.z.max(1e-6), 12),
    }
}

/// φ; at the poles, where there is none, 0.
pub(crate) fn azimuth(v: Vec3) -> u16 {
    if v.x == 0.0 && v.y == 0.0 { 0 } else { angle(v.y.atan2(v.x)) }
}

/// θ, by the arc tangent: the arc cosine of f32 loses angles near the poles.
pub(crate) fn polar_angle(v: Vec3) -> u16 {
    angle(v.x.hypot(v.y).atan2(v.z))
}

/// The nearest binary angle: a turn is 2¹⁶.
pub(crate) fn angle(radians: impl Into<f64>) -> u16 {
    // Rounded as a number with a sign, so that −0.4 of a unit is 0 and not the whole turn.
    (radians.into() / std::f64::consts::TAU * 65_536.0).round() as i64 as u16
}

/// The nearest word with that many fractional bits, or the last one.
fn value(x: f32, fraction: u32) -> u16 {
    let word = (f64::from(x) * f64::from(1u32 << fraction)).round();
    word.clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16 as u16
}

/// The meridian frame of a normal: the first axis along its meridian, away from +Z, the second along its parallel.
///
/// At the poles, where φ is 0 by definition, the axes are +X and ±Y.
pub(crate) fn meridian_frame(normal: Vec3) -> [Vec3; 3] {
    let level = normal.truncate().length();
    let (cos, sin) = if level > 0.0 { (normal.x / level, normal.y / level) } else { (1.0, 0.0) };
    [Vec3::new(normal.z * cos, normal.z * sin, -level), Vec3::new(-sin, cos, 0.0), normal]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meridian_frames_are_right_handed_and_fit_their_angles() {
        for n in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::new(0.48, -0.6, 0.64), Vec3::new(-0.36, 0.48, -0.8)] {
            let [along, across, normal] = meridian_frame(n);
            assert!(along.cross(across).distance(normal) < 1e-6, "{n}");
            // Increasing θ moves along the meridian.
            let phi = if n.truncate().length() > 0.0 { n.y.atan2(n.x) } else { 0.0 };
            let theta = n.z.acos() + 1e-3;
            let moved = Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            assert!((moved - n).normalize().dot(along) > 0.999, "{n}");
        }
    }

    #[test]
    fn angles_wrap_and_values_end() {
        assert_eq!([angle(0.0), angle(-1e-6), angle(std::f32::consts::PI)], [0, 0, 1 << 15]);
        assert_eq!(angle(-std::f32::consts::FRAC_PI_2), 3 << 14);
        assert_eq!([value(1.0, FRACTION), value(-1.0, FRACTION)], [1 << 14, 0xc000]);
        assert_eq!(bump_word(Bump::Slope(0), -Vec3::X), i16::MAX as u16);
        assert_eq!([azimuth(Vec3::Z), azimuth(-Vec3::Z), polar_angle(-Vec3::Z)], [0, 0, 1 << 15]);
    }
}
