//! A brick wall in running bond.

use super::covering::{Covering, blend, whole};
use super::noise::{mix, smoothstep, tile_noise, tile_octaves};
use crate::color::LinearRgb;
use crate::{Error, Result};

/// Bricks across, and courses of them.
const ACROSS: u32 = 4;
const COURSES: u32 = 8;
/// Half the width of a joint, in heights of a course.
const JOINT: f32 = 0.075;
/// The radius of a brick's corners, in heights of a course.
const CORNER: f32 = 0.09;
/// From the bottom of the joints to the top of the bricks, as a share of the map's width.
const DEPTH: f32 = 0.014;

/// A brick wall, `side` × `side` texels: four bricks across, eight courses, every second one shifted by half a brick. It
/// tiles. The heights are the same bits on every machine.
///
/// # Errors
/// [`Error::Parameter`] for a side below 64, [`Error::Size`] for one that is too large.
///
/// ```
/// let wall = rilievo::sample::bricks(128)?;
/// assert_eq!((wall.height.heights().size(), wall.color.size()), ((128, 128), (128, 128)));
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn bricks(side: u32) -> Result<Covering> {
    if side < 64 {
        return Err(Error::parameter("map side", side, "at least 64 texels"));
    }
    let [dark, light, pale, mortar] =
        [[116, 52, 38], [176, 88, 60], [190, 142, 108], [168, 160, 148]].map(LinearRgb::from_srgb);
    let texel = COURSES as f32 / side as f32;
    Covering::paint((side, side), DEPTH, |u, v| {
        let (course, y) = whole(v * COURSES as f32);
        let (brick, x) = whole(u * ACROSS as f32 + 0.5 * (course % 2) as f32);
        let brick = brick % ACROSS;
        // One value for a brick: the corners of the lattice.
        let chance = |seed| tile_noise(brick as f32, course as f32, [ACROSS, COURSES], seed);
        let rough = |scale: u32, seed| tile_octaves(u, v, [ACROSS * scale, COURSES * scale], seed);
        // To the joint, in heights of a course; a brick is twice as long as it is high, and hands made it.
        let edge = rounded([2.0 * (0.5 - (x - 0.5).abs()), 0.5 - (y - 0.5).abs()]) + 0.02 * rough(6, 1);
        let face = smoothstep(JOINT - 0.03, JOINT + 0.05 + texel, edge);
        let grain = rough(14, 2);
        let height = mix(0.12 + 0.10 * rough(20, 3), 0.80 + 0.10 * chance(4) + 0.09 * grain, face);
        let burnt = blend(dark, light, (0.5 + 0.45 * chance(5) + 0.25 * grain).clamp(0.0, 1.0));
        let body = blend(burnt, pale, 0.5 * smoothstep(0.45, 0.95, chance(6)));
        let shade = 1.0 - 0.35 * smoothstep(JOINT + 0.10, JOINT, edge);
        (
            height,
            blend(mortar * (0.55 + 0.2 * rough(24, 7)), body * shade, smoothstep(JOINT - 0.01, JOINT + 0.02, edge)),
        )
    })
}

/// Distance to the nearer side, less where two sides meet.
fn rounded([x, y]: [f32; 2]) -> f32 {
    let corner = CORNER + JOINT;
    let (dx, dy) = ((corner - x).max(0.0), (corner - y).max(0.0));
    if dx > 0.0 && dy > 0.0 { corner - (dx * dx + dy * dy).sqrt() } else { x.min(y) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wall_tiles_and_joints_are_low() {
        let wall = bricks(256).unwrap();
        let heights = wall.height.heights();
        let step = |pairs: &mut dyn Iterator<Item = (f32, f32)>| pairs.map(|(a, b)| (a - b).abs()).sum::<f32>() / 256.0;
        let columns = |a: u32, b: u32| step(&mut (0..256).map(|y| (heights[(a, y)], heights[(b, y)])));
        let rows = |a: u32, b: u32| step(&mut (0..256).map(|x| (heights[(x, a)], heights[(x, b)])));
        let most = |step: &dyn Fn(u32, u32) -> f32| (0..255).map(|i| step(i, i + 1)).fold(0.0, f32::max);
        assert!(columns(255, 0) <= most(&columns) && rows(255, 0) <= most(&rows));
        // The first row is a joint, the middle of the first course a row of bricks.
        let mean = |y: u32| heights.row(y).iter().sum::<f32>() / 256.0;
        assert!(mean(0) < 0.3 && mean(16) > 0.6, "{} {}", mean(0), mean(16));
        assert!(heights.texels().iter().all(|h| (0.0..=1.0).contains(h)));
    }

    #[test]
    fn sides_have_limits() {
        assert!(bricks(63).is_err() && bricks(1 << 20).is_err());
    }
}
