//! Which entry is nearest to each point.
//!
//! Filtering down the quadtree (after Kanungo et al. 2002, "An efficient k-means clustering algorithm"): a node keeps
//! the candidates that may be nearest to something inside its ball. Mostly one is left long before the leaves, and the
//! whole node is done at once. Near the root, where candidates are many, they are balls around several entries each
//! ([`Blocks`]). No point's answer is approximate: see [`Assigner::assign_exact`].
//!
//! The loops work on [`LANES`] values side by side and are compiled once for every instruction set, chosen at run time.
//! None of them fuses or reorders an operation, so the set is not in the result.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use super::blocks::Blocks;
use super::candidates::{Candidates, TINY};
use super::entries::{Entries, squared_f64};
use super::points::{LANES, Points};
use super::tree::{SLACK, Tree, add};
use crate::par;

/// Into how many tasks work is cut at least, about. Fixed, so that sums are the same for any thread count.
const TASKS: usize = 16;
/// A task should be as many points as belong to so many entries ...
const TASK_ENTRIES: usize = 64;
/// ... but not be cut below so many points.
const SMALL_TASK: usize = 1024;

/// The outcome for all points.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Assignment {
    /// For each entry the sum of weight × point and of weight over its points.
    pub sums: Vec<[f64; 4]>,
    /// The entry of each point.
    pub owners: Vec<u32>,
}

/// Assigns the points of a tree to tables, again and again.
#[derive(Debug)]
pub(super) struct Assigner<'a> {
    points: &'a Points,
    tree: &'a Tree,
    level: Level,
}

/// A node whose points are assigned by themselves.
struct Task {
    node: u32,
    group: usize,
    /// The blocks of entries that may matter to it.
    blocks: Vec<u32>,
}

impl<'a> Assigner<'a> {
    pub(super) fn new(points: &'a Points, tree: &'a Tree) -> Self {
        Self { points, tree, level: Level::new() }
    }

    /// Nearest in f32 arithmetic: all that shaping a table needs.
    pub(super) fn assign(&self, entries: &Entries) -> Assignment {
        self.run::<false>(entries)
    }

    /// Nearest by the distance of [`squared_f64`]; of equals, the entry with the lowest index.
    pub(super) fn assign_exact(&self, entries: &Entries) -> Assignment {
        self.run::<true>(entries)
    }

    fn run<const EXACT: bool>(&self, entries: &Entries) -> Assignment {
        let groups: Vec<Blocks> =
            entries.spans.iter().map(|span| Blocks::new(&entries.directions, span.clone())).collect();
        let most = SMALL_TASK.max(self.points.len() / TASKS);
        let small = (TASK_ENTRIES * self.points.len() / entries.len().max(1)).clamp(SMALL_TASK, most);
        let mut tasks = Vec::new();
        for (group, blocks) in groups.iter().enumerate() {
            self.cut(self.tree.roots[group], group, blocks, &blocks.all(), small, &mut tasks);
        }
        let done = par::map_range(tasks.len(), |task| {
            let task = &tasks[task];
            dispatch!(self.level, simd => {
                let candidates = groups[task.group].candidates(&task.blocks);
                let mut search = Search::<EXACT>::new(simd, self.points, self.tree, candidates, task.node);
                search.descend(simd, task.node);
                (search.ids, search.sums, search.owners)
            })
        });
        let mut all = Assignment { sums: vec![[0.0; 4]; entries.len()], owners: Vec::with_capacity(self.points.len()) };
        for (ids, sums, owners) in done {
            for (&id, sum) in ids.iter().zip(sums) {
                let total = &mut all.sums[id as usize];
                *total = add(*total, sum);
            }
            all.owners.extend(owners);
        }
        all
    }

    /// Cuts a node into tasks of at most `small` points, in order. `list` are the blocks that matter to its parent.
    fn cut(&self, node: u32, group: usize, blocks: &Blocks, list: &[u32], small: usize, tasks: &mut Vec<Task>) {
        let n = &self.tree.nodes[node as usize];
        let near = blocks.near(list, n.center, n.radius);
        if (n.last - n.first) as usize <= small || n.end == node + 1 {
            tasks.push(Task { node, group, blocks: near });
        } else {
            self.tree.children(node).for_each(|child| self.cut(child, group, blocks, &near, small, tasks));
        }
    }
}

/// One task's work. Candidates are numbered within the task, so that what the inner loops touch lies together.
struct Search<'a, const EXACT: bool> {
    points: &'a Points,
    tree: &'a Tree,
    /// The candidates of this task, by table index (rising).
    ids: Vec<u32>,
    sums: Vec<[f64; 4]>,
    /// Entry of each point of the task's node.
    owners: Vec<u32>,
    /// The first of these points.
    first: u32,
    /// Candidates of all nodes on the way down, each node's after its parent's.
    stack: Candidates,
}

impl<'a, const EXACT: bool> Search<'a, EXACT> {
    /// `stack` has one list: the entries to choose from, numbered as in the table.
    #[inline(always)]
    fn new<S: Simd>(_simd: S, points: &'a Points, tree: &'a Tree, mut stack: Candidates, node: u32) -> Self {
        let n = &tree.nodes[node as usize];
        let near = stack.filter(stack.all(), n.center, n.radius);
        let ids: Vec<u32> = stack.iter(near.clone()).map(|(id, _)| id).collect();
        Self {
            points,
            tree,
            sums: vec![[0.0; 4]; ids.len()],
            owners: vec![0; (n.last - n.first) as usize],
            first: n.first,
            stack: Candidates::new(stack.iter(near).map(|(_, direction)| direction).zip(0..)),
            ids,
        }
    }

    /// Assigns all points of `root`. A loop and not a recursion, so that all of it is compiled for the level at hand.
    #[inline(always)]
    fn descend<S: Simd>(&mut self, _simd: S, root: u32) {
        // Nodes whose turn will come, with where their parents' candidates lie.
        let mut open = vec![(root, self.stack.all())];
        while let Some((node, parent)) = open.pop() {
            let n = &self.tree.nodes[node as usize];
            let candidates = self.stack.filter(parent, n.center, n.radius);
            if candidates.len() == 1 {
                let only = self.stack.id(candidates.start) as usize;
                self.sums[only] = add(self.sums[only], n.moment);
                self.owners[(n.first - self.first) as usize..(n.last - self.first) as usize].fill(self.ids[only]);
            } else if n.end == node + 1 {
                for first in (n.first..n.last).step_by(LANES) {
                    self.scan(first as usize, (n.last - first).min(LANES as u32) as usize, candidates.clone());
                }
            } else {
                let at = open.len();
                open.extend(self.tree.children(node).map(|child| (child, candidates.clone())));
                // The sums are in the order of the points.
                open[at..].reverse();
            }
        }
    }

    /// Assigns `count` ≤ [`LANES`] points from `first` to the nearest of the candidates.
    #[inline(always)]
    fn scan(&mut self, first: usize, count: usize, candidates: Range<usize>) {
        let lanes = |v: &[f32]| -> [f32; LANES] {
            v[first..first + LANES].try_into().expect("invariant: the arrays are padded by LANES")
        };
        let (x, y, z) = (lanes(&self.points.x), lanes(&self.points.y), lanes(&self.points.z));
        let (mut nearest, mut second, mut who) = ([f32::MAX; LANES], [f32::MAX; LANES], [0u32; LANES]);
        for (c, [cx, cy, cz]) in self.stack.iter(candidates.clone()) {
            for l in 0..LANES {
                let (dx, dy, dz) = (x[l] - cx, y[l] - cy, z[l] - cz);
                let d = dx * dx + dy * dy + dz * dz;
                let closer = d < nearest[l];
                if EXACT {
                    let loser = if closer { nearest[l] } else { d };
                    second[l] = if loser < second[l] { loser } else { second[l] };
                }
                who[l] = if closer { c } else { who[l] };
                nearest[l] = if closer { d } else { nearest[l] };
            }
        }
        for l in 0..count {
            let i = first + l;
            if EXACT && second[l] <= nearest[l] * (1.0 + 4.0 * SLACK) + TINY * TINY {
                who[l] = self.decide(self.points.at(i), candidates.clone());
            }
            let weight = f64::from(self.points.weight[i]);
            let sum = &mut self.sums[who[l] as usize];
            *sum = add(*sum, [x[l], y[l], z[l], 1.0].map(|c| f64::from(c) * weight));
            self.owners[i - self.first as usize] = self.ids[who[l] as usize];
        }
    }

    /// The nearest by [`squared_f64`], where f32 cannot tell.
    fn decide(&self, point: [f32; 3], candidates: Range<usize>) -> u32 {
        let (mut nearest, mut who) = (f64::INFINITY, 0);
        for (c, direction) in self.stack.iter(candidates) {
            let d = squared_f64(point.map(f64::from), direction);
            if d < nearest {
                (nearest, who) = (d, c);
            }
        }
        who
    }
}

#[cfg(test)]
mod tests {
    use super::super::seed::seed;
    use super::super::testing::{brute_force, scattered};
    use super::*;

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let points = scattered(20_000, 2);
        let tree = Tree::build(&points, 16);
        let entries = seed(&points, 300);
        let best = Assigner::new(&points, &tree);
        let plain = Assigner { level: Level::baseline(), ..Assigner::new(&points, &tree) };
        assert_eq!(best.assign(&entries), plain.assign(&entries));
        assert_eq!(best.assign_exact(&entries), plain.assign_exact(&entries));
    }

    #[test]
    fn exact_assignment_agrees_with_brute_force() {
        for (count, groups, entries) in [(1, 1, 1), (40, 3, 5), (5000, 1, 300), (20_000, 2, 64)] {
            let points = scattered(count, groups);
            let tree = Tree::build(&points, 16);
            let mut entries = seed(&points, entries);
            // Duplicates: the lower index must win.
            let span = entries.spans[0].clone();
            entries.directions[span.end - 1] = entries.directions[span.start];
            let found = Assigner::new(&points, &tree).assign_exact(&entries);
            let mut weight = 0.0;
            for (group, g) in points.groups.iter().enumerate() {
                for i in g.points.clone() {
                    let span = entries.spans[group].clone();
                    let expected = span.start + brute_force(points.at(i), &entries.directions[span]);
                    assert_eq!(found.owners[i] as usize, expected);
                    weight += f64::from(points.weight[i]);
                }
            }
            assert!((found.sums.iter().map(|s| s[3]).sum::<f64>() - weight).abs() < 1e-6);
        }
    }
}
