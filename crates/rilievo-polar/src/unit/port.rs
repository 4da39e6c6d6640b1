//! What the words of a pixel are.

use core::fmt;

/// A vector of the surface or of a light, in object space, of unit length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vector {
    /// Towards the light, L.
    Light,
    /// Halfway between light and eye, H.
    Half,
    /// The texture frame's first axis, T.
    Tangent,
    /// Its second, B.
    Bitangent,
    /// The interpolated normal, N.
    Normal,
}

impl Vector {
    const fn letter(self) -> &'static str {
        match self {
            Self::Light => "L",
            Self::Half => "H",
            Self::Tangent => "T",
            Self::Bitangent => "B",
            Self::Normal => "N",
        }
    }
}

/// A word of the bump-vector map, of N' = (x, y, z) in reference space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bump {
    /// φ' = atan2(y, x), binary angle.
    Azimuth,
    /// θ' = acos z, binary angle.
    Polar,
    /// ξ = atan2(x, z), binary angle: along the meridian.
    Along,
    /// η = asin y, binary angle: across the meridian.
    Across,
    /// ρ = √(x² + z²), Q2.14.
    Radius,
    /// x, y or z, Q2.14.
    Component(usize),
    /// −x/z or −y/z, Q4.12: the slope of the height along u (0) or v upwards (1).
    Slope(usize),
}

/// What a port of a unit takes: one 16-bit word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Port {
    /// φ of a vector in object space, binary angle; 0 at the poles.
    Azimuth(Vector),
    /// θ of a vector in object space, binary angle from 0 to half a turn.
    Polar(Vector),
    /// x, y or z of a vector in object space, Q2.14.
    Component(Vector, usize),
    /// A word of the bump-vector map.
    Bump(Bump),
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = |k: usize| ["x", "y", "z"][k];
        match *self {
            Self::Azimuth(vector) => write!(f, "phi_{}", vector.letter()),
            Self::Polar(vector) => write!(f, "theta_{}", vector.letter()),
            Self::Component(vector, k) => write!(f, "{}_{}", axis(k), vector.letter()),
            Self::Bump(Bump::Azimuth) => f.write_str("phi_bump"),
            Self::Bump(Bump::Polar) => f.write_str("theta_bump"),
            Self::Bump(Bump::Along) => f.write_str("xi_bump"),
            Self::Bump(Bump::Across) => f.write_str("eta_bump"),
            Self::Bump(Bump::Radius) => f.write_str("rho_bump"),
            Self::Bump(Bump::Component(k)) => write!(f, "{}_bump", axis(k)),
            Self::Bump(Bump::Slope(k)) => write!(f, "slope_{}", ["u", "v"][k]),
        }
    }
}

/// The ports of a unit whose vectors are polar, with those of its bump words.
macro_rules! polar_ports {
    ($($bump:expr),*) => {
        &[
            Port::Azimuth(Vector::Light),
            Port::Polar(Vector::Light),
            Port::Azimuth(Vector::Half),
            Port::Polar(Vector::Half),
            Port::Azimuth(Vector::Normal),
            Port::Polar(Vector::Normal),
            $(Port::Bump($bump)),*
        ]
    };
}
pub(crate) use polar_ports;

/// The ports of a unit that takes Cartesian vectors and a frame, with those of its bump words.
macro_rules! cartesian_ports {
    ($($bump:expr),*) => {
        &[
            Port::Component(Vector::Light, 0),
            Port::Component(Vector::Light, 1),
            Port::Component(Vector::Light, 2),
            Port::Component(Vector::Half, 0),
            Port::Component(Vector::Half, 1),
            Port::Component(Vector::Half, 2),
            Port::Component(Vector::Tangent, 0),
            Port::Component(Vector::Tangent, 1),
            Port::Component(Vector::Tangent, 2),
            Port::Component(Vector::Bitangent, 0),
            Port::Component(Vector::Bitangent, 1),
            Port::Component(Vector::Bitangent, 2),
            Port::Component(Vector::Normal, 0),
            Port::Component(Vector::Normal, 1),
            Port::Component(Vector::Normal, 2),
            $(Port::Bump($bump)),*
        ]
    };
}
pub(crate) use cartesian_ports;
