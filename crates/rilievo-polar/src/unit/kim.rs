//! Kim's unit: vectors are polar, but go to reference space by a matrix; inner products by eqs. (3), (4).
//!
//! The text gives the cost of the set-up (31 multipliers, 18 adders, 6 tables) but not its structure. What runs here is
//! one: sines and cosines of the four angles, the matrix R_y(−θN)·R_z(−φN), and the way back to polar angles that E1 takes.
//! Its printed cost is quoted; the inner products are as their equations say, and counted.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | sines, cosines, products of two | Q2.14 | address to nearest; products down | none |
//! | rotated vector | Q4.28 to Q2.14 | sum exact, then down | a few units past ±1 |
//! | φ', θ' | binary angle | as in E1 | as in E1 |
//! | cos θ cos θ' + sin θ sin θ' cos(φ − φ') | Q2.14 | each product down | a few units past ±1 |

use alloc::vec;
use alloc::vec::Vec;

use super::e1::ToPolar;
use super::port::polar_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, Polar, cos, dot, narrow, sin, sin_cos};
use crate::rom::{Rom, Sine, Width};

/// Kim's unit.
#[derive(Debug)]
pub(crate) struct Kim {
    sine: Sine,
    to_polar: ToPolar,
}

impl Kim {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width), to_polar: ToPolar::new(width) }
    }
}

impl Unit for Kim {
    const PORTS: &'static [Port] = polar_ports![Bump::Azimuth, Bump::Polar];
    type Fetched<V: Copy> = Polar<V>;
    type Rotated<V: Copy> = Polar<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, _: &L, pixel: Pixel<'_, L>) -> Polar<L::Value> {
        pixel.polar(6)
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Polar<L::Value> {
        let (normal, vector) = (pixel.normal(), pixel.vector(vector));
        let [sin_turn, cos_turn] = sin_cos(l, &self.sine, normal.azimuth);
        let [sin_tilt, cos_tilt] = sin_cos(l, &self.sine, normal.polar);
        let [sin_azimuth, cos_azimuth] = sin_cos(l, &self.sine, vector.azimuth);
        let [sin_polar, z] = sin_cos(l, &self.sine, vector.polar);
        let product = |a, b| l.multiply(a, b, 14);
        let negative = |a| l.mirror(a, |a| -a);
        let none = l.gates([sin_turn], |_| 0);
        let cartesian = [product(sin_polar, cos_azimuth), product(sin_polar, sin_azimuth), z];
        let matrix = [
            [product(cos_tilt, cos_turn), product(cos_tilt, sin_turn), negative(sin_tilt)],
            [negative(sin_turn), cos_turn, none],
            [product(sin_tilt, cos_turn), product(sin_tilt, sin_turn), cos_tilt],
        ];
        self.to_polar.convert(l, matrix.map(|row| narrow(l, dot(l, row, cartesian))))
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Polar<L::Value>, rotated: Polar<L::Value>, _: Lit) -> L::Value {
        let product = |a, b| l.multiply(a, b, 14);
        let upright = product(cos(l, &self.sine, rotated.polar), cos(l, &self.sine, bump.polar));
        let level = product(sin(l, &self.sine, rotated.polar), sin(l, &self.sine, bump.polar));
        let between = cos(l, &self.sine, l.turn_back(rotated.azimuth, bump.azimuth));
        l.add(upright, product(level, between))
    }

    fn roms(&self) -> Vec<&Rom> {
        let mut roms = vec![self.sine.rom()];
        roms.extend(self.to_polar.roms());
        roms
    }
}
