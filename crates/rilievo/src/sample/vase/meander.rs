//! The meander (Greek key), by distance to a square grid: its corners must stay sharp, so strokes would not do.

/// The band line of one key, on a grid whose strokes are half a unit wide; the next key starts at (4, 0).
const KEY: [[f32; 2]; 9] =
    [[0.0, 0.0], [0.0, 3.0], [3.0, 3.0], [3.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 0.0], [4.0, 0.0]];

/// Keys between two squares with a cross, as Attic painters liked to stop the meander.
const KEYS: usize = 3;
/// Width of the stopping square and the gaps beside it, in units.
const STOP: f32 = 5.0;
/// Half the width of the line, in units.
const HALF: f32 = 0.26;
/// Width of one cell (three keys and a square) in units.
pub(super) const WIDTH: f32 = 4.0 * KEYS as f32 + STOP;
/// Height of the band in units.
pub(super) const HEIGHT: f32 = 3.0 + 2.0 * HALF;

/// Signed distance in units, positive inside the line, for x in 0 … [`WIDTH`] and y up from 0 to [`HEIGHT`].
pub(super) fn inside(x: f32, y: f32) -> f32 {
    let p = [x - HALF, y - HALF];
    let keys = 4.0 * KEYS as f32;
    let mut best = -HEIGHT;
    for key in 0..KEYS {
        for (i, way) in KEY.windows(2).enumerate() {
            let x0 = 4.0 * key as f32;
            // The last key ends with its foot, not in the next one.
            let last = key + 1 == KEYS && i + 2 == KEY.len();
            let end = if last { [3.0, 0.0] } else { way[1] };
            best = best.max(bar(p, [way[0][0] + x0, way[0][1]], [end[0] + x0, end[1]]));
        }
    }
    best.max(stop([p[0] - keys - 1.5, p[1] - 1.5]))
}

/// An axis-parallel line with square ends (distance in the maximum norm: bevels keep mitred corners).
fn bar(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let d = |i: usize| (p[i] - 0.5 * (a[i] + b[i])).abs() - 0.5 * (a[i] - b[i]).abs() - HALF;
    -d(0).max(d(1))
}

/// A square frame with a saltire and four dots; `p` from its centre.
fn stop(p: [f32; 2]) -> f32 {
    let (x, y) = (p[0].abs(), p[1].abs());
    let edge = x.max(y);
    let frame = (1.5 + HALF - edge).min(edge - (1.5 - HALF));
    let within = 1.5 - edge;
    let cross = (HALF * 0.8 - (x - y).abs() * std::f32::consts::FRAC_1_SQRT_2).min(within);
    let (far, near) = (x.max(y), x.min(y));
    let dot = 0.25 - ((far - 0.86) * (far - 0.86) + near * near).sqrt();
    frame.max(cross).max(dot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_and_gaps_alternate() {
        // Along the height through the inner hook of the first key: foot gap, hook, gap, top line.
        let at = |y: f32| inside(HALF + 2.0, HALF + y) > 0.0;
        assert_eq!([0.5, 1.0, 1.5, 2.0, 2.5, 3.0].map(at), [false, true, true, true, false, true]);
    }

    #[test]
    fn cell_ends_are_bare() {
        for y in 0..20 {
            let y = y as f32 * HEIGHT / 19.0;
            assert!(inside(WIDTH - 0.01, y) < 0.0, "{y}");
        }
    }
}
