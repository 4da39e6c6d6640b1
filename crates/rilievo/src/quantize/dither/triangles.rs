//! The entries of a table joined to triangles.

use std::collections::HashMap;

use super::super::entries::{Entries, normalized};
use super::super::nearest::Nearest;
use super::{cross, dot, sub};

const NONE: u32 = u32::MAX;
/// Steps of a walk, or of a search for a corner, after which it is given up. Both end after one to five.
const MOST_STEPS: usize = 64;
/// How far (in radians) an entry must be to the left of an edge to make a triangle with it: the rounding of f32.
const LEFT: f64 = 1e-7;
/// Sine of the largest angle (over 165°) of triangles that are as good as a line.
const SLIM: f64 = 0.25;

/// A Delaunay triangulation of the entries of each group.
///
/// On the sphere it is the convex hull: the circle through the corners of a triangle is empty. The emptiness of a
/// circle is a question to [`Nearest`], so the triangulation grows edge by edge from an entry and its neighbour.
///
/// - **Source:** Maus 1984, "Delaunay triangulation and the convex hull of n points in expected linear time"; with
///   the search for an empty circle left to the quadtree.
#[derive(Debug)]
pub(super) struct Triangles {
    triangles: Vec<Triangle>,
    /// A triangle at each entry, or `NONE`.
    of_entry: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Triangle {
    /// Entries, counter-clockwise seen from outside.
    corners: [u32; 3],
    directions: [[f64; 3]; 3],
    /// The triangle across the edge opposite of each corner, or `NONE`.
    across: [u32; 3],
    is_slim: bool,
}

impl Triangles {
    pub(super) fn new(entries: &Entries, nearest: &Nearest) -> Self {
        let mut all = Self { triangles: Vec::new(), of_entry: vec![NONE; entries.len()] };
        for group in 0..entries.spans.len() {
            Front { entries, nearest, group, edges: HashMap::new() }.grow(&mut all);
        }
        all
    }

    /// The corners of the triangle that holds `normal` and their weights, which sum to one; `None` if no triangle does,
    /// or only one that is as good as a line. `own` is the entry nearest to `normal`: the walk starts there.
    pub(super) fn around(&self, normal: [f64; 3], own: u32) -> Option<[(u32, f64); 3]> {
        let mut at = self.of_entry[own as usize];
        for _ in 0..MOST_STEPS {
            let t = self.triangles.get(at as usize)?;
            let [a, b, c] = t.directions;
            // Volumes with the corners left out in turn: negative if the normal is on the other side of that edge.
            let volumes = [dot(normal, cross(b, c)), dot(normal, cross(c, a)), dot(normal, cross(a, b))];
            if volumes.iter().all(|&v| v >= 0.0) {
                let sum = volumes[0] + volumes[1] + volumes[2];
                return (!t.is_slim && sum > 0.0).then(|| [0, 1, 2].map(|k| (t.corners[k], volumes[k] / sum)));
            }
            let ways = (0..3).filter(|&k| volumes[k] < 0.0 && t.across[k] != NONE);
            at = t.across[ways.min_by(|&i, &j| volumes[i].total_cmp(&volumes[j]))?];
        }
        None
    }
}

/// The triangulation of one group while it grows.
struct Front<'a> {
    entries: &'a Entries,
    nearest: &'a Nearest,
    group: usize,
    /// The triangle to the left of each directed edge, and the corner opposite.
    edges: HashMap<(u32, u32), (u32, usize)>,
}

impl Front<'_> {
    fn direction(&self, entry: u32) -> [f64; 3] {
        normalized(self.entries.directions[entry as usize].map(f64::from))
    }

    fn find(&self, direction: [f64; 3]) -> u32 {
        self.nearest.find(self.group, direction)
    }

    fn grow(&mut self, all: &mut Triangles) {
        let Some((a, b)) = self.first_edge() else { return };
        let first = all.triangles.len();
        let mut open = vec![(a, b), (b, a)];
        while let Some((a, b)) = open.pop() {
            if self.edges.contains_key(&(a, b)) {
                continue;
            }
            let Some(c) = self.apex(a, b) else { continue };
            let sides = [(b, c), (c, a), (a, b)];
            // Four entries on one circle make two triangles in either of two ways: not in both.
            if sides.iter().any(|side| self.edges.contains_key(side)) {
                continue;
            }
            let id = all.triangles.len() as u32;
            for (k, side) in sides.into_iter().enumerate() {
                self.edges.insert(side, (id, k));
                all.of_entry[[a, b, c][k] as usize] = id;
                open.push((side.1, side.0));
            }
            let directions = [a, b, c].map(|e| self.direction(e));
            all.triangles.push(Triangle {
                corners: [a, b, c],
                directions,
                across: [NONE; 3],
                is_slim: is_slim(directions),
            });
        }
        for t in &mut all.triangles[first..] {
            let [a, b, c] = t.corners;
            t.across = [(c, b), (a, c), (b, a)].map(|side| self.edges.get(&side).map_or(NONE, |e| e.0));
        }
    }

    /// An entry and its neighbour: they always share an edge. `None` if all entries of the group are the same.
    fn first_edge(&self) -> Option<(u32, u32)> {
        self.entries.spans[self.group].clone().find_map(|e| {
            let direction = self.entries.directions[e];
            let (other, distance2) = self.nearest.neighbour(self.group, e as u32, direction)?;
            // Of entries that are the same, searches only ever find the first.
            let first = |entry| self.find(self.direction(entry));
            (distance2 > 0.0).then(|| (first(e as u32), first(other)))
        })
    }

    /// The entry to the left of an edge whose circle through the edge is empty.
    ///
    /// Starts with the largest circle, the half of the sphere to the left, and shrinks it to each entry found inside.
    fn apex(&self, a: u32, b: u32) -> Option<u32> {
        let (start, end) = (self.direction(a), self.direction(b));
        let left = cross(start, end);
        let length = dot(left, left).sqrt();
        if length == 0.0 {
            return None;
        }
        let left = left.map(|c| c / length);
        let mut c = self.find(left);
        if dot(left, self.direction(c)) < LEFT {
            return None;
        }
        for _ in 0..MOST_STEPS {
            let center = normalized(cross(sub(end, start), sub(self.direction(c), start)));
            let inside = self.find(center);
            let direction = self.direction(inside);
            let is_closer = dot(center, direction) > dot(center, start) + 1e-12;
            if [a, b, c].contains(&inside) || !is_closer || dot(left, direction) < LEFT {
                break;
            }
            c = inside;
        }
        Some(c)
    }
}

fn is_slim([a, b, c]: [[f64; 3]; 3]) -> bool {
    let mut sides = [sub(b, a), sub(c, b), sub(a, c)].map(|s| dot(s, s));
    sides.sort_unstable_by(f64::total_cmp);
    let doubled_area = cross(sub(b, a), sub(c, a));
    // The largest angle lies between the two shorter sides.
    dot(doubled_area, doubled_area) < SLIM * SLIM * sides[0] * sides[1]
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{brute_force, scattered};
    use super::*;

    fn triangulated(groups: Vec<Vec<[f32; 3]>>) -> (Entries, Triangles) {
        let entries = Entries::from_groups(groups);
        let triangles = Triangles::new(&entries, &Nearest::new(&entries));
        (entries, triangles)
    }

    /// Directions all over the sphere, without the clusters of `scattered` that f32 cannot tell apart.
    fn directions(count: usize) -> Vec<[f32; 3]> {
        let points = scattered(8 * count, 1);
        let is_apart =
            |d: &[f32; 3]| [[0.0, 0.0, 1.0], [-0.6, 0.8, 0.0]].iter().all(|&center| squared(center, *d) > 0.09);
        let mut all: Vec<_> = (0..points.len()).map(|i| points.at(i)).filter(is_apart).collect();
        // They come along a curve.
        all.sort_by_key(|d| d[0].to_bits().wrapping_mul(0x9e37_79b1));
        all.truncate(count);
        all
    }

    fn squared(a: [f64; 3], b: [f32; 3]) -> f64 {
        let d = sub(a, b.map(f64::from));
        dot(d, d)
    }

    /// What `around` says of a direction, if it lies in a triangle at all.
    fn mixed(entries: &Entries, triangles: &Triangles, wanted: [f32; 3]) -> Option<[f64; 3]> {
        let own = brute_force(wanted, &entries.directions) as u32;
        let around = triangles.around(wanted.map(f64::from), own)?;
        assert!(around.iter().all(|a| a.1 >= 0.0) && (around.iter().map(|a| a.1).sum::<f64>() - 1.0).abs() < 1e-12);
        let mean = |k: usize| around.iter().map(|a| a.1 * f64::from(entries.directions[a.0 as usize][k])).sum();
        Some(normalized([mean(0), mean(1), mean(2)]))
    }

    #[test]
    fn circles_are_empty_and_the_sphere_is_covered() {
        for count in [12, 100, 1500] {
            let (entries, triangles) = triangulated(vec![directions(count)]);
            assert_eq!(triangles.triangles.len(), 2 * count - 4, "Euler's formula");
            for t in &triangles.triangles {
                let [a, b, c] = t.directions;
                let center = normalized(cross(sub(b, a), sub(c, a)));
                let inside = |e: &&[f32; 3]| dot(center, normalized(e.map(f64::from))) > dot(center, a) + 1e-9;
                assert_eq!(entries.directions.iter().find(inside), None, "{t:?}");
            }
            let mut found = 0;
            for wanted in directions(1000) {
                if let Some(mean) = mixed(&entries, &triangles, wanted) {
                    assert!(squared(mean, wanted) < 1e-12, "{wanted:?} {mean:?}");
                    found += 1;
                }
            }
            assert!(found > 940, "{found} of 1000: the others lie in slim triangles");
        }
    }

    #[test]
    fn four_entries_on_a_circle_leave_no_gap() {
        // A cube: each face is a square, which may be cut either way.
        let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|bit| (bit as f32 - 0.5) * 2.0 / 3.0f32.sqrt());
        let (entries, triangles) = triangulated(vec![(0..8).map(corner).collect()]);
        assert_eq!(triangles.triangles.len(), 12);
        for wanted in directions(500) {
            let mean = mixed(&entries, &triangles, wanted).expect("the cube is closed");
            assert!(squared(mean, wanted) < 1e-12);
        }
    }

    #[test]
    fn caps_have_a_rim_and_lines_no_triangles() {
        let cap: Vec<_> = directions(400).into_iter().filter(|d| d[2] > 0.5).collect();
        let (entries, triangles) = triangulated(vec![cap]);
        assert_eq!(mixed(&entries, &triangles, [0.0, 0.0, -1.0]), None);
        assert_eq!(mixed(&entries, &triangles, [1.0, 0.0, 0.0]), None);
        assert!(mixed(&entries, &triangles, [0.0, 0.0, 1.0]).is_some());

        let z = [0.0, 0.0, 1.0];
        let line = |i: i16| normalized([f64::from(i) / 5.0, 0.0, 1.0]).map(|c| c as f32);
        for few in
            [vec![z], vec![z, z, z], vec![z, [1.0, 0.0, 0.0]], vec![z, [0.0, 0.0, -1.0]], (-7..7).map(line).collect()]
        {
            let (entries, triangles) = triangulated(vec![few]);
            for wanted in directions(20) {
                assert_eq!(mixed(&entries, &triangles, wanted), None, "{entries:?}");
            }
        }
    }

    #[test]
    fn entries_that_f32_cannot_tell_apart_do_no_harm() {
        let points = scattered(3000, 1);
        let (entries, triangles) = triangulated(vec![(0..points.len()).map(|i| points.at(i)).collect()]);
        for wanted in (0..points.len()).step_by(7).map(|i| points.at(i)).chain(directions(500)) {
            if let Some(mean) = mixed(&entries, &triangles, wanted) {
                assert!(squared(mean, wanted) < 1e-12, "{wanted:?} {mean:?}");
            }
        }
    }

    #[test]
    fn groups_and_twins_do_not_mix() {
        let mut first = directions(60);
        first.extend_from_within(..30);
        let second = directions(150);
        let (entries, triangles) = triangulated(vec![first, second]);
        let group = |e: &u32| entries.spans.iter().position(|s| s.contains(&(*e as usize)));
        assert!(triangles.triangles.iter().all(|t| t.corners.iter().all(|c| group(c) == group(&t.corners[0]))));
        assert_eq!(triangles.triangles.iter().filter(|t| group(&t.corners[0]) == Some(0)).count(), 2 * 60 - 4);
    }
}
