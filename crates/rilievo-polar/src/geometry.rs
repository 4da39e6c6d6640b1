//! Directions to test units with, and the words they are at any unit's ports.

use alloc::vec::Vec;

use crate::frame::Direction;
use crate::model::UnitKind;
use crate::rom::exact::{ONE, arc_sine, arc_tangent, nearest_quotient, sin_cos};
use crate::rom::{FRACTION, QUARTER};
use crate::unit::{Bump, Port, Vector};

/// The geometry of a pixel, the same for all units: vectors in object space, the bump vector in the normal's meridian
/// frame (first axis along the meridian, away from +z; second along the parallel).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sample {
    /// Towards the light.
    pub light: Direction,
    /// Halfway between light and eye.
    pub half: Direction,
    /// The normal.
    pub normal: Direction,
    /// The bump vector.
    pub bump: Direction,
}

impl Sample {
    /// Every combination of vectors along the axes, and of bump vectors upright, at 45° and lying: 20 736.
    pub fn corners() -> impl Iterator<Item = Self> {
        let vectors = || directions([0, 1 << 14, 1 << 15]);
        vectors().flat_map(move |light| {
            vectors().flat_map(move |half| {
                vectors().flat_map(move |normal| {
                    directions([0, 1 << 13, 1 << 14]).map(move |bump| Self { light, half, normal, bump })
                })
            })
        })
    }

    /// Endless samples anywhere on their spheres (bump vectors up to 90°), the same for the same seed.
    pub fn random(seed: u64) -> impl Iterator<Item = Self> {
        let mut state = seed;
        core::iter::from_fn(move || {
            let mut direction = |most: u64| {
                let word = split_mix(&mut state);
                let share = (word >> 16) & 0xffff_ffff;
                Direction { azimuth: word as u16, polar: ((share * (most + 1)) >> 32) as u16 }
            };
            Some(Self {
                light: direction(1 << 15),
                half: direction(1 << 15),
                normal: direction(1 << 15),
                bump: direction(1 << 14),
            })
        })
    }

    /// Its words at the ports of a unit. Frames are the meridian's, so there is no twist.
    pub fn words(&self, unit: UnitKind) -> Vec<u16> {
        unit.ports().iter().map(|port| self.word(*port)).collect()
    }

    fn word(&self, port: Port) -> u16 {
        match port {
            Port::Azimuth(vector) => self.direction(vector).0 as u16,
            Port::Polar(vector) => self.direction(vector).1 as u16,
            Port::Component(vector, k) => value(cartesian(self.direction(vector))[k]),
            Port::Bump(bump) => self.bump_word(bump),
        }
    }

    /// Azimuth and polar angle, which for an axis of the frame may be past half a turn.
    fn direction(&self, vector: Vector) -> (i64, i64) {
        let plain = |direction: Direction| (i64::from(direction.azimuth), i64::from(direction.polar));
        let (azimuth, polar) = plain(self.normal);
        match vector {
            Vector::Light => plain(self.light),
            Vector::Half => plain(self.half),
            Vector::Normal => (azimuth, polar),
            Vector::Tangent => (azimuth, polar + QUARTER),
            Vector::Bitangent => (azimuth + QUARTER, QUARTER),
        }
    }

    fn bump_word(&self, bump: Bump) -> u16 {
        let (azimuth, polar) = (self.bump.azimuth, self.bump.polar);
        let [x, y, z] = cartesian((azimuth.into(), polar.into()));
        match bump {
            Bump::Azimuth => azimuth,
            Bump::Polar => polar,
            Bump::Along => {
                let arc = arc_tangent(x.abs(), z.abs(), QUARTER as u32) as u16;
                if x < 0 { arc.wrapping_neg() } else { arc }
            }
            Bump::Across => {
                let arc = arc_sine(y.abs().min(ONE), QUARTER as u32) as u16;
                if y < 0 { arc.wrapping_neg() } else { arc }
            }
            Bump::Radius => value((x * x + z * z).isqrt()),
            Bump::Component(k) => value([x, y, z][k]),
            Bump::Slope(k) => {
                // Q4.12 of −x/z, limited to ±8.
                let slope = (-[x, y][k] << 12) / z.max(1);
                slope.clamp(-(1 << 15), (1 << 15) - 1) as i16 as u16
            }
        }
    }
}

/// Four azimuths for each polar angle: the poles have an azimuth too, which must not matter.
fn directions(polar: [u16; 3]) -> impl Iterator<Item = Direction> {
    polar.into_iter().flat_map(|polar| (0..4).map(move |quarter| Direction { azimuth: quarter << 14, polar }))
}

/// x, y, z with 60 binary places.
fn cartesian((azimuth, polar): (i64, i64)) -> [i128; 3] {
    let (sin_azimuth, cos_azimuth) = sin_cos(i128::from(azimuth) << 44);
    let (sin, cos) = sin_cos(i128::from(polar) << 44);
    [(sin * cos_azimuth) >> 60, (sin * sin_azimuth) >> 60, cos]
}

/// Q2.14, to the nearest.
fn value(exact: i128) -> u16 {
    let magnitude = nearest_quotient(exact.abs() << FRACTION, ONE) as i16;
    (if exact < 0 { -magnitude } else { magnitude }) as u16
}

/// SplitMix64 (Steele, Lea, Flood 2014).
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut word = *state;
    word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}
