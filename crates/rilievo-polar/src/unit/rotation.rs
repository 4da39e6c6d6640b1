//! Exact rotation of a vector into the meridian frame of the normal, without a matrix.
//!
//! `C± = cos(θ ± θN)`, `S± = sin(θ ± θN)`, `k = cos²(Δ/2)`, Δ = φ − φN:
//! - `u = sin θ' cos φ' = (S₊ + S₋)·k − S₊`
//! - `v = sin θ' sin φ' = [cos(θ − Δ) − cos(θ + Δ)]/2`
//! - `w = cos θ' = C₊ + (C₋ − C₊)·k`

use crate::logic::{Logic, Polar, across, cos_squared_of_half, sin_cos};
use crate::rom::Sine;

/// `(u, v, w)` of a vector: R_y(−θN)·R_z(−φN) applied to it. Two multipliers, ten adders, five tables.
#[inline(always)]
pub(crate) fn rotate_exactly<L: Logic>(
    l: &L,
    sine: &Sine,
    normal: Polar<L::Value>,
    vector: Polar<L::Value>,
) -> [L::Value; 3] {
    let delta = l.turn_back(vector.azimuth, normal.azimuth);
    let k = cos_squared_of_half(l, sine, delta);
    let [sin_sum, cos_sum] = sin_cos(l, sine, l.turn(vector.polar, normal.polar));
    let [sin_difference, cos_difference] = sin_cos(l, sine, l.turn_back(vector.polar, normal.polar));
    let u = l.sub(l.multiply(l.add(sin_sum, sin_difference), k, 14), sin_sum);
    let w = l.add(cos_sum, l.multiply(l.sub(cos_difference, cos_sum), k, 14));
    [u, across(l, sine, vector.polar, delta), w]
}
