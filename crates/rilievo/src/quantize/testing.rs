//! What the tests of this folder share.

use super::entries::squared_f64;
use super::octahedral::morton;
use super::points::Points;

/// `count` points in `groups` groups: half all over the sphere, half in clusters of very different sizes.
pub(super) fn scattered(count: usize, groups: usize) -> Points {
    let mut state = 0x9e37_79b9u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 23) as f32 - 1.0
    };
    let part = |group: usize| (group * count / groups)..((group + 1) * count / groups);
    let mut group = |range: std::ops::Range<usize>| {
        let mut points: Vec<_> = range
            .map(|i| {
                let size = [1.0, 0.1, 1e-3, 1e-6][i % 4];
                let (center, v) = ([[0.0, 0.0, 1.0], [-0.6, 0.8, 0.0]][i / 4 % 2], [random(), random(), random()]);
                let v = if i % 2 == 0 { v } else { [0, 1, 2].map(|k| center[k] + size * v[k]) };
                (super::entries::unit(v.map(f64::from)).unwrap(), 1.0 + (i % 3) as f32)
            })
            .collect();
        points.sort_by_key(|p| morton(p.0));
        points
    };
    Points::new((0..groups).map(|g| (2 * g as u8, group(part(g)))))
}

/// The oracle: the first nearest direction.
pub(super) fn brute_force(point: [f32; 3], directions: &[[f32; 3]]) -> usize {
    let distance = |d: &[f32; 3]| squared_f64(point.map(f64::from), *d);
    (0..directions.len()).min_by(|&a, &b| distance(&directions[a]).total_cmp(&distance(&directions[b]))).unwrap()
}
