//! Which entries are near each other.
//!
//! Entries that follow each other in a table lie close together (along a Hilbert curve), so runs of [`LANES`] entries, and runs of runs, have small balls around them. Any order gives the same answers, a bad one later.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8, u32x8};

use super::entries::{Entries, squared_f64};
use super::points::LANES;
use super::tree::{SLACK, squared};
use crate::par;

/// Absolute slack where squares underflow; no two different unit vectors of f32 that matter are so close.
pub(super) const TINY: f32 = 1e-15;
/// Coordinate of padding: farther than anything on the sphere, and its square is still finite.
const FAR: f32 = 1e9;
/// Marks, in the number of an entry, that it has moved since the last step.
const MOVED: u32 = 1 << 31;

/// A bound of what was computed in a few roundings.
#[inline(always)]
pub(super) fn upper(length: f32) -> f32 {
    length * (1.0 + SLACK) + TINY
}

/// A ball around some entries.
#[derive(Debug, Clone, Copy)]
struct Ball {
    center: [f32; 3],
    radius: f32,
    /// Radius about the same centre of a ball that holds every entry which these entries may lose points to.
    reach: f32,
    /// Whether one of the entries has moved.
    moved: bool,
}

/// The entries of a table, ready to be asked who is near.
#[derive(Debug)]
pub(super) struct Vicinities {
    groups: Vec<Group>,
    /// Group and run of runs.
    tasks: Vec<(usize, usize)>,
}

/// The entries of a group.
#[derive(Debug)]
struct Group {
    entries: Range<usize>,
    /// The same, padded to whole runs; numbers may be marked [`MOVED`].
    list: List,
    /// Balls around runs of entries, around runs of those, and so on up to a single one; two orders at least.
    orders: Vec<Vec<Ball>>,
}

/// What is around a cell.
#[derive(Debug, Default)]
pub(super) struct Vicinity {
    /// Runs that matter to any cell of the task.
    runs: Vec<u32>,
    /// Entries that matter to any cell of one run.
    near: List,
    /// Entries that matter to one cell.
    candidates: List,
}

/// Entries in the order of their numbers. Planar, with room for padding.
#[derive(Debug, Default)]
pub(super) struct List {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    number: Vec<u32>,
    /// How many there are.
    count: usize,
}

impl Vicinities {
    /// Of entries that own points within `radii`. Whoever has not moved, nor has anyone near, has nothing to look at.
    pub(super) fn new(entries: &Entries, radii: &[f32], has_moved: impl Fn(usize) -> bool) -> Self {
        let group = |span: &Range<usize>| Group::new(entries, span.clone(), radii, &has_moved);
        let groups: Vec<Group> = entries.spans.iter().map(group).collect();
        let tasks =
            groups.iter().enumerate().flat_map(|(group, g)| (0..g.orders[1].len()).map(move |run| (group, run)));
        Self { tasks: tasks.collect(), groups }
    }

    /// Into how many pieces work is cut.
    pub(super) fn tasks(&self) -> usize {
        self.tasks.len()
    }

    /// The entries of a task. Those of all tasks, one after the other, are all there are.
    pub(super) fn entries(&self, task: usize) -> Range<usize> {
        let (group, run) = self.tasks[task];
        self.groups[group].run(run, LANES * LANES)
    }

    /// Calls `visit` with each entry of a task that is not alone, and the entries that may be nearer to one of its points
    /// than itself; with itself among them.
    #[inline(always)]
    pub(super) fn visit<S: Simd>(&self, simd: S, task: usize, radii: &[f32], mut visit: impl FnMut(usize, &List)) {
        let (group, task) = self.tasks[task];
        let group = &self.groups[group];
        let mut around = Vicinity::default();
        group.runs_near(&group.orders[1][task], &mut around.runs);
        for run in group.children(0, task) {
            if !group.entries_near(simd, &group.orders[0][run], &around.runs, &mut around.near) {
                continue;
            }
            for (e, slot) in group.run(run, LANES).zip(run * LANES..) {
                let number = group.list.number[slot];
                // One that has not moved can only lose points to one that has.
                let beside = if number & MOVED == 0 { Some(number) } else { None };
                let reach = upper(2.0 * radii[e]);
                around.candidates.clear(around.near.count);
                for first in (0..around.near.count).step_by(LANES) {
                    around.candidates.extend(simd, &around.near, first, group.list.at(slot), reach, beside);
                }
                if around.candidates.count > 1 {
                    visit(e, &around.candidates);
                }
            }
        }
    }
}

/// The entry nearest to each one among the others of its group, and its squared distance by [`squared_f64`]; `None` where
/// there are no others. Of equally near ones, the first.
pub(super) fn neighbours(entries: &Entries) -> Vec<Option<(u32, f64)>> {
    // Whoever comes next in the table limits how far the nearest can be.
    let mut radii = vec![f32::MAX; entries.len()];
    for span in &entries.spans {
        for (a, b) in span.clone().zip(span.clone().skip(1)) {
            let half = upper(0.5 * squared(entries.directions[a], entries.directions[b]).sqrt());
            (radii[a], radii[b]) = (radii[a].min(half), radii[b].min(half));
        }
    }
    let alone = entries.spans.iter().filter(|s| s.len() == 1).map(|s| s.start);
    alone.for_each(|e| radii[e] = 0.0);
    let (vicinities, level) = (Vicinities::new(entries, &radii, |_| true), Level::new());
    let found = par::map_range(vicinities.tasks(), |task| {
        let all = vicinities.entries(task);
        let mut found = vec![None; all.len()];
        dispatch!(level, simd => vicinities.visit(simd, task, &radii, |e, candidates| {
            let own = entries.directions[e].map(f64::from);
            let others = (0..candidates.len()).filter(|&c| candidates.id(c) != e as u32);
            let distances = others.map(|c| (candidates.id(c), squared_f64(own, candidates.at(c))));
            found[e - all.start] = distances.min_by(|a, b| a.1.total_cmp(&b.1));
        }));
        found
    });
    found.concat()
}

impl Group {
    fn new(entries: &Entries, span: Range<usize>, radii: &[f32], has_moved: &impl Fn(usize) -> bool) -> Self {
        let mut list = List::default();
        list.clear(span.len());
        let mut single = Vec::with_capacity(span.len());
        for e in span.clone() {
            let (center, moved) = (entries.directions[e], has_moved(e));
            list.set(list.count, center, e as u32 | if moved { MOVED } else { 0 });
            list.count += 1;
            single.push(Ball { center, radius: 0.0, reach: upper(2.0 * radii[e]), moved });
        }
        list.pad();
        let around = |balls: &[Ball]| balls.chunks(LANES).map(Ball::around).collect::<Vec<_>>();
        let mut orders = vec![around(&single)];
        while orders.len() < 2 || orders[orders.len() - 1].len() > 1 {
            orders.push(around(&orders[orders.len() - 1]));
        }
        Self { entries: span, list, orders }
    }

    /// The entries of a run.
    fn run(&self, run: usize, length: usize) -> Range<usize> {
        let first = self.entries.start + run * length;
        first..self.entries.end.min(first + length)
    }

    /// The balls of an order in one ball of the next.
    fn children(&self, order: usize, ball: usize) -> Range<usize> {
        ball * LANES..self.orders[order].len().min((ball + 1) * LANES)
    }

    /// Runs that hold something in the reach of a ball; from the top.
    fn runs_near(&self, ball: &Ball, runs: &mut Vec<u32>) {
        let mut open = vec![0];
        for order in (0..self.orders.len()).rev() {
            let balls = &self.orders[order];
            runs.clear();
            runs.extend(open.iter().copied().filter(|&b| ball.reaches(&balls[b as usize])));
            open.clear();
            if order > 0 {
                open.extend(runs.iter().flat_map(|&b| self.children(order - 1, b as usize)).map(|b| b as u32));
            }
        }
    }

    /// Entries of some runs that are in the reach of a ball; says whether any of the runs has moved.
    #[inline(always)]
    fn entries_near<S: Simd>(&self, simd: S, ball: &Ball, runs: &[u32], near: &mut List) -> bool {
        let mut moved = false;
        near.clear(runs.len() * LANES);
        for &run in runs {
            let other = &self.orders[0][run as usize];
            if ball.reaches(other) {
                moved |= other.moved;
                near.extend(simd, &self.list, run as usize * LANES, ball.center, ball.reach, None);
            }
        }
        near.pad();
        moved
    }
}

impl Ball {
    /// Around some balls.
    fn around(balls: &[Ball]) -> Self {
        let fold = |with: fn(f32, f32) -> f32| {
            balls.iter().map(|b| b.center).reduce(|a, b| [0, 1, 2].map(|k| with(a[k], b[k])))
        };
        let (low, high) = (fold(f32::min).unwrap_or_default(), fold(f32::max).unwrap_or_default());
        let mut all =
            Self { center: [0, 1, 2].map(|k| (low[k] + high[k]) * 0.5), radius: 0.0, reach: 0.0, moved: false };
        for ball in balls {
            let distance = squared(all.center, ball.center).sqrt();
            all.radius = all.radius.max(upper(distance + ball.radius));
            all.reach = all.reach.max(upper(distance + ball.reach));
            all.moved |= ball.moved;
        }
        all
    }

    /// Whether something in `other` may matter to this one.
    #[inline(always)]
    fn reaches(&self, other: &Ball) -> bool {
        let reach = upper(self.reach + other.radius);
        squared(self.center, other.center) <= reach * reach
    }
}

impl List {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Direction of an entry.
    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> [f32; 3] {
        [self.x[i], self.y[i], self.z[i]]
    }

    /// Number of an entry.
    #[inline(always)]
    pub(super) fn id(&self, i: usize) -> u32 {
        self.number[i] & !MOVED
    }

    /// Empties the list and makes room for so many entries.
    fn clear(&mut self, room: usize) {
        self.count = 0;
        if self.x.len() < room + 2 * LANES {
            let room = 2 * room + 2 * LANES;
            for values in [&mut self.x, &mut self.y, &mut self.z] {
                values.resize(room, FAR);
            }
            self.number.resize(room, 0);
        }
    }

    fn set(&mut self, i: usize, [x, y, z]: [f32; 3], number: u32) {
        (self.x[i], self.y[i], self.z[i], self.number[i]) = (x, y, z, number);
    }

    /// Puts padding after the last entry.
    fn pad(&mut self) {
        (self.count..self.count + LANES).for_each(|i| self.set(i, [FAR; 3], 0));
    }

    /// Adds those of [`LANES`] entries of another list that are in a ball; with `beside`, only that one and those that have
    /// moved.
    #[inline(always)]
    fn extend<S: Simd>(
        &mut self,
        simd: S,
        from: &List,
        first: usize,
        [cx, cy, cz]: [f32; 3],
        reach: f32,
        beside: Option<u32>,
    ) {
        let lanes = first..first + LANES;
        let load = |v: &[f32]| f32x8::from_slice(simd, &v[lanes.clone()]);
        let (x, y, z) = (load(&from.x), load(&from.y), load(&from.z));
        let number = u32x8::from_slice(simd, &from.number[lanes.clone()]);
        let (dx, dy, dz) = (x - cx, y - cy, z - cz);
        let mut keep = (dx * dx + dy * dy + dz * dz).simd_le(reach * reach);
        if let Some(own) = beside {
            keep &= number.simd_ge(MOVED) | number.simd_eq(own);
        }
        let kept = keep.to_bitmask().count_ones() as usize;
        if kept > 0 {
            let to = self.count..self.count + LANES;
            x.compress(keep).store_slice(&mut self.x[to.clone()]);
            y.compress(keep).store_slice(&mut self.y[to.clone()]);
            z.compress(keep).store_slice(&mut self.z[to.clone()]);
            number.compress(keep).store_slice(&mut self.number[to]);
            self.count += kept;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::nearest::Nearest;
    use super::super::testing::scattered;
    use super::*;

    #[test]
    fn neighbours_are_those_of_a_search_one_by_one() {
        for count in [2, 3, 20, 700, 5000] {
            let points = scattered(count, 2);
            let group = |g: usize| points.groups[g].points.clone().map(|i| points.at(i)).collect::<Vec<_>>();
            let mut entries = Entries::from_groups([group(0), group(1)]);
            // Neither duplicates nor bad order matter.
            let span = entries.spans[1].clone();
            entries.directions[span.end - 1] = entries.directions[span.start];
            entries.directions[..entries.spans[0].end].reverse();
            let (nearest, groups) = (Nearest::new(&entries), entries.groups());
            for (e, found) in neighbours(&entries).into_iter().enumerate() {
                assert_eq!(found, nearest.neighbour(groups[e].into(), e as u32, entries.directions[e]), "{count} {e}");
            }
        }
    }
}
