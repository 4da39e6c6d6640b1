//! Sines, arcs and roots in integers: what tables are computed with, the same on every machine.
//!
//! Angles are fractions of a turn with 60 binary places (`TURN` is a full turn), values have 60 binary places
//! (`ONE` is 1). The series are good to some 2⁻⁵⁵, far below the half unit of a 16-bit word.

/// One, and a full turn.
pub(crate) const ONE: i128 = 1 << 60;
pub(crate) const TURN: i128 = 1 << 60;
/// 2π with 60 binary places.
const TWO_PI: i128 = 7_244_019_458_077_122_842;

/// Sine and cosine of a fraction of a turn.
pub(crate) fn sin_cos(angle: i128) -> (i128, i128) {
    let angle = angle.rem_euclid(TURN);
    let quadrant = (angle * 4) / TURN;
    let within = angle - quadrant * (TURN / 4);
    // The series are short below an eighth of a turn; above it, the other one from the other end.
    let (sin, cos) = if within <= TURN / 8 { series(within) } else { swap(series(TURN / 4 - within)) };
    match quadrant {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

fn swap((a, b): (i128, i128)) -> (i128, i128) {
    (b, a)
}

/// Taylor's series of sine and cosine for up to an eighth of a turn.
fn series(angle: i128) -> (i128, i128) {
    let x = (angle * TWO_PI) >> 60;
    let square = (x * x) >> 60;
    let (mut sin, mut cos) = (0, 0);
    let (mut odd, mut even) = (x, ONE);
    let mut k = 0;
    while odd != 0 || even != 0 {
        sin += odd;
        cos += even;
        even = -((even * square) >> 60) / ((2 * k + 1) * (2 * k + 2));
        odd = -((odd * square) >> 60) / ((2 * k + 2) * (2 * k + 3));
        // Shifts round down: what is left of a negative term would never become zero.
        if odd.abs() <= 1 && even.abs() <= 1 {
            break;
        }
        k += 1;
    }
    (sin, cos)
}

/// The whole number nearest to `arc(x) · steps / (a quarter turn)`, for a function `at_least(angle)` that tells whether
/// the arc that is sought is at least `angle`.
pub(crate) fn nearest_step(steps: u32, at_least: impl Fn(i128) -> bool) -> u32 {
    // The nearest number is how many of the midpoints between numbers lie at or below the arc.
    let (mut low, mut high) = (0, steps);
    while low < high {
        let middle = (low + high) / 2;
        let midpoint = (i128::from(middle) * 2 + 1) * (TURN / 8) / i128::from(steps);
        if at_least(midpoint) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// Arc sine of a value in [0, 1], in `steps` of a quarter turn, to the nearest.
pub(crate) fn arc_sine(value: i128, steps: u32) -> u32 {
    nearest_step(steps, |angle| sin_cos(angle).0 <= value)
}

/// Arc cosine of a value in [0, 1], in `steps` of a quarter turn, to the nearest.
pub(crate) fn arc_cosine(value: i128, steps: u32) -> u32 {
    nearest_step(steps, |angle| sin_cos(angle).1 >= value)
}

/// Arc tangent of a quotient of values ≥ 0, in `steps` of a quarter turn, to the nearest.
pub(crate) fn arc_tangent(numerator: i128, denominator: i128, steps: u32) -> u32 {
    nearest_step(steps, |angle| {
        let (sin, cos) = sin_cos(angle);
        sin * denominator <= cos * numerator
    })
}

/// The whole number nearest to a quotient of numbers ≥ 0.
pub(crate) fn nearest_quotient(numerator: i128, denominator: i128) -> i128 {
    (2 * numerator + denominator) / (2 * denominator)
}
