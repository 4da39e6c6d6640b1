//! The first table: clusters are cut in two until there are enough.
//!
//! Each cut goes through the mean, across the direction of the largest spread, and the cluster with the largest spread
//! is next (Wu 1991 and Orchard and Bouman 1991 do so for colours). One heap serves all materials, so entries go where
//! they help most.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::entries::{Entries, unit};
use super::octahedral::hilbert;
use super::points::Points;
use super::spread::Spread;

/// A point with its weight and its number.
type Weighted = ([f32; 3], f32, u32);

struct Cluster {
    /// Spread along `axis`; the gain of a cut is about three quarters of it. −1 for a single point.
    gain: f64,
    group: usize,
    first: usize,
    last: usize,
    mean: [f64; 3],
    axis: [f64; 3],
}

impl Ord for Cluster {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(other.first.cmp(&self.first))
    }
}

impl PartialOrd for Cluster {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cluster {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cluster {}

impl Cluster {
    fn of(points: &[Weighted], group: usize, first: usize, last: usize) -> Self {
        let members = &points[first..last];
        let mut sum = [0.0; 4];
        for &([x, y, z], weight, _) in members {
            let weight = f64::from(weight);
            sum = super::tree::add(sum, [x, y, z, 1.0].map(|c| f64::from(c) * weight));
        }
        let mean = [0, 1, 2].map(|k| sum[k] / sum[3]);
        let mut spread = Spread::default();
        for &(p, weight, _) in members {
            spread.add([0, 1, 2].map(|k| f64::from(p[k]) - mean[k]), f64::from(weight));
        }
        let (axis, along) = spread.principal();
        let gain = if members.len() > 1 { along } else { -1.0 };
        Self { gain, group, first, last, mean, axis }
    }
}

/// Moves the members before the mean to the front; returns how many they are.
fn part(members: &mut [Weighted], mean: [f64; 3], axis: [f64; 3]) -> usize {
    let before = |&(p, ..): &Weighted| (0..3).map(|k| (f64::from(p[k]) - mean[k]) * axis[k]).sum::<f64>() < 0.0;
    let (mut i, mut j) = (0, members.len());
    while i < j {
        if before(&members[i]) {
            i += 1;
        } else {
            j -= 1;
            members.swap(i, j);
        }
    }
    // Points that coincide up to rounding may all fall on one side.
    if i == 0 || i == members.len() { members.len() / 2 } else { i }
}

/// A table of `count` entries, not fewer than there are groups nor more than points, along a Hilbert curve by group; and the
/// entry of the cluster of each point.
pub(super) fn seed(points: &Points, count: usize) -> (Entries, Vec<u32>) {
    let mut work: Vec<Weighted> = (0..points.len()).map(|i| (points.at(i), points.weight[i], i as u32)).collect();
    let mut clusters: BinaryHeap<_> = (points.groups.iter().enumerate())
        .map(|(group, g)| Cluster::of(&work, group, g.points.start, g.points.end))
        .collect();
    while clusters.len() < count {
        let Some(Cluster { group, first, last, mean, axis, .. }) = clusters.pop() else { break };
        let middle = first + part(&mut work[first..last], mean, axis);
        clusters.push(Cluster::of(&work, group, first, middle));
        clusters.push(Cluster::of(&work, group, middle, last));
    }
    let center = |c: &Cluster| unit(c.mean).unwrap_or(work[c.first].0);
    let mut seeds: Vec<_> =
        clusters.into_iter().map(|c| (c.group, hilbert(center(&c)), c.first, center(&c), c.last)).collect();
    seeds.sort_unstable_by_key(|&(group, code, first, ..)| (group, code, first));
    let (mut groups, mut owners) = (vec![Vec::new(); points.groups.len()], vec![0; points.len()]);
    for (entry, (group, _, first, center, last)) in (0..).zip(seeds) {
        groups[group].push(center);
        work[first..last].iter().for_each(|&(.., i)| owners[i as usize] = entry);
    }
    (Entries::from_groups(groups), owners)
}

#[cfg(test)]
mod tests {
    use super::super::testing::scattered;
    use super::*;

    #[test]
    fn seeds_are_as_many_as_asked() {
        let points = scattered(500, 4);
        for count in [4, 5, 77, 500] {
            let (entries, owners) = seed(&points, count);
            assert!((0..count as u32).all(|e| owners.contains(&e)));
            assert_eq!(entries.len(), count);
            assert!(entries.spans.iter().all(|s| !s.is_empty()));
        }
    }

    #[test]
    fn two_clusters_get_an_entry_each() {
        let near = |t: f32| [0.001 * t, 0.002 * t * t, 1.0];
        let far = |t: f32| [1.0, 0.001 * t, 0.0];
        let points = (-5..5).map(|t| (far(t as f32), 1.0)).chain((-5..5).map(|t| (near(t as f32), 1.0))).collect();
        let mut entries = seed(&Points::new([(0, points)]), 2).0.directions;
        entries.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert!(entries[0][2] > 0.999 && entries[1][0] > 0.999);
    }
}
