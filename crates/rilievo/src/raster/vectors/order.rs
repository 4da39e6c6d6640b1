//! One or two: how much curvature a triangle is worth.

use glam::Vec3;

use crate::raster::vectors::Rotated;

/// The error of brightness that linear interpolation may make, relative to the brightness itself.
///
/// Near white, sRGB codes change by 0.42 · 255 times a relative change of light: this is half a code. What is darker
/// changes by less.
const INVISIBLE: f32 = 0.5 / (0.42 * 255.0);

/// Of which degree the polynomials of a triangle are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Order {
    /// The lower one that looks the same: linear on triangles over which the vectors hardly turn.
    #[default]
    Auto,
    /// Always linear.
    Linear,
    /// Always quadratic.
    Quadratic,
}

impl Order {
    /// Whether a triangle with these vectors at its vertices needs the quadratic polynomial.
    ///
    /// Between unit vectors that are an angle θ apart, the linear one is shortest in the middle: cos(θ/2) long, about
    /// 1 − (1 − cos θ)/4. That error goes into the diffuse light as it is, into the highlight `shininess` times (the
    /// derivative of a power). [`Self::Auto`] compares both with half a step of an 8-bit picture.
    ///
    /// - **Units:** `shininess` is the exponent of the highlight; 0 if there is none.
    pub fn is_quadratic(self, corners: &[Rotated; 3], shininess: f32) -> bool {
        match self {
            Self::Linear => false,
            Self::Quadratic => true,
            Self::Auto => {
                let straight = |vectors, share: f32| shortening(vectors).iter().all(|s| s * share <= INVISIBLE);
                !(straight(corners.map(|c| c.light), 1.0) && straight(corners.map(|c| c.half), shininess))
            }
        }
    }
}

/// How much too short the linear means of any two of the unit vectors are.
fn shortening([a, b, c]: [Vec3; 3]) -> [f32; 3] {
    // |a − b|² / 8 = (1 − cos θ) / 4, without the cancellation for small angles.
    [a.distance_squared(b) / 8.0, a.distance_squared(c) / 8.0, b.distance_squared(c) / 8.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle whose vectors are `degrees` apart along one edge.
    fn bent(light_deg: f32, half_deg: f32) -> [Rotated; 3] {
        let at = |deg: f32| Vec3::new(deg.to_radians().sin(), 0.0, deg.to_radians().cos());
        let start = Rotated { light: Vec3::Z, half: Vec3::Z };
        [start, start, Rotated { light: at(light_deg), half: at(half_deg) }]
    }

    #[test]
    fn given_orders_are_kept() {
        for corners in [bent(0.0, 0.0), bent(90.0, 90.0)] {
            assert!(!Order::Linear.is_quadratic(&corners, 40.0));
            assert!(Order::Quadratic.is_quadratic(&corners, 40.0));
        }
    }

    #[test]
    fn auto_is_linear_exactly_where_eight_bits_cannot_tell() {
        // The true code of brightness b and that of the shortened one, in f64 with the exact curve.
        let code = |b: f64| 255.0 * (1.055 * b.powf(1.0 / 2.4) - 0.055);
        for shininess in [0.0f32, 10.0, 40.0, 200.0] {
            for tenth_deg in 1..400 {
                let deg = tenth_deg as f32 * 0.1;
                let middle = (f64::from(deg).to_radians() * 0.5).cos();
                let worst = [1.0f64, 0.5].map(|b| {
                    let diffuse = code(b) - code(b * middle);
                    let highlight = code(b) - code(b * middle.powf(f64::from(shininess)));
                    diffuse.max(highlight)
                });
                let worst = worst[0].max(worst[1]);
                let quadratic = Order::Auto.is_quadratic(&bent(deg, deg), shininess);
                // A twentieth of a code for the slopes' approximation.
                assert!(quadratic || worst < 0.55, "{deg}° at {shininess} is linear, {worst} codes off");
                assert!(!quadratic || worst > 0.45, "{deg}° at {shininess} is quadratic, {worst} codes off");
            }
        }
    }

    #[test]
    fn matte_surfaces_do_not_care_for_the_half_vector() {
        assert!(!Order::Auto.is_quadratic(&bent(1.0, 60.0), 0.0));
        assert!(Order::Auto.is_quadratic(&bent(1.0, 60.0), 5.0));
    }

    #[test]
    fn what_is_no_number_is_quadratic() {
        assert!(Order::Auto.is_quadratic(&bent(f32::NAN, 0.0), 0.0));
    }
}
