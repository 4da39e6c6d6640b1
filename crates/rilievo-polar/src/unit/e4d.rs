//! E4d: E4 for lights and eyes that are far away. A vector's angles along and across the meridian then depend on φN
//! alone, and are two tables that are written anew when the light moves.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | ξ(φN), η(φN) | binary angle, 2^(a+2) words a turn | address to nearest, words exact | none |
//! | ξ' + θN, ξ' − ξ, η' ± η | binary angle | exact | wraps |
//! | inner product | Q2.14 | product down | none |

use alloc::vec;
use alloc::vec::Vec;

use super::e4::{Meridian, meridian_product};
use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::frame::{Direction, Frame};
use crate::logic::{Logic, Reading, signed};
use crate::rom::exact::{ONE, TURN, arc_sine, arc_tangent, sin_cos};
use crate::rom::{QUARTER, Rom, Sine, Width};

/// Inner products for a directional light and a distant viewer.
#[derive(Debug)]
pub(crate) struct E4d {
    sine: Sine,
    light: Tables,
    half: Tables,
}

/// A vector as tables over the azimuth of the normal.
#[derive(Debug)]
struct Tables {
    along: Rom,
    across: Rom,
}

impl Tables {
    fn new(width: Width, vector: Direction, names: [&'static str; 2]) -> Self {
        let entries = 4 * width.entries() as i128;
        let angle = |word: u16| i128::from(word) << 44;
        let parts = move |i: i128| {
            let (sin, z) = sin_cos(angle(vector.polar));
            let (sin_delta, cos_delta) = sin_cos(angle(vector.azimuth) - i * TURN / entries);
            ([(sin * cos_delta) >> 60, (sin * sin_delta) >> 60], z)
        };
        let along = move |i| {
            let ([x, _], z) = parts(i);
            let arc = i64::from(arc_tangent(x.abs(), z.abs(), QUARTER as u32));
            let arc = if z < 0 { 2 * QUARTER - arc } else { arc };
            (if x < 0 { -arc } else { arc }) as u16
        };
        let across = move |i| {
            let ([_, y], _) = parts(i);
            let arc = i64::from(arc_sine(y.abs().min(ONE), QUARTER as u32));
            (if y < 0 { -arc } else { arc }) as u16
        };
        Self {
            along: Rom::new(names[0], (0..entries).map(along)),
            across: Rom::new(names[1], (0..entries).map(across)),
        }
    }
}

impl E4d {
    pub(crate) fn new(width: Width, frame: Frame) -> Self {
        Self {
            sine: Sine::new(width),
            light: Tables::new(width, frame.light, ["along-light", "across-light"]),
            half: Tables::new(width, frame.half, ["along-half", "across-half"]),
        }
    }
}

impl Unit for E4d {
    const PORTS: &'static [Port] = &[
        Port::Azimuth(Vector::Normal),
        Port::Polar(Vector::Normal),
        Port::Bump(Bump::Along),
        Port::Bump(Bump::Across),
    ];
    type Fetched<V: Copy> = Meridian<V>;
    type Rotated<V: Copy> = Meridian<V>;

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> Meridian<L::Value> {
        // Turned once for both vectors, which their tables are not.
        Meridian { along: l.turn(pixel.raw(2), pixel.raw(1)), across: pixel.raw(3) }
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Meridian<L::Value> {
        let tables = match vector {
            Lit::Light => &self.light,
            Lit::Half => &self.half,
        };
        let bits = tables.along.address_bits();
        let dropped = 16 - bits;
        let at =
            l.gates([pixel.raw(0)], |[azimuth]| ((azimuth + ((1 << dropped) >> 1)) >> dropped) & ((1 << bits) - 1));
        let [along] = l.read(&tables.along, Reading::Single, [at]);
        let [across] = l.read(&tables.across, Reading::Single, [at]);
        Meridian { along, across: l.gates([across], |[across]| signed(across)) }
    }

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, bump: Meridian<L::Value>, vector: Meridian<L::Value>, _: Lit) -> L::Value {
        meridian_product(l, &self.sine, bump, vector)
    }

    fn roms(&self) -> Vec<&Rom> {
        vec![self.sine.rom(), &self.light.along, &self.light.across, &self.half.along, &self.half.across]
    }
}
