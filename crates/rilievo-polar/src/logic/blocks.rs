//! What several units have in common: waves, reflections, arcs with a sign.

use super::{Logic, Reading};
use crate::rom::{HALF, ONE, QUARTER, RECIPROCAL_FRACTION, Rom, Sine};

/// A direction: `azimuth` from the x axis in the xy plane, `polar` from the z axis, binary angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Polar<V> {
    pub(crate) azimuth: V,
    pub(crate) polar: V,
}

/// A binary angle between −½ and ½ turn.
#[inline(always)]
pub(crate) const fn signed(angle: i64) -> i64 {
    ((angle + HALF) & 0xffff) - HALF
}

/// Sine of an angle, Q2.14.
#[inline(always)]
pub(crate) fn sin<L: Logic>(l: &L, sine: &Sine, angle: L::Value) -> L::Value {
    let [sin] = l.wave(sine, Reading::Single, [angle]);
    sin
}

/// Cosine of an angle, Q2.14.
#[inline(always)]
pub(crate) fn cos<L: Logic>(l: &L, sine: &Sine, angle: L::Value) -> L::Value {
    sin(l, sine, quarter_ahead(l, angle))
}

/// Sine and cosine, from one table of words twice as wide.
#[inline(always)]
pub(crate) fn sin_cos<L: Logic>(l: &L, sine: &Sine, angle: L::Value) -> [L::Value; 2] {
    l.wave(sine, Reading::TwoWords, [angle, quarter_ahead(l, angle)])
}

/// A quarter turn more: the two bits of the quadrant.
#[inline(always)]
fn quarter_ahead<L: Logic>(l: &L, angle: L::Value) -> L::Value {
    l.gates([angle], |[angle]| angle + QUARTER)
}

/// `cos²(angle/2) = (1 + cos angle)/2`, Q2.14: 1 is added to two bits, nothing carries.
#[inline(always)]
pub(crate) fn cos_squared_of_half<L: Logic>(l: &L, sine: &Sine, angle: L::Value) -> L::Value {
    let cos = cos(l, sine, angle);
    l.gates([cos], |[cos]| (ONE + cos) >> 1)
}

/// Half a value, rounded down.
#[inline(always)]
pub(crate) fn half<L: Logic>(l: &L, a: L::Value) -> L::Value {
    l.gates([a], |[a]| a >> 1)
}

/// A 16-bit word as a number with a sign.
#[inline(always)]
pub(crate) fn word<L: Logic>(l: &L, raw: L::Value) -> L::Value {
    l.gates([raw], |[raw]| signed(raw))
}

#[inline(always)]
pub(crate) fn magnitude<L: Logic>(l: &L, a: L::Value) -> L::Value {
    l.mirror(a, i64::abs)
}

/// `a`, or −a where `sign` is negative.
#[inline(always)]
pub(crate) fn with_sign_of<L: Logic>(l: &L, sign: L::Value, a: L::Value) -> L::Value {
    l.mirror_by(a, sign, |a, sign| if sign < 0 { -a } else { a })
}

/// `angle`, or 180° − angle where `sign` is negative.
#[inline(always)]
pub(crate) fn supplement_by<L: Logic>(l: &L, sign: L::Value, angle: L::Value) -> L::Value {
    l.mirror_by(angle, sign, |angle, sign| if sign < 0 { HALF - angle } else { angle })
}

/// 180° − angle where that is less.
#[inline(always)]
pub(crate) fn acute<L: Logic>(l: &L, angle: L::Value) -> L::Value {
    l.mirror(angle, |angle| if angle > QUARTER { HALF - angle } else { angle })
}

/// Negative for angles from 0° to 180° that are beyond 90°.
#[inline(always)]
pub(crate) fn beyond_quarter<L: Logic>(l: &L, angle: L::Value) -> L::Value {
    l.gates([angle], |[angle]| if angle > QUARTER { -1 } else { 0 })
}

/// A word of a table addressed by a Q2.14 magnitude; past the end, the last one.
#[inline(always)]
pub(crate) fn read_magnitude<L: Logic>(l: &L, rom: &Rom, magnitude: L::Value) -> L::Value {
    let bits = rom.address_bits();
    let at = l.gates([magnitude], |[magnitude]| (magnitude >> (14 - bits)).min((1 << bits) - 1));
    let [word] = l.read(rom, Reading::Single, [at]);
    word
}

/// Arc sine of a magnitude; 0 and 1 are exact.
#[inline(always)]
pub(crate) fn arc_sine<L: Logic>(l: &L, rom: &Rom, magnitude: L::Value) -> L::Value {
    let arc = read_magnitude(l, rom, magnitude);
    l.gates([magnitude, arc], |[magnitude, arc]| match magnitude {
        0 => 0,
        ONE.. => QUARTER,
        _ => arc,
    })
}

/// 1/cos of an angle from 0° to 90°, Q6.10, limited to just below 64.
#[inline(always)]
pub(crate) fn secant<L: Logic>(l: &L, rom: &Rom, angle: L::Value) -> L::Value {
    let at = l.gates([angle], |[angle]| secant_address(angle, rom.address_bits()));
    let [secant] = l.read(rom, Reading::Single, [at]);
    secant
}

/// 1/cos and 1/sin of an angle from 0° to 90°, from the two ports of one table.
#[inline(always)]
pub(crate) fn secant_cosecant<L: Logic>(l: &L, rom: &Rom, angle: L::Value) -> [L::Value; 2] {
    let bits = rom.address_bits();
    let from_start = l.gates([angle], |[angle]| secant_address(angle, bits));
    let from_end = l.gates([angle], |[angle]| secant_address(QUARTER - angle, bits));
    l.read(rom, Reading::TwoPorts, [from_start, from_end])
}

#[inline(always)]
fn secant_address(angle: i64, bits: u32) -> i64 {
    (angle >> (14 - bits)).min((1 << bits) - 1)
}

/// Arc tangent of a Q6.10 quotient ≥ 0, addressed by its logarithm; 0 is exact if `numerator` is 0.
#[inline(always)]
pub(crate) fn log_arc_tangent<L: Logic>(l: &L, rom: &Rom, quotient: L::Value, numerator: L::Value) -> L::Value {
    let mantissa_bits = rom.address_bits() - 4;
    let at = l.shift(quotient, quotient, |quotient, _| log_address(quotient, mantissa_bits));
    let [arc] = l.read(rom, Reading::Single, [at]);
    l.gates([arc, numerator], |[arc, numerator]| if numerator == 0 { 0 } else { arc })
}

/// Exponent and mantissa of a Q6.10 number, as of a small floating-point format with a subnormal octave.
#[inline(always)]
fn log_address(quotient: i64, mantissa_bits: u32) -> i64 {
    let quotient = quotient.min(0xffff);
    if quotient < 2 {
        return (quotient << mantissa_bits) >> 1;
    }
    let exponent = quotient.ilog2();
    let mantissa = ((quotient << mantissa_bits) >> exponent) & ((1 << mantissa_bits) - 1);
    (i64::from(exponent) << mantissa_bits) | mantissa
}

/// A quotient of magnitudes `low ≤ high`, Q2.14: the larger is shifted to [1, 2), its reciprocal looked up.
#[inline(always)]
pub(crate) fn quotient<L: Logic>(l: &L, reciprocal: &Rom, low: L::Value, high: L::Value) -> L::Value {
    let bits = reciprocal.address_bits();
    let at = l.shift(high, high, |high, _| {
        let high = high.max(1);
        ((high << 14) >> high.ilog2() >> (14 - bits)) & ((1 << bits) - 1)
    });
    let low = l.shift(low, high, |low, high| (low << 14) >> high.max(1).ilog2());
    let [reciprocal] = l.read(reciprocal, Reading::Single, [at]);
    l.multiply(low, reciprocal, 16)
}

/// Azimuth of a vector's x and y.
///
/// The smaller magnitude is divided by the larger, so that the arc tangent need not go past 45°.
#[inline(always)]
pub(crate) fn azimuth<L: Logic>(l: &L, reciprocal: &Rom, arc_tangent: &Rom, x: L::Value, y: L::Value) -> L::Value {
    let (width, height) = (magnitude(l, x), magnitude(l, y));
    let steep = l.greater(height, width);
    let low = l.gates([width, height], |[width, height]| width.min(height));
    let high = l.gates([width, height], |[width, height]| width.max(height));
    let arc = read_magnitude(l, arc_tangent, quotient(l, reciprocal, low, high));
    let arc = l.gates([arc, low], |[arc, low]| if low == 0 { 0 } else { arc });
    let arc = l.mirror_by(arc, steep, |arc, steep| if steep == 1 { QUARTER - arc } else { arc });
    let arc = with_sign_of(l, y, supplement_by(l, x, arc));
    l.gates([arc], |[arc]| arc & 0xffff)
}

/// Polar angle of a vector's z, its arc cosine; ±1 are exact.
#[inline(always)]
pub(crate) fn polar_angle<L: Logic>(l: &L, arc_cosine: &Rom, z: L::Value) -> L::Value {
    let height = magnitude(l, z);
    let arc = read_magnitude(l, arc_cosine, height);
    let arc = l.gates([arc, height], |[arc, height]| if height >= ONE { 0 } else { arc });
    supplement_by(l, z, arc)
}

/// The unit used by every unit that stays polar, eqs. (24), (25) with one multiplier:
/// `C₊ + (C₋ − C₊)·cos²(Δ/2)`, `C± = cos(θ ± θ')`.
#[inline(always)]
pub(crate) fn polar_product<L: Logic>(l: &L, sine: &Sine, a: Polar<L::Value>, b: Polar<L::Value>) -> L::Value {
    let sum = cos(l, sine, l.turn(a.polar, b.polar));
    let difference = cos(l, sine, l.turn_back(a.polar, b.polar));
    let k = cos_squared_of_half(l, sine, l.turn_back(a.azimuth, b.azimuth));
    l.add(sum, l.multiply(l.sub(difference, sum), k, 14))
}

/// `sin θ sin Δ = [cos(θ − Δ) − cos(θ + Δ)]/2`, the part of a vector across the normal's meridian.
#[inline(always)]
pub(crate) fn across<L: Logic>(l: &L, sine: &Sine, polar: L::Value, delta: L::Value) -> L::Value {
    let difference = cos(l, sine, l.turn_back(polar, delta));
    let sum = cos(l, sine, l.turn(polar, delta));
    half(l, l.sub(difference, sum))
}

/// Sum of three products, without shifting.
#[inline(always)]
pub(crate) fn dot<L: Logic>(l: &L, a: [L::Value; 3], b: [L::Value; 3]) -> L::Value {
    let [x, y, z] = [0, 1, 2].map(|k| l.multiply(a[k], b[k], 0));
    l.add(l.add(x, y), z)
}

/// A vector of unit length in the same direction, Q2.14: three squares, a root, three quotients.
#[inline(always)]
pub(crate) fn normalize<L: Logic>(l: &L, a: [L::Value; 3]) -> [L::Value; 3] {
    let length = l.root(dot(l, a, a));
    a.map(|a| l.divide(a, length, 14))
}

/// The same number, from Q4.28 to Q2.14.
#[inline(always)]
pub(crate) fn narrow<L: Logic>(l: &L, a: L::Value) -> L::Value {
    l.gates([a], |[a]| a >> 14)
}

/// `y · 1/c` in Q6.10.
#[inline(always)]
pub(crate) fn times_reciprocal<L: Logic>(l: &L, y: L::Value, reciprocal: L::Value) -> L::Value {
    l.multiply(y, reciprocal, 14)
}

const _: () = assert!(RECIPROCAL_FRACTION == 10, "log_address takes Q6.10");
