//! E4: angles along and across the normal's meridian instead of about it, so that its turn by θN is a subtraction.
//!
//! `η = asin v`, `ξ = atan2(x, z)` of the vector turned by −φN; rotation is ξ − θN; bump vectors are stored the same way:
//! `N'·L' = [cos(η − η') + cos(η + η')]·cos²((ξ − ξ')/2) − cos(η + η')`. Two multipliers a vector.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | Δ, X = θ + Δ, Y = θ − Δ | binary angle, 16 bits | exact | wraps |
//! | x, y | Q2.14 | address to nearest of 2^(a+2) a turn, halves down | none |
//! | η = asin y | binary angle | address down, mean words; 0, ±1 exact | limited at 1 |
//! | x·sec θ | Q6.10 | secant of middles, limited to 64 − 2⁻¹⁰; product down | none |
//! | ξ | binary angle | address as 4 bits of exponent and a − 4 of mantissa, down; words of middles; 0 exact | none |
//! | ξ − θN, ξ' − ξ, η' ± η | binary angle | exact | wraps |
//! | inner product | Q2.14 | product down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{
    Logic, acute, arc_sine, beyond_quarter, cos, cos_squared_of_half, half, log_arc_tangent, magnitude, secant,
    sin_cos, supplement_by, times_reciprocal, with_sign_of,
};
use crate::rom::{Rom, Sine, Width};

/// A direction by its angle along the meridian from z to x, and across it towards y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meridian<V> {
    pub(super) along: V,
    pub(super) across: V,
}

/// Exact inner products with two multipliers a vector.
#[derive(Debug)]
pub(crate) struct E4 {
    sine: Sine,
    arc_sine: Rom,
    secant: Rom,
    arc_tangent: Rom,
}

impl E4 {
    pub(crate) fn new(width: Width) -> Self {
        Self {
            sine: Sine::new(width),
            arc_sine: Rom::arc_sine(width),
            secant: Rom::secant(width),
            arc_tangent: Rom::log_arc_tangent(width),
        }
    }
}

impl Unit for E4 {
    const PORTS: &'static [Port] = polar_ports![Bump::Along, Bump::Across];
    type Fetched<V: Copy> = Meridian<V>;
    type Rotated<V: Copy> = Meridian<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, _: &L, pixel: Pixel<'_, L>) -> Meridian<L::Value> {
        Meridian { along: pixel.raw(6), across: pixel.raw(7) }
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Meridian<L::Value> {
        let (normal, vector) = (pixel.normal(), pixel.vector(vector));
        let delta = l.turn_back(vector.azimuth, normal.azimuth);
        let [sin_x, cos_x] = sin_cos(l, &self.sine, l.turn(vector.polar, delta));
        let [sin_y, cos_y] = sin_cos(l, &self.sine, l.turn_back(vector.polar, delta));
        let x = half(l, l.add(sin_x, sin_y));
        let y = half(l, l.sub(cos_y, cos_x));
        let across = with_sign_of(l, y, arc_sine(l, &self.arc_sine, magnitude(l, y)));
        // x/cos θ is the tangent of the angle; its secant is looked up where it is positive.
        let width = magnitude(l, x);
        let tangent = times_reciprocal(l, width, secant(l, &self.secant, acute(l, vector.polar)));
        let arc = log_arc_tangent(l, &self.arc_tangent, tangent, width);
        let along = with_sign_of(l, x, supplement_by(l, beyond_quarter(l, vector.polar), arc));
        Meridian { along: l.turn_back(along, normal.polar), across }
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Meridian<L::Value>, vector: Meridian<L::Value>, _: Lit) -> L::Value {
        meridian_product(l, &self.sine, bump, vector)
    }

    fn roms(&self) -> Vec<&Rom> {
        vec![self.sine.rom(), &self.arc_sine, &self.secant, &self.arc_tangent]
    }
}

/// Inner product of two directions by their angles along and across one meridian.
#[inline(always)]
pub(super) fn meridian_product<L: Logic>(l: &L, sine: &Sine, a: Meridian<L::Value>, b: Meridian<L::Value>) -> L::Value {
    let sum = cos(l, sine, l.turn(a.across, b.across));
    let difference = cos(l, sine, l.turn_back(a.across, b.across));
    let k = cos_squared_of_half(l, sine, l.turn_back(a.along, b.along));
    l.sub(l.multiply(l.add(difference, sum), k, 14), sum)
}
