//! Which entry is nearest to a single direction.

use super::candidates::Candidates;
use super::entries::{Entries, squared_f64};
use super::octahedral::morton;
use super::points::Points;
use super::tree::{SLACK, Tree};
use crate::order::greater;

/// Entries of a quadtree leaf: a few, as each visit costs as much as looking at some entries.
const LEAF: usize = 6;

/// The entries of each group, sorted for searching.
#[derive(Debug)]
pub(super) struct Nearest {
    candidates: Candidates,
    points: Points,
    /// The table index of each point.
    ids: Vec<u32>,
    /// For what lies far from all entries, and for what is not to find itself.
    tree: Tree,
}

/// A search under way.
struct Query {
    direction: [f64; 3],
    /// This entry does not count.
    except: u32,
    distance: f64,
    entry: u32,
}

const NONE: u32 = u32::MAX;

impl Nearest {
    /// Sorts entries for searching. Every group must have some.
    pub(super) fn new(entries: &Entries) -> Self {
        let mut ids = Vec::with_capacity(entries.len());
        for span in &entries.spans {
            let mut order: Vec<u32> = span.clone().map(|id| id as u32).collect();
            order.sort_by_cached_key(|&id| (morton(entries.directions[id as usize]), id));
            ids.extend(order);
        }
        let group = |span: &std::ops::Range<usize>| {
            (0, ids[span.clone()].iter().map(|&id| (entries.directions[id as usize], 1.0)).collect())
        };
        let points = Points::new(entries.spans.iter().map(group));
        let tree = Tree::build(&points, LEAF);
        Self { candidates: Candidates::new(entries), points, ids, tree }
    }

    /// The entry of `group` nearest to `direction`, a unit vector, by [`squared_f64`]; of equals, the lowest.
    pub(super) fn find(&self, group: usize, direction: [f64; 3]) -> u32 {
        let Some(candidates) = self.candidates.of(group, direction) else { return self.search(group, direction) };
        let (mut nearest, mut found) = (f64::INFINITY, candidates[0].entry);
        for candidate in candidates {
            let distance = squared_f64(direction, candidate.direction);
            if distance < nearest {
                (nearest, found) = (distance, candidate.entry);
            }
        }
        found
    }

    /// The same for any direction, without lists.
    fn search(&self, group: usize, direction: [f64; 3]) -> u32 {
        let first = self.points.groups[group].points.start;
        let distance = squared_f64(direction, self.points.at(first));
        let mut query = Query { direction, except: NONE, distance, entry: self.ids[first] };
        self.visit(self.tree.roots[group], &mut query);
        query.entry
    }

    /// The entry of `group` nearest to its entry `own`, and its squared distance; `None` if `own` is the only one.
    pub(super) fn neighbour(&self, group: usize, own: u32, direction: [f32; 3]) -> Option<(u32, f64)> {
        let direction = direction.map(f64::from);
        let mut query = Query { direction, except: own, distance: f64::INFINITY, entry: NONE };
        self.visit(self.tree.roots[group], &mut query);
        (query.entry != NONE).then_some((query.entry, query.distance))
    }

    fn visit(&self, node: u32, query: &mut Query) {
        let n = &self.tree.nodes[node as usize];
        if n.end == node + 1 {
            for i in n.first as usize..n.last as usize {
                let (id, distance) = (self.ids[i], squared_f64(query.direction, self.points.at(i)));
                let closer = distance < query.distance || (distance == query.distance && id < query.entry);
                if closer && id != query.except {
                    (query.distance, query.entry) = (distance, id);
                }
            }
            return;
        }
        // The child that is nearest first: it makes the others superfluous.
        let mut order = [(f64::INFINITY, NONE); 4];
        for (slot, child) in order.iter_mut().zip(self.tree.children(node)) {
            let c = &self.tree.nodes[child as usize];
            let gap = squared_f64(query.direction, c.center).sqrt() - f64::from(c.radius) * f64::from(1.0 + SLACK);
            *slot = (greater(gap, 0.0), child);
        }
        // A network of five.
        for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if order[j].0 < order[i].0 {
                order.swap(i, j);
            }
        }
        for (gap, child) in order {
            // Not `>=`: an equally near entry with a lower index may be inside.
            if child == NONE || gap * gap * (1.0 - 1e-9) > query.distance {
                break;
            }
            self.visit(child, query);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::entries::unit;
    use super::super::octahedral;
    use super::super::testing::{brute_force, scattered};
    use super::*;

    #[test]
    fn find_agrees_with_brute_force_and_so_does_search() {
        for count in [2, 30, 3000] {
            let points = scattered(count, 2);
            let group = |g: usize| points.groups[g].points.clone().map(|i| points.at(i)).collect::<Vec<_>>();
            let mut entries = Entries::from_groups([group(0), group(1)]);
            let twin = entries.spans[1].end - 1;
            entries.directions[twin] = entries.directions[entries.spans[1].start];
            let nearest = Nearest::new(&entries);
            let queries = scattered(2000, 1);
            for i in 0..queries.len() {
                let (q, g) = (queries.at(i), i % 2);
                let span = entries.spans[g].clone();
                let expected = (span.start + brute_force(q, &entries.directions[span.clone()])) as u32;
                let wide = q.map(f64::from);
                assert_eq!(nearest.find(g, wide), expected);
                assert_eq!(nearest.search(g, wide), expected);
            }
        }
    }

    /// On the borders of cells and between entries: where a list could lack one.
    #[test]
    fn lists_have_whatever_may_be_nearest() {
        let ring = |i: usize| (std::f32::consts::TAU * i as f32 / 600.0).sin_cos();
        let ring: Vec<[f32; 3]> = (0..600).map(ring).map(|(s, c)| unit([s, c, 0.7].map(f64::from)).unwrap()).collect();
        let scattered = scattered(700, 1);
        let mut all: Vec<[f32; 3]> = (0..scattered.len()).map(|i| scattered.at(i)).collect();
        all.extend([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
        for directions in [ring, all] {
            let entries = Entries::from_groups([directions.clone()]);
            let nearest = Nearest::new(&entries);
            let mut lists = 0;
            let mut check = |q: [f32; 3]| {
                let wide = q.map(f64::from);
                assert_eq!(nearest.find(0, wide), brute_force(q, &directions) as u32, "{q:?}");
                lists += usize::from(nearest.candidates.of(0, wide).is_some());
            };
            let side = 64;
            for (u, v) in (0..=side).flat_map(|u| (0..=side).map(move |v| (u, v))) {
                check(octahedral::direction([u, v].map(|c| f64::from(c) / f64::from(side))).map(|c| c as f32));
            }
            for pair in directions.windows(2) {
                let middle = [0, 1, 2].map(|k| f64::from(pair[0][k]) + f64::from(pair[1][k]));
                unit(middle).into_iter().for_each(&mut check);
            }
            assert!(lists >= directions.len() - 1, "where entries are, there are lists: {lists}");
        }
    }

    #[test]
    fn neighbour_is_never_itself() {
        let z = [0.0, 0.0, 1.0];
        let nearest = Nearest::new(&Entries::from_groups([vec![z], vec![z, z, [1.0, 0.0, 0.0]]]));
        assert_eq!(nearest.neighbour(0, 0, z), None);
        assert_eq!(nearest.neighbour(1, 1, z), Some((2, 0.0)));
        assert_eq!(nearest.neighbour(1, 3, [1.0, 0.0, 0.0]), Some((1, 2.0)));
    }
}
