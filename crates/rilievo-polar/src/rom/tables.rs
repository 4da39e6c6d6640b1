//! The contents of each table, rounded to nearest.
//!
//! | table | address | word |
//! |---|---|---|
//! | sine | quarter turn, rounded to 2^a steps; the step at the end is wired to 1 | Q2.14 |
//! | arc sine, arc cosine | Q0.a magnitude, rounded down; words are means of the arcs at both ends | binary angle |
//! | proportion | the same as arc sine | the arc over 90°, Q0.16 (1 is 65535) |
//! | secant | quarter turn, rounded down; words are of the middles | Q6.10, limited to 65535 |
//! | reciprocal | the a bits after the leading one of a number, rounded down; middles | Q0.16 |
//! | arc tangent | Q0.a quotient ≤ 1, rounded down; middles | binary angle |
//! | arc tangent by logarithm | a Q6.10 quotient as 4 bits of exponent and a − 4 of mantissa; middles | binary angle |
//!
//! The arc sine ends steeply: the arc of the last interval's middle would be 1.4 times as far from one of its ends as the mean of
//! the arcs is from both.

use super::exact::{ONE, TURN, arc_sine, arc_tangent, nearest_quotient, sin_cos};
use super::{FRACTION, QUARTER, RECIPROCAL_FRACTION, Rom, Width};

/// Steps of a binary angle in a quarter turn.
const STEPS: u32 = QUARTER as u32;

impl Rom {
    /// A quarter wave of the sine.
    pub(super) fn sine(width: Width) -> Self {
        let step = |i: usize| TURN / 4 * i as i128 / width.entries() as i128;
        let value = |i: usize| nearest_quotient(sin_cos(step(i)).0 << FRACTION, ONE);
        Self::new("sine", (0..width.entries()).map(|i| value(i) as u16))
    }

    pub(crate) fn arc_sine(width: Width) -> Self {
        Self::new("arc-sine", mean_arcs(width, STEPS))
    }

    pub(crate) fn arc_cosine(width: Width) -> Self {
        Self::new("arc-cosine", mean_arcs(width, STEPS).map(|arc| STEPS as u16 - arc))
    }

    /// Eq. (26): the arc sine as a proportion of a quarter turn.
    pub(crate) fn proportion(width: Width) -> Self {
        Self::new("proportion", mean_arcs(width, u32::from(u16::MAX)))
    }

    pub(crate) fn secant(width: Width) -> Self {
        let word = |middle: i128| {
            let cos = sin_cos(middle / 4).1;
            nearest_quotient(ONE << RECIPROCAL_FRACTION, cos).min(u16::MAX.into()) as u16
        };
        Self::new("secant", middles(width).map(word))
    }

    pub(crate) fn reciprocal(width: Width) -> Self {
        let word = |middle| nearest_quotient(i128::from(u16::MAX) * ONE, ONE + middle) as u16;
        Self::new("reciprocal", middles(width).map(word))
    }

    pub(crate) fn arc_tangent(width: Width) -> Self {
        Self::new("arc-tangent", middles(width).map(|value| arc_tangent(value, ONE, STEPS) as u16))
    }

    pub(crate) fn log_arc_tangent(width: Width) -> Self {
        let mantissa_bits = width.bits() - 4;
        let word = |i: usize| {
            let exponent = (i >> mantissa_bits) as u32;
            let mantissa = (i & ((1 << mantissa_bits) - 1)) as i128;
            // In units of 2^−mantissa_bits, doubled so that the middle is whole; the lowest octave starts at zero.
            let middle = match exponent {
                0 => 2 * (2 * mantissa + 1),
                _ => (2 * ((1 << mantissa_bits) + mantissa) + 1) << exponent,
            };
            arc_tangent(middle, 1 << (RECIPROCAL_FRACTION + mantissa_bits + 1), STEPS) as u16
        };
        Self::new("log-arc-tangent", (0..width.entries()).map(word))
    }

    /// What a light gives at each inner product in [0, 1]: `scale · x^exponent`, Q0.16, of the middles.
    pub(crate) fn light(name: &'static str, width: Width, scale: u16, exponent: u32) -> Self {
        let word = |middle: i128| {
            let power = power(middle, exponent);
            nearest_quotient(power * i128::from(scale), ONE) as u16
        };
        Self::new(name, middles(width).map(word))
    }
}

/// A value in [0, 1] to a whole power.
fn power(value: i128, exponent: u32) -> i128 {
    let (mut power, mut square, mut left) = (ONE, value, exponent);
    while left > 0 {
        if left & 1 == 1 {
            power = (power * square) >> 60;
        }
        square = (square * square) >> 60;
        left >>= 1;
    }
    power
}

/// The mean of the arc sines at both ends of each interval of [0, 1], in `steps` of a quarter turn.
fn mean_arcs(width: Width, steps: u32) -> impl Iterator<Item = u16> {
    const FINER: u32 = 1 << 10;
    let end = move |i: usize| arc_sine(ONE * i as i128 / width.entries() as i128, steps * FINER);
    (0..width.entries()).map(move |i| ((end(i) + end(i + 1) + FINER) / (2 * FINER)) as u16)
}

/// The middles of a table's intervals of [0, 1].
fn middles(width: Width) -> impl Iterator<Item = i128> {
    (0..width.entries() as i128).map(move |i| (2 * i + 1) * (ONE / 2) / width.entries() as i128)
}
