//! Normals spread to texels that have none: gutters, holes.

use crate::grid::Grid;
use crate::normal::{NormalMap, Space};
use crate::par;

/// No covered texel near in this column.
const NONE: i32 = i32::MAX;

/// Gives each texel that is not covered, but within `gutter` texels of one that is, the normal of the nearest. The masks
/// must have the map's size.
///
/// Distances are Euclidean, and run on over the edges of the map (it repeats). Of several nearest, the one least to the
/// side wins, then left before right, then up before down. First the nearest in each column is found, then the best of
/// the columns beside: exact, and the cost a texel is bounded by the gutter.
pub fn spread_normals<S: Space>(normals: &mut NormalMap<S>, covered: &Grid<bool>, gutter: u32) {
    let (width, height) = covered.size();
    let reach = gutter.min(width.max(height)) as i32;
    if reach == 0 || covered.texels().iter().all(|&c| c) {
        return;
    }
    let nearest = nearest_in_column(covered, reach);
    let source = normals.clone();
    par::for_each_row(normals.texels_mut(), width as usize, |y, row| {
        let below = nearest.row(y as u32);
        for (x, out) in row.iter_mut().enumerate().filter(|(x, _)| below[*x] != 0) {
            if let Some((dx, dy)) = nearest_about(below, x, reach) {
                let from_x = (x as i64 + i64::from(dx)).rem_euclid(width.into()) as u32;
                let from_y = (y as i64 + i64::from(dy)).rem_euclid(height.into()) as u32;
                *out = source[(from_x, from_y)];
            }
        }
    });
}

/// For each texel the way down (up if negative) to the nearest covered one in its column, within `reach`.
fn nearest_in_column(covered: &Grid<bool>, reach: i32) -> Grid<i32> {
    let (width, height) = covered.size();
    let mut nearest = covered.map(|&c| if c { 0 } else { NONE });
    // Twice: downwards the nearest above is carried along, upwards the nearest below; each starts outside the map by
    // the reach, because the map repeats.
    for down in [true, false] {
        let mut since = vec![NONE; width as usize];
        for step in -i64::from(reach)..i64::from(height) {
            let y = if down { step } else { i64::from(height) - 1 - step }.rem_euclid(height.into()) as u32;
            for x in 0..width {
                let since = &mut since[x as usize];
                *since = if covered[(x, y)] { 0 } else { since.saturating_add(1) };
                let best = &mut nearest[(x, y)];
                if step >= 0 && *since <= reach && *since < best.saturating_abs() {
                    *best = if down { -*since } else { *since };
                }
            }
        }
    }
    nearest
}

/// The step to the nearest covered texel within `reach` of column `x`, given those of each column.
fn nearest_about(nearest: &[i32], x: usize, reach: i32) -> Option<(i32, i32)> {
    let width = nearest.len() as i64;
    let mut best = None;
    let mut limit = i64::from(reach) * i64::from(reach) + 1;
    for side in 0..=reach {
        if i64::from(side) * i64::from(side) >= limit {
            break;
        }
        for dx in [-side, side] {
            let dy = nearest[(x as i64 + i64::from(dx)).rem_euclid(width) as usize];
            let distance = i64::from(dx) * i64::from(dx) + i64::from(dy) * i64::from(dy);
            if dy != NONE && distance < limit {
                limit = distance;
                best = Some((dx, dy));
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::{Normal, Object};
    use glam::Vec3;
    use proptest::prelude::*;

    /// A normal that tells its texel.
    fn label(x: u32, y: u32) -> Normal<Object> {
        Normal::new(Vec3::new(x as f32, y as f32, 100.0)).unwrap()
    }

    fn dilated(covered: &Grid<bool>, gutter: u32) -> NormalMap<Object> {
        let (width, height) = covered.size();
        let on = |x, y| if covered[(x, y)] { label(x, y) } else { Normal::Z };
        let mut normals = Grid::from_fn(width, height, on).unwrap();
        spread_normals(&mut normals, covered, gutter);
        normals
    }

    #[test]
    fn one_texel_spreads_to_a_disc_over_the_edges() {
        let covered = Grid::from_fn(9, 7, |x, y| (x, y) == (1, 1)).unwrap();
        let normals = dilated(&covered, 3);
        for y in 0..7i32 {
            for x in 0..9i32 {
                let dx = (x - 1).rem_euclid(9).min((1 - x).rem_euclid(9));
                let dy = (y - 1).rem_euclid(7).min((1 - y).rem_euclid(7));
                let expected = if dx * dx + dy * dy <= 9 { label(1, 1) } else { Normal::Z };
                assert_eq!(normals[(x as u32, y as u32)], expected, "({x}, {y})");
            }
        }
    }

    #[test]
    fn ties_go_left_then_up() {
        let row = Grid::new(7, 1, vec![false, true, false, false, false, true, false]).unwrap();
        assert_eq!(dilated(&row, 2)[(3, 0)], label(1, 0));
        let column = Grid::new(1, 7, vec![false, true, false, false, false, true, false]).unwrap();
        assert_eq!(dilated(&column, 2)[(0, 3)], label(0, 1));
    }

    #[test]
    fn no_gutter_and_nothing_covered_change_nothing() {
        let covered = Grid::from_fn(4, 4, |x, _| x == 0).unwrap();
        assert_eq!(dilated(&covered, 0)[(1, 1)], Normal::Z);
        let nothing = Grid::filled(3, 3, false).unwrap();
        assert!(dilated(&nothing, 8).texels().iter().all(|n| *n == Normal::Z));
    }

    proptest! {
        #[test]
        fn the_nearest_covered_texel_is_taken(
            width in 1u32..12, height in 1u32..12, gutter in 0u32..9, bits in prop::collection::vec(0u8..8, 144),
        ) {
            let covered = Grid::from_fn(width, height, |x, y| bits[(y * 12 + x) as usize] == 0).unwrap();
            let normals = dilated(&covered, gutter);
            let reach = i64::from(gutter.min(width.max(height)));
            for y in 0..i64::from(height) {
                for x in 0..i64::from(width) {
                    // The nearest by trying every step within reach.
                    let mut steps = vec![];
                    for dy in -reach..=reach {
                        for dx in -reach..=reach {
                            let at = ((x + dx).rem_euclid(width.into()) as u32, (y + dy).rem_euclid(height.into()) as u32);
                            if covered[at] && dx * dx + dy * dy <= reach * reach {
                                steps.push(((dx * dx + dy * dy, dx.abs(), dx, dy), at));
                            }
                        }
                    }
                    let expected = steps.iter().min().map_or(Normal::Z, |(_, at)| label(at.0, at.1));
                    prop_assert_eq!(normals[(x as u32, y as u32)], expected);
                }
            }
        }
    }
}
