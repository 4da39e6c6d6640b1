//! A wall of wooden boards.

use super::covering::{Covering, blend, whole};
use super::noise::{mix, smoothstep, tile_noise, tile_octaves};
use crate::color::LinearRgb;
use crate::{Error, Result};

/// Boards, one above the other.
const BOARDS: u32 = 6;
/// Half the width of a gap, in heights of a board.
const GAP: f32 = 0.035;
/// Lines of the grain on a board, about.
const LINES: f32 = 11.0;
/// From the bottom of the gaps to the face of the boards, as a share of the map's width.
const DEPTH: f32 = 0.012;

/// A wall of six weathered boards, `side` × `side` texels, with the grain along u. It tiles. The heights are the same bits
/// on every machine.
///
/// # Errors
/// [`Error::Parameter`] for a side below 64, [`Error::Size`] for one that is too large.
///
/// ```
/// let wall = rilievo::sample::planks(128)?;
/// assert_eq!((wall.height.heights().size(), wall.color.size()), ((128, 128), (128, 128)));
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn planks(side: u32) -> Result<Covering> {
    if side < 64 {
        return Err(Error::parameter("map side", side, "at least 64 texels"));
    }
    let [early, late, pale] = [[190, 134, 82], [112, 66, 36], [206, 166, 118]].map(LinearRgb::from_srgb);
    let texel = BOARDS as f32 / side as f32;
    Covering::paint((side, side), DEPTH, |u, v| {
        let (board, y) = whole(v * BOARDS as f32);
        let chance = |seed| tile_noise(0.0, board as f32, [1, BOARDS], seed);
        // The log's rings, cut lengthwise: nearly straight lines, bent where the tree was.
        let bend = tile_octaves(u, v, [2, BOARDS], 11) * 0.5 + tile_octaves(u, v, [5, 3 * BOARDS], 12) * 0.16;
        let (_, ring) = whole((y + bend + 4.0 + chance(13)) * LINES);
        let line = smoothstep(0.25, 0.85, ring) * smoothstep(1.0, 0.9, ring);
        // Pores are short and lie along the grain.
        let pores = tile_octaves(u, v, [12, 40 * BOARDS], 14);
        let edge = 0.5 - (y - 0.5).abs();
        let face = smoothstep(GAP - 0.02, GAP + 0.07 + texel, edge);
        let weather = 0.16 * line + 0.05 * pores + 0.05 * chance(15);
        let height = mix(0.05, 0.72 + weather, face);
        let wood = blend(early, late, (0.15 + 0.65 * line - 0.15 * pores).clamp(0.0, 1.0));
        let wood = blend(wood, pale, (0.3 + 0.3 * chance(16)).clamp(0.0, 1.0)) * (1.0 + 0.22 * chance(17));
        let shade = 1.0 - 0.75 * smoothstep(GAP + 0.05, GAP - 0.02, edge);
        (height, wood * shade)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boards_run_across_and_gaps_are_low() {
        let wall = planks(192).unwrap();
        let heights = wall.height.heights();
        let mean = |y: u32| heights.row(y).iter().sum::<f32>() / 192.0;
        // A board is 32 rows high.
        assert!(mean(0) < 0.3 && mean(16) > 0.6 && mean(32) < 0.3, "{} {} {}", mean(0), mean(16), mean(32));
        let seam = (0..192).map(|y| (heights[(191, y)] - heights[(0, y)]).abs()).sum::<f32>() / 192.0;
        let inside = (0..192).map(|y| (heights[(96, y)] - heights[(97, y)]).abs()).sum::<f32>() / 192.0;
        assert!(seam < 2.0 * inside, "{seam} {inside}");
        assert!(planks(63).is_err());
    }
}
