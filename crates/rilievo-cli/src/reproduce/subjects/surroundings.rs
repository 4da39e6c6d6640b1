//! What mirrors show: a room with two bright windows, painted by code.

use std::sync::Arc;

use anyhow::Result;
use rilievo::light::{Environment, Projection};
use rilievo::{Grid, LinearRgb};

/// Height of the panorama in pixels.
const ROWS: u32 = 256;

/// A panorama of the room.
pub(crate) fn surroundings() -> Result<Arc<Environment>> {
    let panorama = Grid::from_fn(2 * ROWS, ROWS, |x, y| {
        room((x as f32 + 0.5) / (2 * ROWS) as f32, 1.0 - 2.0 * (y as f32 + 0.5) / ROWS as f32)
    })?;
    Ok(Arc::new(Environment::new(Projection::Equirectangular, &panorama)?))
}

/// The room in direction `turn` (0 … 1 from left to right) and `up` (−1 straight down … 1 straight up).
fn room(turn: f32, up: f32) -> LinearRgb {
    // Behind the eye, which sees it mirrored, the middle of the room is at both ends of the panorama.
    for (middle, width, light) in
        [(0.09, 0.065, LinearRgb::new(1.1, 1.2, 1.35)), (0.74, 0.09, LinearRgb::new(0.9, 0.95, 1.0))]
    {
        let (side, height) = ((turn - middle) / width, (up - 0.24) / 0.26);
        if side.abs() < 1.0 && height.abs() < 1.0 {
            let on_bar = side.abs() < 0.07 || (height - 0.2).abs() < 0.06;
            return if on_bar { LinearRgb::new(0.16, 0.12, 0.09) } else { light };
        }
    }
    if up > 0.62 {
        return LinearRgb::new(0.55, 0.53, 0.5) * (0.8 + 0.4 * up);
    }
    if up < -0.35 {
        // Boards that run towards the middle.
        let board = (turn * 36.0).floor() as i32 % 2 == 0;
        return LinearRgb::new(0.26, 0.14, 0.07) * if board { 1.0 } else { 0.7 };
    }
    let wall = LinearRgb::new(0.34, 0.24, 0.2);
    // A darker band above the floor.
    if up < -0.24 { wall * 0.3 } else { wall * (0.85 + 0.4 * up) }
}
