//! Reliefs for golden pictures, made without libm: the same bits everywhere.

use rilievo::Grid;

/// A raised letter F, which no mirroring or turning maps to itself, and a dome at its right foot. Tiles; side 1.
pub(crate) fn letter_and_dome(side: u32) -> Grid<f32> {
    let at = |i: u32| (i as f32 + 0.5) / side as f32;
    Grid::from_fn(side, side, |x, y| {
        let (x, y) = (at(x), at(y));
        let bars = [(0.22, 0.5, 0.06, 0.36), (0.45, 0.2, 0.29, 0.06), (0.38, 0.48, 0.22, 0.06)];
        let letter = bars.map(|(cx, cy, hx, hy)| bar(x - cx, y - cy, hx, hy)).into_iter().fold(0.0, f32::max);
        letter.max(dome(x - 0.66, y - 0.74, 0.17))
    })
    .unwrap()
}

/// A ramp that rises to the right, with the letter on it: does not tile, so that `wrap` and `clamp` differ.
pub(crate) fn letter_on_ramp(side: u32) -> Grid<f32> {
    let letter = letter_and_dome(side);
    Grid::from_fn(side, side, |x, y| 0.5 * letter[(x, y)] + x as f32 / side as f32).unwrap()
}

/// Height of a rectangle of half sides `hx`, `hy` with bevelled flanks.
fn bar(x: f32, y: f32, hx: f32, hy: f32) -> f32 {
    const BEVEL: f32 = 0.05;
    let outside = (x.abs() - hx).max(y.abs() - hy);
    (0.5 - outside / BEVEL).clamp(0.0, 1.0)
}

/// A smooth bump of radius `r`.
fn dome(x: f32, y: f32, r: f32) -> f32 {
    let inside = (1.0 - (x * x + y * y) / (r * r)).max(0.0);
    inside * inside
}
