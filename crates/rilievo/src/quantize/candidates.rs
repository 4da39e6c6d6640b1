//! Which entries may be nearest to a direction, by where it lies on the sphere.
//!
//! A quadtree over the octahedral square. Let a cell lie in a ball of radius r about c, and let the entry nearest to c be
//! at distance d: then whatever is nearest to a direction in the cell lies within d + 2r of c (the triangle inequality,
//! twice). Cells are divided until that is a handful of entries, so a search is a walk to a leaf and a few distances, and
//! its answer is not approximate. A cell that lies far from all entries for its size is left to a search of another kind:
//! dividing it may help little (at the centre of a ring all are equally near) and costs as much as any other.

use super::entries::{Entries, normalized, squared_f64};
use super::octahedral::{MORTON_BITS, direction, morton};

/// Entries of a list at most.
const MOST: usize = 12;
/// Cells farther from all entries than so many of their radii are not divided.
const FAR: f64 = 4.0;
/// Cells of the first levels reach around the sphere, and no ball says much about them.
const LARGE: u32 = 2;
/// How much larger balls are taken than they are: more than directions differ from unit vectors, and than rounding them
/// to f32 can move them over the border of a cell.
const SLACK: f64 = 1e-5;

/// The lists of a table.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    nodes: Vec<Node>,
    /// The root of each group.
    roots: Vec<u32>,
    /// All lists, one after the other, each in rising order of entries.
    listed: Vec<Candidate>,
}

/// An entry that may be nearest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub direction: [f32; 3],
    pub entry: u32,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// Divided in four, from this node on, in Morton order.
    Parts(u32),
    /// A part of the lists.
    List(u32, u32),
    /// Too many to list.
    Crowd,
}

/// A cell of the octahedral square.
#[derive(Debug, Clone, Copy)]
struct Cell {
    level: u32,
    at: [u32; 2],
}

impl Candidates {
    pub(super) fn new(entries: &Entries) -> Self {
        let mut all = Self::default();
        for span in &entries.spans {
            let root = all.nodes.len();
            all.roots.push(root as u32);
            all.nodes.push(Node::Crowd);
            let group: Vec<u32> = span.clone().map(|entry| entry as u32).collect();
            all.grow(entries, root, Cell { level: 0, at: [0; 2] }, &group);
        }
        all
    }

    /// All entries of a group that may be nearest to a unit vector; `None` where too many are about equally near.
    pub(super) fn of(&self, group: usize, direction: [f64; 3]) -> Option<&[Candidate]> {
        let code = morton(direction.map(|c| c as f32));
        let (mut node, mut shift) = (self.roots[group], 2 * MORTON_BITS);
        loop {
            match self.nodes[node as usize] {
                Node::Parts(first) => {
                    shift -= 2;
                    node = first + (code >> shift & 3) as u32;
                }
                Node::List(first, last) => return Some(&self.listed[first as usize..last as usize]),
                Node::Crowd => return None,
            }
        }
    }

    /// Makes a node of a cell, whose candidates are among those `around`.
    fn grow(&mut self, entries: &Entries, node: usize, cell: Cell, around: &[u32]) {
        let (near, is_far) = cell.near(entries, around);
        self.nodes[node] = if near.len() <= MOST {
            let first = self.listed.len() as u32;
            let candidate = |&entry: &u32| Candidate { direction: entries.directions[entry as usize], entry };
            self.listed.extend(near.iter().map(candidate));
            Node::List(first, self.listed.len() as u32)
        } else if is_far || cell.level == MORTON_BITS {
            Node::Crowd
        } else {
            let first = self.nodes.len();
            self.nodes.extend([Node::Crowd; 4]);
            for (part, cell) in (first..).zip(cell.parts()) {
                self.grow(entries, part, cell, &near);
            }
            Node::Parts(first as u32)
        };
    }
}

impl Cell {
    /// Its quarters, in Morton order.
    fn parts(self) -> [Self; 4] {
        let [u, v] = self.at;
        [0, 1, 2, 3].map(|q| Self { level: self.level + 1, at: [2 * u + (q & 1), 2 * v + (q >> 1)] })
    }

    /// A ball around it: its centre, a unit vector, and its radius.
    fn ball(self) -> ([f64; 3], f64) {
        let side = f64::from(1u32 << self.level);
        let corner =
            |q: u32| direction([(self.at[0] + (q & 1)).into(), (self.at[1] + (q >> 1)).into()].map(|c: f64| c / side));
        let corners = [0, 1, 2, 3].map(corner);
        let center = normalized([0, 1, 2].map(|k| corners.iter().map(|c| c[k]).sum()));
        // A cell is one or two polygons of great circles: the cap that holds their corners holds them.
        let farthest = corners.iter().map(|&c| squared_f64(center, c.map(|c| c as f32))).fold(0.0, f64::max);
        (center, farthest.sqrt() + SLACK)
    }

    /// Those of some entries that may be nearest to something in it, and whether all are far away.
    fn near(self, entries: &Entries, around: &[u32]) -> (Vec<u32>, bool) {
        if self.level < LARGE {
            return (around.to_vec(), false);
        }
        let (center, radius) = self.ball();
        let distance = |&entry: &u32| squared_f64(center, entries.directions[entry as usize]);
        let distances: Vec<f64> = around.iter().map(distance).collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min).sqrt();
        let reach = least + 2.0 * radius;
        let near = around.iter().zip(distances).filter(|&(_, distance)| distance <= reach * reach);
        (near.map(|(&entry, _)| entry).collect(), least > FAR * radius)
    }
}
