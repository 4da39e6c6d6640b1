//! E1: exact rotation, back to polar angles. Takes the published unit's bump-vector map as it is.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | Δ, θ ± θN, θ ± Δ | binary angle, 16 bits | exact | wraps |
//! | u, v, w | Q2.14 | products and halves down | one unit past ±1 |
//! | θ' = acos w | binary angle | address down, mean words; ±1 exact | limited at 1 |
//! | smaller over larger of \|u\|, \|v\| | Q2.14 | reciprocal Q0.16 of a bits after the leading one; product down | none |
//! | φ' = atan2(v, u) | binary angle | address down, words of middles; axes exact | limited at 45° |
//! | inner product | Q2.14 | product down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::rotation::rotate_exactly;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, Polar, azimuth, polar_angle, polar_product};
use crate::rom::{Rom, Sine, Width};

/// From Cartesian back to polar.
#[derive(Debug)]
pub(super) struct ToPolar {
    arc_cosine: Rom,
    reciprocal: Rom,
    arc_tangent: Rom,
}

impl ToPolar {
    pub(super) fn new(width: Width) -> Self {
        Self {
            arc_cosine: Rom::arc_cosine(width),
            reciprocal: Rom::reciprocal(width),
            arc_tangent: Rom::arc_tangent(width),
        }
    }

    #[inline(always)]
    pub(super) fn convert<L: Logic>(&self, l: &L, [u, v, w]: [L::Value; 3]) -> Polar<L::Value> {
        Polar {
            azimuth: azimuth(l, &self.reciprocal, &self.arc_tangent, u, v),
            polar: polar_angle(l, &self.arc_cosine, w),
        }
    }

    pub(super) fn roms(&self) -> [&Rom; 3] {
        [&self.arc_cosine, &self.reciprocal, &self.arc_tangent]
    }
}

/// Exact rotation with polar results.
#[derive(Debug)]
pub(crate) struct E1 {
    sine: Sine,
    to_polar: ToPolar,
}

impl E1 {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width), to_polar: ToPolar::new(width) }
    }
}

impl Unit for E1 {
    const PORTS: &'static [Port] = polar_ports![Bump::Azimuth, Bump::Polar];
    type Fetched<V: Copy> = Polar<V>;
    type Rotated<V: Copy> = Polar<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, _: &L, pixel: Pixel<'_, L>) -> Polar<L::Value> {
        pixel.polar(6)
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Polar<L::Value> {
        self.to_polar.convert(l, rotate_exactly(l, &self.sine, pixel.normal(), pixel.vector(vector)))
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Polar<L::Value>, rotated: Polar<L::Value>, _: Lit) -> L::Value {
        polar_product(l, &self.sine, rotated, bump)
    }

    fn roms(&self) -> Vec<&Rom> {
        let mut roms = vec![self.sine.rom()];
        roms.extend(self.to_polar.roms());
        roms
    }
}
