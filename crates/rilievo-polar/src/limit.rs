//! How far an inner product can be from the exact one, from the word lengths alone.
//!
//! Notation: `s` is half a step of the sine's address, `(π/2)/2^(a+1)`; `r = 2⁻¹⁵` the rounding of a Q2.14 word to nearest, `t = 2⁻¹⁴`
//! that of rounding down; `c = s + r` the error of a sine or cosine. Then
//! - `k = (1 + cos Δ)/2` and halves of two cosines: `c/2 + r` and `c + r`;
//! - an interpolation `C₊ + (C₋ − C₊)k` is a mean of two cosines at most 2 apart: `g = c + 2(c/2 + r) + t = 2c + 2t`;
//! - an arc sine or cosine of a value that is off by ε: at most `arc(ε) = acos(1 − ε)`, the worst case at the end;
//! - a direction off by an angle δ changes an inner product by at most δ; a point off by δ at a distance ρ from an axis turns
//!   about it by at most `(π/2)·δ/ρ`, which moves a unit vector by `(π/2)·δ`.
//!
//! Limits are sums of these, never fitted to a measurement; measured errors are several times less.

use crate::model::UnitKind;
use crate::rom::exact::{ONE, arc_cosine};
use crate::rom::{FRACTION, Width};

/// Fractional bits in here.
const BITS: u32 = 40;
/// Half a unit and a unit of a Q2.14 word.
const R: i64 = 1 << (BITS - FRACTION - 1);
const T: i64 = 1 << (BITS - FRACTION);
/// π/2.
const HALF_PI: i64 = 1_727_108_826_179;

/// The largest error of an inner product, in units of 2⁻¹⁴, against exact arithmetic on exact angles and bump vectors.
///
/// None for units whose error is the method's (published, with exact Z), whose limits would say nothing of their words, and
/// for Blinn's, whose slopes end at ±8.
pub(crate) fn limit(kind: UnitKind, width: Width) -> Option<u32> {
    let a = width.bits();
    let one = 1i64 << BITS;
    let s = HALF_PI >> (a + 1);
    let c = s + R;
    let g = 2 * c + 2 * T;
    // A bump vector's angle to half a unit, its values to r each.
    let angle = HALF_PI >> 15;
    // Middles of a table over [0, 1].
    let middle = one >> (a + 1);
    let exact = |error: i64| Some(error);
    let error = match kind {
        UnitKind::Blinn | UnitKind::Published | UnitKind::ExactZ => None,
        // Each of u, v, w; the bump vector's three words; rounding down.
        UnitKind::E2 => exact(hypot(hypot(g, g), c + R) + root3(R) + T),
        // ρ·g + y·v, with ρ² + y² = 1.
        UnitKind::E3 => exact(hypot(g, c + R) + angle + 2 * R + T),
        UnitKind::E1 => {
            let arcs = to_polar(g, hypot(g, c + R), middle, a);
            exact(arcs + g + 2 * angle)
        }
        UnitKind::Kim => {
            // Matrix and vector are products of two, the vector's row product a sum of three.
            let part = root3(2 * (2 * c + T)) + T;
            let inner = 2 * (2 * c + T) + c;
            exact(to_polar(part, 2 * part, middle, a) + inner + 2 * angle)
        }
        UnitKind::E4 => {
            let across = arc(c + R + middle);
            // x, and z as the middle of a secant's interval or 1/64 where the secant ends.
            let point = hypot(c + R, (HALF_PI >> (a + 1)) + (one >> 6));
            // The logarithmic address: a − 4 bits of mantissa, Q6.10 quotients.
            let address = (one >> (a - 2)) + (one >> 10);
            exact(across + turn(point) + address + g + 2 * angle)
        }
        // Half a step of φN turns the vector; then two words, two bump words, the product.
        UnitKind::E4d => exact(s + 4 * angle + g),
        UnitKind::Peercy => {
            let row = root3(2 * R) + T;
            let vector = root3(row) + root3(T) + T;
            let bump = root3(R) + root3(T) + T;
            exact(vector + bump + T)
        }
        UnitKind::Kugler => {
            // Half cells of φ', θ' and θN in the map; its 8-bit words; the light map's address and words.
            let cells = (HALF_PI >> 4) + (HALF_PI >> 5) + (HALF_PI >> 5);
            let words = (HALF_PI >> 7) + (HALF_PI >> 8) + (HALF_PI >> 9) + (HALF_PI >> 9);
            exact(cells + words + (one >> 9) + T)
        }
    };
    error.map(|error| ((error + T - 1) >> (BITS - FRACTION)) as u32)
}

/// The angle by which polar angles are off, of a vector whose z is off by `z` and whose x and y together by `xy`: the arc
/// cosine's, and at the vector's end the azimuth's, with the reciprocal's and the arc tangent's middles.
fn to_polar(z: i64, xy: i64, middle: i64, a: u32) -> i64 {
    let quotient = 2 * (1i64 << BITS >> (a + 1)) + 2 * T;
    arc(z + middle) + turn(xy) + quotient + (HALF_PI >> 14)
}

/// `acos(1 − ε)`.
fn arc(error: i64) -> i64 {
    let cosine = (ONE - (i128::from(error) << (60 - BITS))).max(0);
    // Rounded up to steps of 2⁻²⁰ quarter turns.
    let steps = i128::from(arc_cosine(cosine, 1 << 20)) + 1;
    ((steps * i128::from(HALF_PI)) >> 20) as i64
}

/// `π/2 · δ`.
fn turn(error: i64) -> i64 {
    ((i128::from(error) * i128::from(HALF_PI)) >> BITS) as i64
}

fn hypot(a: i64, b: i64) -> i64 {
    let (a, b) = (i128::from(a), i128::from(b));
    (a * a + b * b).isqrt() as i64 + 1
}

/// Three times the same error, at right angles.
fn root3(error: i64) -> i64 {
    hypot(hypot(error, error), error)
}
