//! E2: exact rotation, Cartesian bump vectors. `N'·L' = x·u + y·v + z·w`: no arcs at all.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | Δ, θ ± θN, θ ± Δ | binary angle, 16 bits | exact | wraps |
//! | u, v, w | Q2.14 | products and halves down | one unit past ±1 |
//! | inner product | Q4.28 to Q2.14 | sum exact, then down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::rotation::rotate_exactly;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, dot, narrow};
use crate::rom::{Rom, Sine, Width};

/// Exact rotation with Cartesian results.
#[derive(Debug)]
pub(crate) struct E2 {
    sine: Sine,
}

impl E2 {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width) }
    }
}

impl Unit for E2 {
    const PORTS: &'static [Port] = polar_ports![Bump::Component(0), Bump::Component(1), Bump::Component(2)];
    type Fetched<V: Copy> = [V; 3];
    type Rotated<V: Copy> = [V; 3];

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> [L::Value; 3] {
        pixel.words(l, 6)
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> [L::Value; 3] {
        rotate_exactly(l, &self.sine, pixel.normal(), pixel.vector(vector))
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: [L::Value; 3], rotated: [L::Value; 3], _: Lit) -> L::Value {
        narrow(l, dot(l, rotated, bump))
    }

    fn roms(&self) -> Vec<&Rom> {
        vec![self.sine.rom()]
    }
}
