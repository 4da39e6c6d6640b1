//! Slopes against a general fit of a plane in f64, solved from its normal equations.
#![allow(clippy::unwrap_used, reason = "a test may panic and tell its figures")]

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use rilievo::height::{Filter, HeightMap, slopes, to_normals};
use rilievo::{Edges, Grid};
use testkit::Random;

const FILTERS: [Filter; 4] = [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr];
const EDGES: [Edges; 3] = [Edges::Wrap, Edges::Clamp, Edges::Mirror];

/// Weight of the neighbour at (dx, dy); 0 if the filter does not look there.
fn weight(filter: Filter, dx: i64, dy: i64) -> f64 {
    let product = |side: f64, here: f64| {
        let w = |d: i64| if d == 0 { here } else { side };
        w(dx) * w(dy)
    };
    match filter {
        Filter::Plane4 => f64::from(u8::from(dx == 0 || dy == 0)),
        Filter::Plane8 => 1.0,
        Filter::Sobel => product(1.0, 2.0),
        Filter::Scharr => product(3.0, 10.0),
    }
}

/// The plane z = a0·x + a1·y + a2 (x right, y up, in texels) of weighted least squares around texel (x, y).
fn fitted_slope(heights: &Grid<f32>, filter: Filter, edges: Edges, x: i64, y: i64) -> [f64; 2] {
    let (width, height) = heights.size();
    // In a clamped corner the default filter fits the diagonal neighbour as well.
    let one_sided = |i: i64, len: u32| len > 1 && (i == 0 || i + 1 == i64::from(len));
    let corner = edges == Edges::Clamp && one_sided(x, width) && one_sided(y, height);
    let filter = if corner && filter == Filter::Plane4 { Filter::Plane8 } else { filter };
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for dy in -1..=1i64 {
        for dx in -1..=1i64 {
            let inside = (0..i64::from(width)).contains(&(x + dx)) && (0..i64::from(height)).contains(&(y + dy));
            if edges == Edges::Clamp && !inside {
                continue;
            }
            let z = heights[(edges.resolve(x + dx, width), edges.resolve(y + dy, height))];
            let p = DVec3::new(dx as f64, -dy as f64, 1.0);
            let w = weight(filter, dx, dy);
            normal += w * DMat3::from_cols(p * p.x, p * p.y, p * p.z);
            right += w * f64::from(z) * p;
        }
    }
    // A direction without neighbours leaves a zero row: any slope fits, 0 is the smallest.
    for axis in 0..2 {
        if normal.col(axis)[axis] == 0.0 {
            normal.col_mut(axis)[axis] = 1.0;
        }
    }
    let plane = normal.inverse() * right;
    [plane.x, plane.y]
}

fn compare(heights: &Grid<f32>, depth: f32) {
    let map = HeightMap::new(heights.clone(), depth).unwrap();
    let scale = f64::from(depth) * f64::from(heights.width());
    for filter in FILTERS {
        for edges in EDGES {
            let found = slopes(&map, filter, edges);
            let normals = to_normals(&map, filter, edges);
            for y in 0..heights.height() {
                for x in 0..heights.width() {
                    let expected = fitted_slope(heights, filter, edges, x.into(), y.into()).map(|s| s * scale);
                    let here = format!("{filter:?} {edges:?} {:?} at ({x}, {y})", heights.size());
                    for axis in 0..2 {
                        let error = f64::from(found[(x, y)][axis]) - expected[axis];
                        assert!(error.abs() <= 1e-6 * scale.abs(), "{here}: {:?} {expected:?}", found[(x, y)]);
                    }
                    let n = DVec3::new(-expected[0], -expected[1], 1.0).normalize();
                    let chord = (normals[(x, y)].vec().as_dvec3() - n).length();
                    assert!(chord <= 1e-6 * scale.abs().max(1.0), "{here}: {chord}");
                }
            }
        }
    }
}

fn random_heights(width: u32, height: u32, seed: u64) -> Grid<f32> {
    let mut random = Random::new(seed);
    Grid::from_fn(width, height, |_, _| random.unit() as f32).unwrap()
}

#[test]
fn every_small_size_matches_the_normal_equations() {
    for width in 1..=6 {
        for height in 1..=6 {
            compare(&random_heights(width, height, u64::from(width * 100 + height)), 0.3);
        }
    }
}

#[test]
fn odd_and_large_sizes_match_the_normal_equations() {
    for (width, height) in [(37, 1), (1, 41), (67, 13), (128, 3)] {
        compare(&random_heights(width, height, 7), -1.0 / width as f32);
    }
}

#[test]
fn ramp_on_a_high_plateau_is_exact_up_to_the_corners() {
    // Metres of altitude, not 0 … 1: averages must not drown the differences.
    let heights = Grid::from_fn(9, 7, |x, y| 8000.0 + 2.0 * x as f32 - 3.0 * y as f32).unwrap();
    let map = HeightMap::new(heights, 1.0 / 9.0).unwrap();
    for filter in FILTERS {
        for slope in slopes(&map, filter, Edges::Clamp).texels() {
            assert!((slope[0] - 2.0).abs() < 1e-6 && (slope[1] - 3.0).abs() < 1e-6, "{filter:?} {slope:?}");
        }
    }
}

#[test]
fn wrapped_map_may_be_rolled() {
    let (w, h) = (11, 6);
    let heights = random_heights(w, h, 3);
    let rolled = Grid::from_fn(w, h, |x, y| heights[((x + 4) % w, (y + 5) % h)]).unwrap();
    for filter in FILTERS {
        let a = slopes(&HeightMap::new(heights.clone(), 0.1).unwrap(), filter, Edges::Wrap);
        let b = slopes(&HeightMap::new(rolled.clone(), 0.1).unwrap(), filter, Edges::Wrap);
        for y in 0..h {
            for x in 0..w {
                assert_eq!(b[(x, y)], a[((x + 4) % w, (y + 5) % h)], "{filter:?} ({x}, {y})");
            }
        }
    }
}

proptest! {
    // An integration test has no source folder to keep failing cases in; the seed in the message is enough.
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mirrored_map_has_the_mirrored_bits(w in 1u32..9, h in 1u32..9, seed: u64, filter in 0usize..4, edges in 0usize..3) {
        let (filter, edges) = (FILTERS[filter], EDGES[edges]);
        let heights = random_heights(w, h, seed);
        let here = slopes(&HeightMap::new(heights.clone(), 0.2).unwrap(), filter, edges);
        let flip_x = Grid::from_fn(w, h, |x, y| heights[(w - 1 - x, y)]).unwrap();
        let flip_x = slopes(&HeightMap::new(flip_x, 0.2).unwrap(), filter, edges);
        let flip_y = Grid::from_fn(w, h, |x, y| heights[(x, h - 1 - y)]).unwrap();
        let flip_y = slopes(&HeightMap::new(flip_y, 0.2).unwrap(), filter, edges);
        for y in 0..h {
            for x in 0..w {
                let [dx, dy] = here[(x, y)];
                prop_assert_eq!(flip_x[(w - 1 - x, y)], [-dx, dy]);
                prop_assert_eq!(flip_y[(x, h - 1 - y)], [dx, -dy]);
            }
        }
    }
}
