//! Which entry is nearest to each point.
//!
//! Filtering down the quadtree (after Kanungo et al. 2002, "An efficient k-means clustering algorithm"): a node keeps
//! the candidates that may be nearest to something inside its ball. Mostly one is left long before the leaves, and the
//! whole node is done at once. No point's answer is approximate: see [`Assigner::assign_exact`].

use super::entries::{Entries, squared_f64};
use super::points::{LANES, Points};
use super::tree::{SLACK, Tree, add, squared};
use crate::par;

/// Absolute slack where squares underflow; no two different unit vectors of f32 that matter are so close.
const TINY: f32 = 1e-15;
/// Into how many tasks of equal size work is cut, about. Fixed, so that sums are the same for any thread count.
const TASKS: usize = 16;
/// A task is not cut below so many points.
const SMALL_TASK: usize = 2048;

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
    /// Node and group; together they hold every point once, in order.
    tasks: Vec<(u32, usize)>,
}

impl<'a> Assigner<'a> {
    pub(super) fn new(points: &'a Points, tree: &'a Tree) -> Self {
        let small = SMALL_TASK.max(points.len() / TASKS);
        let mut tasks = Vec::new();
        for (group, &root) in tree.roots.iter().enumerate() {
            let mut open = vec![root];
            while let Some(node) = open.pop() {
                let n = &tree.nodes[node as usize];
                if (n.last - n.first) as usize > small && n.end > node + 1 {
                    let at = open.len();
                    open.extend(tree.children(node));
                    open[at..].reverse();
                } else {
                    tasks.push((node, group));
                }
            }
        }
        Self { points, tree, tasks }
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
        let done = par::map_range(self.tasks.len(), |task| {
            let (node, group) = self.tasks[task];
            let mut search = Search::<EXACT>::new(self.points, self.tree, entries, node, group);
            search.visit(node, 0..search.ids.len());
            (search.ids, search.sums, search.owners)
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
}

/// One task's work. Candidates are numbered within the task, so that what the inner loops touch lies together.
struct Search<'a, const EXACT: bool> {
    points: &'a Points,
    tree: &'a Tree,
    /// The candidates of this task: table index (rising) and direction.
    ids: Vec<u32>,
    directions: Vec<[f32; 3]>,
    sums: Vec<[f64; 4]>,
    /// Entry of each point of the task's node.
    owners: Vec<u32>,
    /// The first of these points.
    first: u32,
    /// Candidates of all nodes on the way down, each node's after its parent's.
    stack: Vec<u32>,
    distances: Vec<f32>,
}

impl<'a, const EXACT: bool> Search<'a, EXACT> {
    fn new(points: &'a Points, tree: &'a Tree, entries: &Entries, node: u32, group: usize) -> Self {
        let n = &tree.nodes[node as usize];
        let span = entries.spans[group].clone();
        let distances: Vec<f32> = entries.directions[span.clone()].iter().map(|&e| squared(e, n.center)).collect();
        let reach = reach(distances.iter().fold(f32::MAX, |a, &b| a.min(b)), n.radius);
        let near = || span.clone().zip(&distances).filter(|&(_, &d)| d <= reach).map(|(id, _)| id);
        let ids: Vec<u32> = near().map(|id| id as u32).collect();
        Self {
            points,
            tree,
            directions: near().map(|id| entries.directions[id]).collect(),
            sums: vec![[0.0; 4]; ids.len()],
            owners: vec![0; (n.last - n.first) as usize],
            first: n.first,
            stack: (0..ids.len() as u32).collect(),
            ids,
            distances,
        }
    }

    /// Assigns the points of `node`, whose parent's candidates are at `parent` on the stack.
    fn visit(&mut self, node: u32, parent: std::ops::Range<usize>) {
        let n = &self.tree.nodes[node as usize];
        let kept = self.stack.len();
        self.filter(n.center, n.radius, parent);
        let candidates = kept..self.stack.len();
        if candidates.len() == 1 {
            let only = self.stack[kept] as usize;
            self.sums[only] = add(self.sums[only], n.moment);
            self.owners[(n.first - self.first) as usize..(n.last - self.first) as usize].fill(self.ids[only]);
        } else if n.end == node + 1 {
            for first in (n.first..n.last).step_by(LANES) {
                self.scan(first as usize, (n.last - first).min(LANES as u32) as usize, candidates.clone());
            }
        } else {
            for child in self.tree.children(node) {
                self.visit(child, candidates.clone());
            }
        }
        self.stack.truncate(kept);
    }

    /// Pushes those of the parent's candidates that may be nearest to a point of the ball.
    fn filter(&mut self, center: [f32; 3], radius: f32, parent: std::ops::Range<usize>) {
        // Distances first, in a loop without branches; this function is where most of the time goes.
        let Self { stack, directions, distances, .. } = self;
        distances.clear();
        distances.extend(stack[parent.clone()].iter().map(|&c| squared(directions[c as usize], center)));
        let nearest = distances.iter().fold(f32::MAX, |a, &d| if d < a { d } else { a });
        let Some(best) = distances.iter().position(|&d| d == nearest) else { return };
        let best = directions[stack[parent.start + best] as usize];
        let reach = reach(nearest, radius);
        let diameter = 4.0 * radius * radius * (1.0 + SLACK);
        for (k, &d) in distances.iter().enumerate() {
            if d > reach {
                continue;
            }
            let c = stack[parent.start + k];
            // The whole ball lies on the best one's side of the plane between the two.
            let ahead = d - nearest - d * SLACK;
            let beaten = ahead > TINY && ahead * ahead > diameter * squared(directions[c as usize], best);
            if !beaten {
                stack.push(c);
            }
        }
    }

    /// Assigns `count` ≤ [`LANES`] points from `first` to the nearest of the candidates.
    fn scan(&mut self, first: usize, count: usize, candidates: std::ops::Range<usize>) {
        let lanes = |v: &[f32]| -> [f32; LANES] { std::array::from_fn(|l| v[first..first + LANES][l]) };
        let (x, y, z) = (lanes(&self.points.x), lanes(&self.points.y), lanes(&self.points.z));
        let (mut nearest, mut second, mut who) = ([f32::MAX; LANES], [f32::MAX; LANES], [0u32; LANES]);
        for &c in &self.stack[candidates.clone()] {
            let [cx, cy, cz] = self.directions[c as usize];
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
    fn decide(&self, point: [f32; 3], candidates: std::ops::Range<usize>) -> u32 {
        let (mut nearest, mut who) = (f64::INFINITY, 0);
        for &c in &self.stack[candidates] {
            let d = squared_f64(point.map(f64::from), self.directions[c as usize]);
            if d < nearest {
                (nearest, who) = (d, c);
            }
        }
        who
    }
}

/// The squared distance from a ball's centre beyond which nothing is nearest to any of its points, if the candidate
/// nearest to the centre is at the squared distance `nearest`.
fn reach(nearest: f32, radius: f32) -> f32 {
    let reach = (nearest.sqrt() + 2.0 * radius) * (1.0 + SLACK) + TINY;
    reach * reach
}

#[cfg(test)]
mod tests {
    use super::super::seed::seed;
    use super::super::testing::{brute_force, scattered};
    use super::*;

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
