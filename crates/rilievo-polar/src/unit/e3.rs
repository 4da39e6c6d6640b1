//! E3: exact, and cheaper than the published unit on all three counts.
//!
//! The bump-vector map holds N' as (ξ, ρ, y): N' = (ρ sin ξ, y, ρ cos ξ). Turning it by θN about y is then one addition,
//! and the inner product in the meridian plane one interpolation of cosines:
//! `τ = ξ + θN`, `g = cos(θ + τ) + [cos(θ − τ) − cos(θ + τ)]·k`, `N'·L' = ρ·g + y·v`.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | Δ, τ, θ ± Δ, θ ± τ | binary angle, 16 bits | exact | wraps |
//! | cosines | Q2.14 | address to nearest of 2^(a+2) a turn | none |
//! | k = (1 + cos Δ)/2, v | Q2.14 | down | none |
//! | g | Q2.14 | product down | none |
//! | ρ·g + y·v | Q4.28 to Q2.14 | sum exact, then down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, across, cos, cos_squared_of_half, narrow};
use crate::rom::{Rom, Sine, Width};

/// Exact inner products without a rotated vector.
#[derive(Debug)]
pub(crate) struct E3 {
    sine: Sine,
}

impl E3 {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width) }
    }
}

/// The bump vector, turned by θN.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turned<V> {
    along: V,
    radius: V,
    y: V,
}

/// What is known of a vector before the bump vector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Split<V> {
    polar: V,
    /// cos²(Δ/2)
    k: V,
    /// Its part across the meridian.
    across: V,
}

impl Unit for E3 {
    const PORTS: &'static [Port] = polar_ports![Bump::Along, Bump::Radius, Bump::Component(1)];
    type Fetched<V: Copy> = Turned<V>;
    type Rotated<V: Copy> = Split<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> Turned<L::Value> {
        let along = l.turn(pixel.raw(6), pixel.normal().polar);
        Turned { along, radius: pixel.word(l, 7), y: pixel.word(l, 8) }
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Split<L::Value> {
        let vector = pixel.vector(vector);
        let delta = l.turn_back(vector.azimuth, pixel.normal().azimuth);
        Split {
            polar: vector.polar,
            k: cos_squared_of_half(l, &self.sine, delta),
            across: across(l, &self.sine, vector.polar, delta),
        }
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Turned<L::Value>, vector: Split<L::Value>, _: Lit) -> L::Value {
        let sum = cos(l, &self.sine, l.turn(vector.polar, bump.along));
        let difference = cos(l, &self.sine, l.turn_back(vector.polar, bump.along));
        let g = l.add(sum, l.multiply(l.sub(difference, sum), vector.k, 14));
        narrow(l, l.add(l.multiply(bump.radius, g, 0), l.multiply(bump.y, vector.across, 0)))
    }

    fn roms(&self) -> Vec<&Rom> {
        vec![self.sine.rom()]
    }
}
