//! Kugler's IMEM: three rotations by two additions and a map, then light maps.
//!
//! Its cost cannot be derived from the text and is quoted as printed. What runs here is a reading of it that fits the sizes the
//! text gives: turning N' about z is an addition before and one after; turning it about y by θN is a map of 32 KB, 2¹⁴ words
//! of 8 bits for each angle, addressed by 5 bits of φ', 4 of θ' and 5 of θN; the lights are two maps of 1 MB, 2²⁰ words of 8
//! bits over the angles of the turned N' (10 bits each), made anew when the light moves. Lights and viewer are far away.
//!
//! The light maps hold max(0, N'·L') and max(0, N'·H') here and not powers of them, so that this unit ends where the others
//! do and the same light follows.
//!
//! | stage | word | rounding | overflow |
//! |---|---|---|---|
//! | φ', θ', θN as an address | 5, 4, 5 bits | down, words of middles | θ' limited to 90° |
//! | turned φ, θ | 8 bits each | to nearest | wraps; θ limited |
//! | φ + φN | binary angle | exact | wraps |
//! | light map's address | 10 bits each | to nearest | wraps; θ limited |
//! | max(0, N'·A) | Q0.8 | to nearest | none |

use alloc::vec;
use alloc::vec::Vec;

use super::{Bump, Lit, Pixel, Port, Unit, Vector};
use crate::frame::{Direction, Frame};
use crate::logic::{Logic, Reading};
use crate::rom::exact::{ONE, TURN, arc_cosine, arc_tangent, sin_cos};
use crate::rom::{HALF, QUARTER, Rom};

const PHI_BITS: u32 = 5;
const THETA_BITS: u32 = 4;
const TILT_BITS: u32 = 5;
const LIGHT_BITS: u32 = 10;

/// Kugler's unit for a distant light and viewer.
#[derive(Debug)]
pub(crate) struct Kugler {
    turn: Rom,
    light: Rom,
    half: Rom,
}

impl Kugler {
    pub(crate) fn new(frame: Frame) -> Self {
        Self { turn: turn_map(), light: light_map("light-map", frame.light), half: light_map("half-map", frame.half) }
    }
}

/// Both angles of (φ', θ') turned by θN about y, 8 bits each.
fn turn_map() -> Rom {
    let middle = |index: u32, bits: u32, range: i128| ((2 * i128::from(index) + 1) * range) >> (bits + 1);
    let word = move |i: u32| {
        let phi = middle(i >> (THETA_BITS + TILT_BITS), PHI_BITS, TURN);
        let theta = middle(i >> TILT_BITS & ((1 << THETA_BITS) - 1), THETA_BITS, TURN / 4);
        let tilt = middle(i & ((1 << TILT_BITS) - 1), TILT_BITS, TURN / 2);
        let ((sin_phi, cos_phi), (sin, cos), (sin_tilt, cos_tilt)) = (sin_cos(phi), sin_cos(theta), sin_cos(tilt));
        let product = |a: i128, b: i128| (a * b) >> 60;
        let x = product(sin, cos_phi);
        let y = product(sin, sin_phi);
        let z = product(cos, cos_tilt) - product(x, sin_tilt);
        let x = product(x, cos_tilt) + product(cos, sin_tilt);
        // 256 steps a turn, 255 of half a turn.
        let arc = arc_tangent(y.abs(), x.abs(), 64) as u16;
        let arc = if x < 0 { 128 - arc } else { arc };
        let phi = if y < 0 { 256 - arc } else { arc } & 0xff;
        let theta = polar_steps(z);
        (phi << 8) | theta
    };
    Rom::new("turn-map", (0..1 << (PHI_BITS + THETA_BITS + TILT_BITS)).map(word))
}

/// Arc cosine in 255 steps of half a turn.
fn polar_steps(z: i128) -> u16 {
    // A quarter turn is half an odd number of steps, so it is done in half steps.
    let arc = arc_cosine(z.abs().min(ONE), 255);
    let half_steps = if z < 0 { 510 - arc } else { arc };
    (half_steps.div_ceil(2)) as u16
}

/// max(0, N'·A) over the angles of N', in 255ths.
fn light_map(name: &'static str, vector: Direction) -> Rom {
    let side = 1u32 << LIGHT_BITS;
    let (sin_a, cos_a) = sin_cos(i128::from(vector.polar) << 44);
    let waves: Vec<_> = (0..side)
        .map(|phi| sin_cos(i128::from(phi) * TURN / i128::from(side) - (i128::from(vector.azimuth) << 44)).1)
        .collect();
    let rings: Vec<_> = (0..side)
        .map(|theta| {
            let (sin, cos) = sin_cos(i128::from(theta) * (TURN / 2) / i128::from(side - 1));
            ((sin * sin_a) >> 60, (cos * cos_a) >> 60)
        })
        .collect();
    let word = move |i: u32| {
        let (level, upright) = rings[(i % side) as usize];
        let product = ((level * waves[(i / side) as usize]) >> 60) + upright;
        ((product.max(0) * 255 + ONE / 2) >> 60) as u16
    };
    Rom::new(name, (0..side * side).map(word))
}

impl Unit for Kugler {
    const PORTS: &'static [Port] = &[
        Port::Azimuth(Vector::Normal),
        Port::Polar(Vector::Normal),
        Port::Bump(Bump::Azimuth),
        Port::Bump(Bump::Polar),
    ];
    /// Address of the light maps.
    type Fetched<V: Copy> = V;
    type Rotated<V: Copy> = ();

    #[inline(always)]
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> L::Value {
        let [phi_n, theta_n, phi, theta] = [0, 1, 2, 3].map(|port| pixel.raw(port));
        let at = l.gates([phi, theta, theta_n], |[phi, theta, tilt]| {
            let phi = (phi & 0xffff) >> (16 - PHI_BITS);
            let theta = theta.min(QUARTER - 1) >> (14 - THETA_BITS);
            let tilt = tilt.min(HALF - 1) >> (15 - TILT_BITS);
            (((phi << THETA_BITS) | theta) << TILT_BITS) | tilt
        });
        let [turned] = l.read(&self.turn, Reading::Map, [at]);
        let phi = l.gates([turned], |[turned]| turned >> 8 << 8);
        let phi = l.turn(phi, phi_n);
        l.gates([phi, turned], |[phi, turned]| {
            let phi = ((phi + 32) & 0xffff) >> (16 - LIGHT_BITS);
            // Both ranges end at half a turn: 255 steps there, 1023 here.
            let theta = (turned & 0xff) * 1023 / 255;
            (phi << LIGHT_BITS) | theta
        })
    }

    #[inline(always)]
    fn rotate<L: Logic>(&self, _: &L, _: Pixel<'_, L>, _: Lit) {}

    #[inline(always)]
    fn product<L: Logic>(&self, l: &L, at: L::Value, (): (), vector: Lit) -> L::Value {
        let map = match vector {
            Lit::Light => &self.light,
            Lit::Half => &self.half,
        };
        let [intensity] = l.read(map, Reading::Map, [at]);
        // 255 is 1; × 2¹⁴/255 is 64 + 1/4 + …
        l.gates([intensity], |[intensity]| (intensity << 6) + (intensity >> 2))
    }

    fn roms(&self) -> Vec<&Rom> {
        vec![&self.turn, &self.light, &self.half]
    }
}
