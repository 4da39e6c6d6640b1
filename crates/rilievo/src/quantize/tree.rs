//! A quadtree over points in Morton order: every node has a bounding ball and the moments of what is in it.

use super::points::Points;
use crate::order::{greater, lesser};

/// A node; its points follow each other. A node's children follow it, each with its own descendants.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// First point.
    pub first: u32,
    /// One past the last point.
    pub last: u32,
    /// One past the last descendant; the node after this one is its first child, if it is not this end.
    pub end: u32,
    /// Centre of the bounding ball.
    pub center: [f32; 3],
    /// Radius of the bounding ball, within a few ulps: see [`SLACK`].
    pub radius: f32,
    /// Sum of weight × point, and of weight.
    pub moment: [f64; 4],
}

/// Points of a leaf. Smaller leaves need fewer distances, larger ones fewer nodes.
pub(super) const LEAF: usize = 32;

/// Relative error that f32 distances and radii stay well below (some 40 roundings of 6·10⁻⁸ in the deepest tree).
pub(super) const SLACK: f32 = 1e-5;

/// A forest: one quadtree per group of the points.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    /// The root of each group.
    pub roots: Vec<u32>,
}

type Bounds = ([f32; 3], [f32; 3]);

/// Squared distance of two points.
pub(super) fn squared(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

impl Tree {
    /// Builds the trees; nodes of at most `leaf` points are not divided.
    pub(super) fn build(points: &Points, leaf: usize) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(points.len() / leaf * 3 + 16), roots: Vec::new() };
        for group in &points.groups {
            tree.roots.push(tree.nodes.len() as u32);
            tree.grow(points, leaf, group.points.start, group.points.end);
        }
        tree
    }

    /// The children of a node, in order; none if it is a leaf.
    pub(super) fn children(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let end = self.nodes[node as usize].end;
        let from = move |child: u32| (child < end).then_some(child);
        std::iter::successors(from(node + 1), move |&child| from(self.nodes[child as usize].end))
    }

    /// Adds the tree of some points; returns the box around them.
    fn grow(&mut self, points: &Points, leaf: usize, first: usize, last: usize) -> Bounds {
        let me = self.nodes.len();
        let (ends, center) = ((first as u32, last as u32), [0.0; 3]);
        self.nodes.push(Node { first: ends.0, last: ends.1, end: 0, center, radius: 0.0, moment: [0.0; 4] });
        let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
        let mut enclose = |l: [f32; 3], h: [f32; 3]| {
            for axis in 0..3 {
                low[axis] = lesser(l[axis], low[axis]);
                high[axis] = greater(h[axis], high[axis]);
            }
        };
        if last - first <= leaf {
            (first..last).for_each(|i| enclose(points.at(i), points.at(i)));
        } else {
            let mut start = first;
            while start < last {
                let end = split(&points.codes, first, start, last);
                let (l, h) = self.grow(points, leaf, start, end);
                enclose(l, h);
                start = end;
            }
        }
        let center = [0, 1, 2].map(|axis| (low[axis] + high[axis]) * 0.5);
        let (mut moment, mut radius) = ([0.0; 4], half_diagonal(center, low, high));
        if last - first <= leaf {
            let mut farthest = 0.0f32;
            for i in first..last {
                let weight = f64::from(points.weight[i]);
                let p = points.at(i);
                farthest = greater(squared(center, p), farthest);
                moment = add(moment, [p[0], p[1], p[2], 1.0].map(|c| f64::from(c) * weight));
            }
            radius = farthest.sqrt();
        } else {
            let mut farthest = 0.0f32;
            self.nodes[me].end = self.nodes.len() as u32;
            for child in self.children(me as u32) {
                let child = &self.nodes[child as usize];
                farthest = farthest.max(squared(center, child.center).sqrt() + child.radius);
                moment = add(moment, child.moment);
            }
            radius = radius.min(farthest);
        }
        let end = self.nodes.len() as u32;
        let node = &mut self.nodes[me];
        (node.end, node.center, node.radius, node.moment) = (end, center, radius, moment);
        (low, high)
    }
}

/// Distance from `center` to the farthest corner of a box. Not simply to `high`: the centre of a tiny box is rounded.
fn half_diagonal(center: [f32; 3], low: [f32; 3], high: [f32; 3]) -> f32 {
    let farther = [0, 1, 2].map(|k| (high[k] - center[k]).max(center[k] - low[k]));
    squared(farther, [0.0; 3]).sqrt()
}

/// Sum of two moments.
pub(super) fn add(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

/// Where the child that begins at point `start` ends, in the node `first..last`.
fn split(codes: &[u64], first: usize, start: usize, last: usize) -> usize {
    let different = codes[first] ^ codes[last - 1];
    if different == 0 {
        // Too close together for the code. Such points are ordered by their coordinates, so halves are still slabs.
        let middle = first + (last - first) / 2;
        return if start < middle { middle } else { last };
    }
    // The highest digit that differs: levels where the node would have a single child are passed over.
    let shift = (63 - different.leading_zeros()) & !1;
    let digit = codes[start] >> shift;
    let (mut low, mut high) = (start + 1, last);
    while low < high {
        let middle = low + (high - low) / 2;
        if codes[middle] >> shift == digit { low = middle + 1 } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::super::testing::scattered;
    use super::*;

    #[test]
    fn every_node_encloses_its_points_and_its_children_part_it() {
        for (count, leaf) in [(1, 4), (5, 4), (3000, 8), (3000, 1)] {
            let points = scattered(count, 3);
            let tree = Tree::build(&points, leaf);
            for (index, node) in tree.nodes.iter().enumerate() {
                let mut weight = 0.0;
                for i in node.first..node.last {
                    let distance = squared(points.at(i as usize), node.center).sqrt();
                    assert!(distance <= node.radius * (1.0 + SLACK), "{distance} {}", node.radius);
                    weight += f64::from(points.weight[i as usize]);
                }
                assert_eq!(node.moment[3], weight);
                let mut next = node.first;
                for child in tree.children(index as u32) {
                    let child = &tree.nodes[child as usize];
                    assert_eq!(child.first, next);
                    next = child.last;
                }
                let leafy = node.end == index as u32 + 1;
                assert!(if leafy { next == node.first } else { next == node.last });
                assert!(!leafy || (node.last - node.first) as usize <= leaf);
            }
        }
    }
}
