//! The published unit, with its equations mended: eqs. (5)-(9), (16)-(18), (24), (25).
//!
//! The rotation about y keeps the circle of constant x, which it does not (only for y = 0 or θN = 0), and takes the
//! polar angle on that circle for proportional, which it is not. Its error, 15.8° in the mean, is the method's; it is
//! reproduced here to the bit.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | Δ = φ − φN, X = θ + Δ, Y = θ − Δ | binary angle, 16 bits | exact | wraps |
//! | sines, cosines of X, Y | Q2.14 | address to nearest of 2^(a+2) a turn | none |
//! | x = (sin X + sin Y)/2, y = (cos Y − cos X)/2 | Q2.14 | down | none |
//! | θx = asin x, mirrored for θ > 90° | binary angle | address down, mean words; 0, ±1 exact | limited at 1 |
//! | Z = θx − θN | binary angle | exact | wraps |
//! | 1/cos Z, 1/sin Z | Q6.10 | address down, words of middles | limited to 64 − 2⁻¹⁰ |
//! | y/cos Z, y/sin Z | Q6.10 | down | none: below 2¹⁶ |
//! | θprop = asin(y/cos Z)/90° | Q0.16 | address down, mean words; 0 exact | limited at 1 |
//! | φ' = atan2(y, sin Z) | binary angle | address as 4 bits of exponent and a − 4 of mantissa, down; words of middles | none |
//! | θ' = \|Z\| + (90° − \|Z\|)·θprop | binary angle | product down | none |
//! | inner product | Q2.14 | product down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::port::polar_ports;
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::logic::{
    Logic, Polar, acute, arc_sine, beyond_quarter, half, log_arc_tangent, magnitude, polar_product, read_magnitude,
    secant_cosecant, signed, sin_cos, supplement_by, times_reciprocal, with_sign_of,
};
use crate::rom::{QUARTER, Rom, Sine, Width};

/// The published unit.
#[derive(Debug)]
pub(crate) struct Published {
    sine: Sine,
    arc_sine: Rom,
    proportion: Proportion,
}

impl Published {
    pub(crate) fn new(width: Width) -> Self {
        Self { sine: Sine::new(width), arc_sine: Rom::arc_sine(width), proportion: Proportion::new(width) }
    }
}

impl Unit for Published {
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
        let delta = l.turn_back(vector.azimuth, normal.azimuth);
        let [sin_x, cos_x] = sin_cos(l, &self.sine, l.turn(vector.polar, delta));
        let [sin_y, cos_y] = sin_cos(l, &self.sine, l.turn_back(vector.polar, delta));
        let x = half(l, l.add(sin_x, sin_y));
        let y = half(l, l.sub(cos_y, cos_x));
        // The arc sine loses the sign of z.
        let arc = arc_sine(l, &self.arc_sine, magnitude(l, x));
        let theta_x = with_sign_of(l, x, supplement_by(l, beyond_quarter(l, vector.polar), arc));
        self.proportion.place(l, l.turn_back(theta_x, normal.polar), y)
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

/// From the angle Z in the xz plane and the component across it to polar angles, by the proportion of the circle.
#[derive(Debug)]
pub(super) struct Proportion {
    secant: Rom,
    proportion: Rom,
    arc_tangent: Rom,
}

impl Proportion {
    pub(super) fn new(width: Width) -> Self {
        Self {
            secant: Rom::secant(width),
            proportion: Rom::proportion(width),
            arc_tangent: Rom::log_arc_tangent(width),
        }
    }

    /// `φ' = atan2(y, sin Z)`, `θ' = |Z| + (90° − |Z|)·asin(min(1, |y/cos Z|))/90°`, eqs. (9), (16)-(18).
    #[inline(always)]
    pub(super) fn place<L: Logic>(&self, l: &L, z: L::Value, y: L::Value) -> Polar<L::Value> {
        let z = l.gates([z], |[z]| signed(z));
        let (height, turn) = (magnitude(l, y), magnitude(l, z));
        let [secant, cosecant] = secant_cosecant(l, &self.secant, acute(l, turn));
        let over_cos = times_reciprocal(l, height, secant);
        let over_sin = times_reciprocal(l, height, cosecant);

        let arc = log_arc_tangent(l, &self.arc_tangent, over_sin, height);
        let azimuth = with_sign_of(l, y, supplement_by(l, z, arc));

        // From Q6.10 to Q2.14, as the table takes its address.
        let address = l.gates([over_cos], |[quotient]| quotient << 4);
        let proportion = read_magnitude(l, &self.proportion, address);
        let proportion = l.gates([proportion, height], |[p, height]| if height == 0 { 0 } else { p });
        let quarter = l.gates([turn], |_| QUARTER);
        let rest = l.multiply(l.sub(quarter, turn), proportion, 16);
        Polar { azimuth, polar: l.add(turn, rest) }
    }

    pub(super) fn roms(&self) -> [&Rom; 3] {
        [&self.secant, &self.proportion, &self.arc_tangent]
    }
}
