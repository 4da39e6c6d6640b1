//! Packed normals against the scalar path, and against f64.
#![allow(clippy::unwrap_used, reason = "a test may panic and tell its figures")]

use glam::DVec3;
use rilievo::height::{Filter, HeightMap, pack_normals, to_normals};
use rilievo::normal::encode_u8;
use rilievo::{Edges, Grid};
use testkit::Random;

const FILTERS: [Filter; 4] = [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr];
const EDGES: [Edges; 3] = [Edges::Wrap, Edges::Clamp, Edges::Mirror];

fn packed(heights: &Grid<u16>, depth: f32, filter: Filter, edges: Edges) -> Grid<[u8; 4]> {
    let mut out = heights.map(|_| [9; 4]);
    pack_normals(heights, depth, filter, edges, &mut out).unwrap();
    out
}

/// Codes by way of f32 heights and normals.
fn expected(heights: &Grid<u16>, depth: f32, filter: Filter, edges: Edges) -> Grid<[u8; 4]> {
    let map = HeightMap::new(heights.map(|&h| f32::from(h)), depth / 65_535.0).unwrap();
    to_normals(&map, filter, edges).map(|&n| {
        let [r, g, b] = encode_u8(n);
        [r, g, b, 255]
    })
}

fn random(width: u32, height: u32, steps: f64, seed: u64) -> Grid<u16> {
    let mut random = Random::new(seed);
    Grid::from_fn(width, height, |_, _| (random.unit() * steps) as u16).unwrap()
}

#[test]
fn same_bits_as_the_scalar_path_for_all_filters_edges_and_sizes() {
    for (width, height) in
        [(1, 1), (1, 5), (5, 1), (2, 2), (3, 4), (17, 3), (18, 3), (19, 3), (34, 2), (50, 7), (67, 5)]
    {
        for steps in [3.0, 300.0, 65_536.0] {
            let heights = random(width, height, steps, u64::from(width * height));
            for filter in FILTERS {
                for edges in EDGES {
                    for depth in [0.0, 0.013, -0.4, 3.0, 1e-20, 1e14] {
                        let found = packed(&heights, depth, filter, edges);
                        let here = format!("{width}×{height} of {steps}, {filter:?} {edges:?} {depth}");
                        assert!(found == expected(&heights, depth, filter, edges), "{here}");
                    }
                }
            }
        }
    }
}

#[test]
fn same_bits_where_components_lie_on_borders_of_codes() {
    // Millions of slopes, of which one in some hundreds is too close to a border to be estimated; slopes of nothing,
    // which lie on one; and depths that make slopes tiny.
    for (seed, depth) in [(1, 0.02), (2, 0.3), (3, 4.0), (4, 1e-4), (5, 1e-7), (6, 1e-10)] {
        for steps in [4.0, 600.0, 20_000.0] {
            let heights = random(1024, 256, steps, seed);
            for filter in FILTERS {
                let found = packed(&heights, depth, filter, Edges::Wrap);
                assert!(found == expected(&heights, depth, filter, Edges::Wrap), "{filter:?} {depth} {steps}");
            }
        }
    }
}

#[test]
fn codes_are_those_of_exact_normals() {
    let (side, depth) = (512u32, 0.05f32);
    let heights = random(side, side, 3000.0, 11);
    let found = packed(&heights, depth, Filter::Sobel, Edges::Wrap);
    let at = |x: i64, y: i64| f64::from(heights[(Edges::Wrap.resolve(x, side), Edges::Wrap.resolve(y, side))]);
    let mut off = 0;
    for y in 0..i64::from(side) {
        for x in 0..i64::from(side) {
            let row = |y: i64| at(x + 1, y) - at(x - 1, y);
            let column = |x: i64| at(x, y - 1) - at(x, y + 1);
            let scale = f64::from(depth) * f64::from(side) / 65_535.0 / 8.0;
            let right = (row(y - 1) + 2.0 * row(y) + row(y + 1)) * scale;
            let up = (column(x - 1) + 2.0 * column(x) + column(x + 1)) * scale;
            let n = DVec3::new(-right, -up, 1.0).normalize();
            let exact = n.to_array().map(|c| ((c + 1.0) * 127.5 + 0.5).floor() as i32);
            let code = found[(x as u32, y as u32)];
            let difference = (0..3).map(|k| (i32::from(code[k]) - exact[k]).abs()).max().unwrap();
            assert!(difference <= 1, "({x}, {y}): {code:?} {exact:?}");
            off += difference;
        }
    }
    // Rounding in f32 moves a component across a border about once in a hundred thousand.
    assert!(off < 30, "{off}");
}

#[test]
fn heights_scaled_to_one_first_give_codes_within_one() {
    let heights = random(640, 480, 65_536.0, 5);
    let map = HeightMap::new(heights.map(|&h| f32::from(h) / 65_535.0), 0.01).unwrap();
    for filter in FILTERS {
        let found = packed(&heights, 0.01, filter, Edges::Clamp);
        let scaled = to_normals(&map, filter, Edges::Clamp).map(|&n| encode_u8(n));
        let mut off = 0;
        for (a, b) in found.texels().iter().zip(scaled.texels()) {
            let difference = (0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap();
            assert!(difference <= 1, "{filter:?}: {a:?} {b:?}");
            off += usize::from(difference > 0);
        }
        assert!(off * 1000 < found.texels().len(), "{filter:?}: {off}");
    }
}

#[test]
fn white_is_up_and_green_is_up_the_picture() {
    // Brighter to the right and to the top, steep enough to see: the normal leans left and down.
    let heights = Grid::from_fn(40, 6, |x, y| (400 * x + 400 * (5 - y)) as u16).unwrap();
    for filter in FILTERS {
        for code in packed(&heights, 1.0, filter, Edges::Clamp).texels() {
            assert!(code[0] < 120 && code[1] < 120 && code[2] > 128 && code[3] == 255, "{filter:?} {code:?}");
        }
    }
}
