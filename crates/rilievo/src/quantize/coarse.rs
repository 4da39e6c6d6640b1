//! Fewer points that stand for many.
//!
//! The sum of squared distances of a set of points to an entry is that of its mean, times its weight, plus a constant.
//! So the nodes of the quadtree, taken as points at their means (which lie inside the sphere), shape the table almost as
//! the points themselves do, at a price that depends on the table only and not on the map.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use super::points::Points;
use super::tree::Tree;

/// A node that may still be divided; the one with the largest spread goes first.
struct Divisible {
    spread: f64,
    node: u32,
    group: usize,
}

impl Ord for Divisible {
    fn cmp(&self, other: &Self) -> Ordering {
        self.spread.total_cmp(&other.spread).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Divisible {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Divisible {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Divisible {}

/// Points that stand for others.
#[derive(Debug)]
pub(super) struct Coarse {
    pub points: Points,
    /// The points that each stands for.
    pub stands_for: Vec<Range<u32>>,
}

/// A point, its weight, and those that it stands for.
type Weighted = ([f32; 3], f32, Range<u32>);

/// At least `count` points (or as many as there are) that stand for all, with balanced spread.
pub(super) fn coarsen(points: &Points, tree: &Tree, count: usize) -> Coarse {
    let divisible = |node: u32, group: usize| {
        let n = &tree.nodes[node as usize];
        Divisible { spread: n.moment[3] * f64::from(n.radius) * f64::from(n.radius), node, group }
    };
    let mut whole: BinaryHeap<_> = tree.roots.iter().enumerate().map(|(group, &root)| divisible(root, group)).collect();
    let mut groups: Vec<Vec<Weighted>> = vec![Vec::new(); tree.roots.len()];
    let mut single = 0;
    while whole.len() + single < count {
        let Some(Divisible { node, group, .. }) = whole.pop() else { break };
        let before = whole.len();
        whole.extend(tree.children(node).map(|child| divisible(child, group)));
        if whole.len() == before {
            let n = &tree.nodes[node as usize];
            groups[group].extend(
                (n.first as usize..n.last as usize).map(|i| (points.at(i), points.weight[i], i as u32..i as u32 + 1)),
            );
            single += (n.last - n.first) as usize;
        }
    }
    for Divisible { node, group, .. } in whole.into_sorted_vec() {
        let n = &tree.nodes[node as usize];
        let [x, y, z, weight] = n.moment;
        groups[group].push(([x, y, z].map(|c| (c / weight) as f32), weight as f32, n.first..n.last));
    }
    for group in &mut groups {
        group.sort_unstable_by_key(|(.., stands_for)| stands_for.start);
    }
    let stands_for = groups.iter().flatten().map(|(.., stands_for)| stands_for.clone()).collect();
    let weighted = |group: Vec<Weighted>| group.into_iter().map(|(mean, weight, _)| (mean, weight)).collect();
    let materials = points.groups.iter().map(|g| g.material);
    Coarse { points: Points::new(materials.zip(groups.into_iter().map(weighted))), stands_for }
}

impl Coarse {
    /// What a value for each coarse point is for each point.
    pub(super) fn refine(&self, coarse: &[u32]) -> Vec<u32> {
        let ranges = self.stands_for.iter().zip(coarse);
        ranges.flat_map(|(range, &value)| std::iter::repeat_n(value, range.len())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::scattered;
    use super::*;

    #[test]
    fn coarse_points_keep_weight_and_mean() {
        let points = scattered(5000, 2);
        let tree = Tree::build(&points, 8);
        for count in [1, 2, 100, 3000, 1_000_000] {
            let Coarse { points: coarse, stands_for } = coarsen(&points, &tree, count);
            let all: Vec<u32> = stands_for.iter().flat_map(Clone::clone).collect();
            assert!(all.iter().copied().eq(0..points.len() as u32));
            assert!(coarse.len() >= count.min(points.len()) && coarse.len() <= points.len());
            for (group, &root) in tree.roots.iter().enumerate() {
                let mut moment = [0.0; 4];
                for i in coarse.groups[group].points.clone() {
                    let [x, y, z] = coarse.at(i);
                    let m = [x, y, z, 1.0].map(|c| f64::from(c) * f64::from(coarse.weight[i]));
                    moment = super::super::tree::add(moment, m);
                }
                let expected = tree.nodes[root as usize].moment;
                assert!((0..4).all(|k| (moment[k] - expected[k]).abs() < 1e-6 * expected[3]));
            }
        }
    }
}
