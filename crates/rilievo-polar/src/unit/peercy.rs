//! Peercy's and Ernst's unit: Cartesian vectors, a tangent-space matrix, normalisation.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | T·L, B·L, N·L and of H | Q4.28 to Q2.14 | sum exact, then down | wraps only for vectors longer than 2 |
//! | lengths | Q2.14 | root down | none |
//! | L', H', N' | Q2.14 | quotient towards zero | a few units past ±1; 0 for a vector of no length |
//! | inner product | Q4.28 to Q2.14 | sum exact, then down | a few units past ±1 |

use alloc::vec::Vec;

use super::port::cartesian_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{Logic, dot, narrow, normalize};
use crate::rom::Rom;

/// Peercy's set-up with Ernst's illumination.
#[derive(Debug)]
pub(crate) struct Peercy;

impl Unit for Peercy {
    const PORTS: &'static [Port] = cartesian_ports![Bump::Component(0), Bump::Component(1), Bump::Component(2)];
    type Fetched<V: Copy> = [V; 3];
    type Rotated<V: Copy> = [V; 3];

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> [L::Value; 3] {
        normalize(l, pixel.words(l, 15))
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> [L::Value; 3] {
        let vector = pixel.words(l, 3 * vector as usize);
        normalize(l, [6, 9, 12].map(|row| narrow(l, dot(l, pixel.words(l, row), vector))))
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: [L::Value; 3], rotated: [L::Value; 3], _: Lit) -> L::Value {
        narrow(l, dot(l, bump, rotated))
    }

    fn roms(&self) -> Vec<&Rom> {
        Vec::new()
    }
}
