//! Scan conversion against an exact oracle: meshes own every pixel centre inside them once, and none outside.

use glam::DVec2;
use rilievo::fill::{SUBPIXEL_BITS, Triangle};
use testkit::Random;

/// Sub-pixels in a pixel.
const ONE: i64 = 1 << SUBPIXEL_BITS;
/// Side of the picture in pixels: wide enough for the rasteriser to take its short cut for wide rows.
const SIDE: u32 = 64;

type Point = [i64; 2];

fn cross(a: Point, b: Point, c: Point) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// How many triangles own each pixel. Corners in sub-pixels, so nothing is rounded on the way.
#[derive(Clone)]
struct Owners(Vec<u32>);

impl Owners {
    fn none() -> Self {
        Self(vec![0; (SIDE * SIDE) as usize])
    }

    fn draw(&mut self, corners: [Point; 3]) {
        self.draw_exact(corners.map(|p| DVec2::new(p[0] as f64, p[1] as f64) / ONE as f64));
    }

    fn draw_exact(&mut self, corners: [DVec2; 3]) {
        let Some(triangle) = Triangle::new(corners) else { return };
        triangle.for_each_pixel(0..SIDE, 0..SIDE, |x, y, weights| {
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{weights:?}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{weights:?}");
            self.0[(y * SIDE + x) as usize] += 1;
        });
    }

    /// Fails at the first pixel that is not owned as often as it should be.
    fn expect(&self, what: &str, mut expected: impl FnMut(Point) -> u32) {
        for y in 0..SIDE {
            for x in 0..SIDE {
                let centre = [i64::from(x) * ONE + ONE / 2, i64::from(y) * ONE + ONE / 2];
                let owned = self.0[(y * SIDE + x) as usize];
                assert_eq!(owned, expected(centre), "{what}: pixel ({x}, {y})");
            }
        }
    }
}

/// Whether the top-left rule gives `p` to the polygon: the crossing number of a point moved right by ε and down by ε².
///
/// That move takes centres on left edges and on top edges inside and those on right and bottom edges outside, with
/// nothing but integers; it knows nothing of triangles and edge functions.
fn owns(polygon: &[Point], p: Point) -> bool {
    let mut inside = false;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        // "Below the moved point" is "below or level with p": the move is down.
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let (upper, lower) = if a[1] < b[1] { (a, b) } else { (b, a) };
            // p strictly left of the edge; on it, the move to the right has passed it.
            inside ^= cross(upper, lower, p) > 0;
        }
    }
    inside
}

/// Sorts by direction from `centre`, exactly.
fn sort_around(ring: &mut [Point], centre: Point) {
    let half = |p: &Point| (p[1], p[0]) < (centre[1], centre[0]);
    ring.sort_by(|a, b| half(a).cmp(&half(b)).then(0.cmp(&cross(centre, *a, *b))));
}

/// A centre and a ring about it, in order; `None` if the ring leaves more than half a turn open.
fn random_fan(random: &mut Random, kind: u64) -> Option<(Point, Vec<Point>)> {
    let pixels = i64::from(SIDE);
    let mut whole = |low: i64, high: i64| low + (random.bits() % (high - low) as u64) as i64;
    let centre = [whole(0, pixels * ONE), whole(0, pixels * ONE)];
    let count = whole(3, 12);
    let (direction, length) = ([whole(-300, 300), whole(-300, 300)], whole(1, 40));
    let (centre, mut ring): (Point, Vec<Point>) = match kind {
        // Anywhere, also outside the picture.
        0 => (centre, (0..count).map(|_| [whole(-2560, 20_480), whole(-2560, 20_480)]).collect()),
        // Slivers: two bunches of points, far away in opposite directions, a few sub-pixels wide.
        1 => (
            centre,
            (0..count)
                .map(|i| {
                    let far = if i % 2 == 0 { length } else { -length };
                    [centre[0] + far * direction[0] + whole(-3, 4), centre[1] + far * direction[1] + whole(-3, 4)]
                })
                .collect(),
        ),
        // On pixel centres and corners, so that edges run through centres.
        2 => {
            let snap = |p: Point| p.map(|c| c / (ONE / 2) * (ONE / 2));
            (snap(centre), (0..count).map(|_| snap([whole(0, pixels * ONE), whole(0, pixels * ONE)])).collect())
        }
        // A few pixels of half-pixel steps: nearly all centres lie on edges.
        3 => {
            let corner = centre.map(|c| c / ONE * ONE);
            let mut near = || [corner[0] + whole(-4, 5) * ONE / 2, corner[1] + whole(-4, 5) * ONE / 2];
            (near(), (0..count).map(|_| near()).collect())
        }
        // Tiny: less than a pixel, about a pixel centre.
        _ => {
            let corner = centre.map(|c| c / ONE * ONE + ONE / 2);
            let mut near = || [corner[0] + whole(-20, 21), corner[1] + whole(-20, 21)];
            (near(), (0..count).map(|_| near()).collect())
        }
    };
    ring.retain(|p| *p != centre);
    sort_around(&mut ring, centre);
    let n = ring.len();
    let closed = n >= 3
        && (0..n).all(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % n]);
            let turn = cross(centre, a, b);
            // On one line with the centre, but not on the same side: exactly half a turn. That is still a polygon.
            turn >= 0
        });
    closed.then_some((centre, ring))
}

#[test]
fn ten_thousand_fans_own_each_centre_once() {
    let mut random = Random::new(7);
    let (mut fans, mut owned, mut on_edges) = ([0u32; 5], 0u64, 0u64);
    while fans.iter().sum::<u32>() < 10_000 {
        // Each kind as often as the others, though some rings are refused.
        let kind = (0..5).min_by_key(|&k| fans[k]).expect("five kinds");
        let Some((centre, ring)) = random_fan(&mut random, kind as u64) else { continue };
        fans[kind] += 1;
        let mut owners = Owners::none();
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            // Either winding, any corner first.
            let turned =
                [[centre, a, b], [a, b, centre], [b, centre, a], [a, centre, b], [centre, b, a], [b, a, centre]];
            owners.draw(turned[(random.bits() % 6) as usize]);
        }
        let what = format!("fan of kind {kind} about {centre:?}: {ring:?}");
        owners.expect(&what, |p| {
            let inside = owns(&ring, p);
            owned += u64::from(inside);
            on_edges += u64::from(ring.iter().any(|&v| inside && p != centre && cross(centre, v, p) == 0));
            u32::from(inside)
        });
    }
    // The test is worth something only if many centres were inside, and many on the lines of inner edges.
    assert!(owned > 1_000_000 && on_edges > 10_000, "{owned} centres, {on_edges} on edges");
}

#[test]
fn two_meshes_that_share_an_edge_own_all_between_them() {
    let mut random = Random::new(11);
    let side = i64::from(SIDE) * ONE;
    for round in 0..500 {
        // A line from top to bottom; half of them through pixel centres and corners.
        let step = if round % 2 == 0 { 1 } else { ONE / 2 };
        let mut whole = |low: i64, high: i64| low + (random.bits() % (high - low) as u64) as i64;
        let mut line = vec![[whole(0, side + 1) / step * step, 0]];
        while line[line.len() - 1][1] < side {
            let y = (line[line.len() - 1][1] + whole(0, 3 * ONE) / step * step).min(side);
            line.push([whole(0, side + 1) / step * step, y]);
        }
        let strip = |border: i64| {
            let mut owners = Owners::none();
            for pair in line.windows(2) {
                let (a, b) = ([border, pair[0][1]], [border, pair[1][1]]);
                owners.draw([a, pair[0], pair[1]]);
                owners.draw([a, pair[1], b]);
            }
            owners
        };
        let (left, right) = (strip(0), strip(side));
        let left_of_line: Vec<Point> = line.iter().copied().chain([[0, side], [0, 0]]).collect();
        left.expect("left mesh", |p| u32::from(owns(&left_of_line, p)));
        right.expect("right mesh", |p| u32::from(!owns(&left_of_line, p)));
    }
}

#[test]
fn corners_between_sub_pixels_leave_no_gap_and_no_overlap() {
    let mut random = Random::new(13);
    for cells in [1usize, 2, 7, 33, 90] {
        for _ in 0..20 {
            let pitch = f64::from(SIDE) / cells as f64;
            let vertices: Vec<DVec2> = (0..(cells + 1) * (cells + 1))
                .map(|i| {
                    let (x, y) = (i % (cells + 1), i / (cells + 1));
                    let mut jitter = |k: usize| {
                        let free = k != 0 && k != cells;
                        (k as f64 + if free { random.range(-0.3, 0.3) } else { 0.0 }) * pitch
                    };
                    DVec2::new(jitter(x), jitter(y))
                })
                .collect();
            let mut owners = Owners::none();
            for y in 0..cells {
                for x in 0..cells {
                    let at = |dx: usize, dy: usize| vertices[(y + dy) * (cells + 1) + x + dx];
                    owners.draw_exact([at(0, 0), at(0, 1), at(1, 1)]);
                    owners.draw_exact([at(0, 0), at(1, 1), at(1, 0)]);
                }
            }
            owners.expect("jittered grid", |_| 1);
        }
    }
}

#[test]
fn a_window_shows_what_the_whole_picture_shows() {
    let mut random = Random::new(17);
    for _ in 0..500 {
        let mut corner = || DVec2::new(random.range(-20.0, 90.0), random.range(-20.0, 90.0));
        let Some(triangle) = Triangle::new([corner(), corner(), corner()]) else { continue };
        let mut whole = vec![];
        triangle.for_each_pixel(0..SIDE, 0..SIDE, |x, y, w| whole.push((x, y, w)));
        let mut range = || {
            let (a, b) = ((random.bits() % 65) as u32, (random.bits() % 65) as u32);
            a.min(b)..a.max(b)
        };
        let (columns, rows) = (range(), range());
        let mut part = vec![];
        triangle.for_each_pixel(columns.clone(), rows.clone(), |x, y, w| part.push((x, y, w)));
        whole.retain(|(x, y, _)| columns.contains(x) && rows.contains(y));
        assert_eq!(part, whole);
    }
}
