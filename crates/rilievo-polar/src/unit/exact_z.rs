//! The published unit with the one angle mended that it gets wrong most: Z from the exact rotation.
//!
//! What is left is the error of the proportion, eq. (10): at most 8.610°, at 31.65° of each of the two angles.
//! Words and roundings are those of the published unit; u, v, w are Q2.14, products rounded down.

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::published::Proportion;
use super::rotation::rotate_exactly;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, Polar, arc_sine, magnitude, polar_product, supplement_by, with_sign_of};
use crate::rom::{Rom, Sine, Width};

/// The published unit with exact Z.
#[derive(Debug)]
pub(crate) struct ExactZ {
    sine: Sine,
    arc_sine: Rom,
    proportion: Proportion,
}

impl ExactZ {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width), arc_sine: Rom::arc_sine(width), proportion: Proportion::new(width) }
    }
}

impl Unit for ExactZ {
    const PORTS: &'static [Port] = polar_ports![Bump::Azimuth, Bump::Polar];
    type Fetched<V: Copy> = Polar<V>;
    type Rotated<V: Copy> = Polar<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, _: &L, pixel: Pixel<'_, L>) -> Polar<L::Value> {
        pixel.polar(6)
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Polar<L::Value> {
        let [u, v, w] = rotate_exactly(l, &self.sine, pixel.normal(), pixel.vector(vector));
        let arc = arc_sine(l, &self.arc_sine, magnitude(l, u));
        let z = with_sign_of(l, u, supplement_by(l, w, arc));
        self.proportion.place(l, z, v)
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Polar<L::Value>, rotated: Polar<L::Value>, _: Lit) -> L::Value {
        polar_product(l, &self.sine, rotated, bump)
    }

    fn roms(&self) -> Vec<&Rom> {
        let mut roms = vec![self.sine.rom(), &self.arc_sine];
        roms.extend(self.proportion.roms());
        roms
    }
}
