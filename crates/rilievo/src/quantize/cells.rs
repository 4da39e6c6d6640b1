//! The points in the cells of a table: which entry is nearest to each point, kept from one step to the next.
//!
//! A point only ever changes over to an entry that is nearer than its own, and that lies within twice the cell's radius
//! of its own entry (the triangle inequality; Hamerly 2010, "Making k-means even faster", bounds points in the same
//! way). So each entry looks at the others in that ball, and the points of a cell are looked at together. Where no entry
//! in the ball has moved since the last step nothing can change, and nothing is looked at. The answer is not approximate.
//!
//! The loops work on [`LANES`] values side by side and are compiled once for every instruction set, chosen at run time.
//! None of them fuses or reorders an operation, so the set is not in the result.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8, mask32x8, u32x8};

use super::entries::{Entries, squared_f64};
use super::points::{LANES, Points};
use super::tree::{SLACK, add, squared};
use super::vicinity::{List, TINY, Vicinities, upper};
use crate::order::greater;
use crate::par;

/// Cells whose sums are found together.
const PIECE: usize = 512;
/// Free slots of a cell, beside a quarter of its own.
const ROOM: u32 = 4;
/// No entry.
const NONE: u32 = u32::MAX;

/// Weighted points, each in the cell of an entry.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    /// The points, cell after cell in any order, each cell with some room; [`LANES`] more for the loops' sake.
    slots: Slots,
    /// The slots of each cell.
    spans: Vec<Range<u32>>,
    /// Where the room of each cell ends.
    limits: Vec<u32>,
    /// No point of a cell is farther from its entry.
    radii: Vec<f32>,
    /// For each entry the sum of weight × point and of weight over its points.
    sums: Vec<[f64; 4]>,
    /// The table for which points were last assigned; `None` if cells are only a guess so far.
    table: Option<Entries>,
    level: Level,
}

/// Points, planar, each with its number in [`Points`].
#[derive(Debug, Clone)]
struct Slots {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    weight: Vec<f32>,
    id: Vec<u32>,
}

/// Direction, weight and number of a point.
type Point = ([f32; 3], f32, u32);

/// A point that changes over.
#[derive(Debug, Clone, Copy)]
struct Change {
    slot: u32,
    from: u32,
    to: u32,
    /// Its distance there.
    distance: f32,
}

/// What a task found out about its cells.
struct Found {
    cells: Range<usize>,
    radii: Vec<f32>,
    /// In the order of slots.
    changes: Vec<Change>,
}

impl Cells {
    /// Puts points into the cells of their `owners`: any entries of their groups; the nearer, the less work in the first step.
    pub(super) fn new(points: &Points, owners: &[u32], entries: usize) -> Self {
        let mut cells = Self {
            slots: Slots::empty(0),
            spans: Vec::new(),
            limits: Vec::new(),
            radii: vec![0.0; entries],
            sums: vec![[0.0; 4]; entries],
            table: None,
            level: Level::new(),
        };
        cells.fill(owners.iter().enumerate().map(|(i, &owner)| (owner, (points.at(i), points.weight[i], i as u32))));
        cells
    }

    /// For each entry the sum of weight × point and of weight over its points.
    pub(super) fn sums(&self) -> &[[f64; 4]] {
        &self.sums
    }

    /// The points of a cell: direction and weight.
    pub(super) fn members(&self, entry: usize) -> impl ExactSizeIterator<Item = ([f32; 3], f32)> + '_ {
        self.slots(entry).map(|slot| (self.slots.at(slot), self.slots.weight[slot]))
    }

    /// Direction of the member `number` of a cell.
    pub(super) fn member(&self, entry: usize, number: usize) -> [f32; 3] {
        self.slots.at(self.slots(entry).start + number)
    }

    /// The entry of each of `points` points, in the order of [`Points`].
    pub(super) fn owners(&self, points: usize) -> Vec<u32> {
        let mut owners = vec![0; points];
        for entry in 0..self.spans.len() {
            self.slots.id[self.slots(entry)].iter().for_each(|&i| owners[i as usize] = entry as u32);
        }
        owners
    }

    /// Renumbers entries: the cell of entry e becomes, or joins, that of entry `new_of[e]`. Cells are only a guess then.
    pub(super) fn renumber(&mut self, new_of: &[u32]) {
        if is_permutation(new_of) {
            let (spans, limits) = (self.spans.clone(), self.limits.clone());
            for (&new, (span, limit)) in new_of.iter().zip(spans.into_iter().zip(limits)) {
                (self.spans[new as usize], self.limits[new as usize]) = (span, limit);
            }
        } else {
            self.refill(|entry, _| new_of[entry]);
        }
        self.table = None;
    }

    /// Gives every point to the entry nearest to it, in f32 arithmetic: all that shaping a table needs.
    pub(super) fn assign(&mut self, entries: &Entries) {
        self.run::<false>(entries);
    }

    /// Gives every point to the entry nearest to it by [`squared_f64`]; of equals, to the first.
    pub(super) fn assign_exact(&mut self, entries: &Entries) {
        self.run::<true>(entries);
    }

    fn slots(&self, entry: usize) -> Range<usize> {
        let Range { start, end } = self.spans[entry];
        start as usize..end as usize
    }

    fn run<const EXACT: bool>(&mut self, entries: &Entries) {
        if EXACT {
            // What f32 took for nearest may not be.
            self.table = None;
        }
        let radii = self.bounds(entries);
        let has_moved = |e: usize| self.table.as_ref().is_none_or(|t| t.directions[e] != entries.directions[e]);
        let vicinities = Vicinities::new(entries, &radii, has_moved);
        let found = par::map_range(
            vicinities.tasks(),
            |task| dispatch!(self.level, simd => self.look::<EXACT, _>(simd, &vicinities, task, &radii)),
        );
        let was_guess = self.table.is_none();
        match &mut self.table {
            Some(table) if table.spans == entries.spans => table.directions.copy_from_slice(&entries.directions),
            table => *table = Some(entries.clone()),
        }
        let mut is_stale = vec![was_guess; entries.len()];
        let mut changes = Vec::with_capacity(found.iter().map(|f| f.changes.len()).sum());
        for Found { cells, radii, changes: some } in found {
            self.radii[cells].copy_from_slice(&radii);
            changes.extend(some);
        }
        if !changes.is_empty() {
            self.change(&changes);
            for &Change { from, to, .. } in &changes {
                (is_stale[from as usize], is_stale[to as usize]) = (true, true);
            }
        }
        self.add_up(&is_stale);
    }

    /// Radii about where entries are now.
    fn bounds(&self, entries: &Entries) -> Vec<f32> {
        let Some(table) = &self.table else {
            return par::map_range(entries.len(), |e| {
                let center = entries.directions[e];
                self.members(e).map(|(p, _)| squared(p, center)).fold(0.0, greater).sqrt()
            });
        };
        let both = table.directions.iter().zip(&entries.directions).zip(&self.radii);
        both.map(
            |((&was, &is), &radius)| if was == is { radius } else { upper(radius + upper(squared(was, is).sqrt())) },
        )
        .collect()
    }

    /// Looks at the cells of a task.
    #[inline(always)]
    fn look<const EXACT: bool, S: Simd>(&self, simd: S, vicinities: &Vicinities, task: usize, radii: &[f32]) -> Found {
        let cells = vicinities.entries(task);
        let (mut found, mut changes) = (radii[cells.clone()].to_vec(), Vec::new());
        vicinities.visit(simd, task, radii, |e, candidates| {
            if !self.spans[e].is_empty() {
                found[e - cells.start] = self.scan::<EXACT, S>(simd, e, candidates, &mut changes);
            }
        });
        Found { cells, radii: found, changes }
    }

    /// Finds the points of cell `e` that are nearer to another of the candidates; returns the radius of the rest.
    #[inline(always)]
    fn scan<const EXACT: bool, S: Simd>(&self, simd: S, e: usize, candidates: &List, changes: &mut Vec<Change>) -> f32 {
        let most = f32x8::splat(simd, f32::MAX);
        let mut farthest = f32x8::splat(simd, 0.0);
        let slots = self.slots(e);
        for first in slots.clone().step_by(LANES) {
            let load = |v: &[f32]| f32x8::from_slice(simd, &v[first..first + LANES]);
            let (x, y, z) = (load(&self.slots.x), load(&self.slots.y), load(&self.slots.z));
            let (mut nearest, mut second, mut who) = (most, most, u32x8::splat(simd, 0));
            for c in 0..candidates.len() {
                let [cx, cy, cz] = candidates.at(c);
                let (dx, dy, dz) = (x - cx, y - cy, z - cz);
                let d = dx * dx + dy * dy + dz * dz;
                let closer = d.simd_lt(nearest);
                if EXACT {
                    second = second.min(closer.select(nearest, d));
                }
                who = closer.select(u32x8::splat(simd, candidates.id(c)), who);
                nearest = closer.select(d, nearest);
            }
            let filled = (1u64 << LANES.min(slots.end - first)) - 1;
            if EXACT {
                let unclear = second.simd_le(nearest * (1.0 + 4.0 * SLACK) + TINY * TINY);
                for l in bits(unclear.to_bitmask() & filled) {
                    who[l] = decide(self.slots.at(first + l), candidates);
                }
            }
            let others = !who.simd_eq(e as u32).to_bitmask() & filled;
            let own = mask32x8::from_bitmask(simd, filled & !others);
            farthest = farthest.max(own.select(nearest, f32x8::splat(simd, 0.0)));
            for l in bits(others) {
                let (slot, distance) = ((first + l) as u32, upper(nearest[l].sqrt()));
                changes.push(Change { slot, from: e as u32, to: who[l], distance });
            }
        }
        upper(farthest.to_array().into_iter().fold(0.0, f32::max).sqrt())
    }

    /// Moves points to their new cells.
    fn change(&mut self, changes: &[Change]) {
        let mut ends: Vec<u32> = self.spans.iter().map(|s| s.end).collect();
        for &Change { from, to, distance, .. } in changes {
            ends[from as usize] -= 1;
            ends[to as usize] += 1;
            let radius = &mut self.radii[to as usize];
            *radius = radius.max(distance);
        }
        let fits = ends.iter().zip(&self.limits).all(|(end, limit)| end <= limit);
        if !fits {
            let mut owners = vec![NONE; self.slots.x.len()];
            changes.iter().for_each(|c| owners[c.slot as usize] = c.to);
            self.refill(|entry, slot| if owners[slot] == NONE { entry as u32 } else { owners[slot] });
            return;
        }
        let leaving: Vec<_> = changes.iter().map(|c| self.slots.get(c.slot as usize)).collect();
        // The last one of a cell fills the gap: from the back, so that it is one that stays.
        for &Change { slot, from, .. } in changes.iter().rev() {
            let span = &mut self.spans[from as usize];
            span.end -= 1;
            let last = self.slots.get(span.end as usize);
            self.slots.set(slot as usize, last);
        }
        for (change, point) in changes.iter().zip(leaving) {
            let span = &mut self.spans[change.to as usize];
            self.slots.set(span.end as usize, point);
            span.end += 1;
        }
    }

    /// Sorts the points by an owner told by their entry and their slot so far.
    fn refill(&mut self, owner: impl Fn(usize, usize) -> u32) {
        let old = std::mem::replace(&mut self.slots, Slots::empty(0));
        let cells: Vec<_> = (0..self.spans.len()).map(|entry| (entry, self.slots(entry))).collect();
        let owned = cells.into_iter().flat_map(|(entry, slots)| slots.map(move |slot| (entry, slot)));
        self.fill(owned.map(|(entry, slot)| (owner(entry, slot), old.get(slot))));
    }

    /// Puts points, each with its owner, into new cells; those of an owner stay in their order.
    fn fill(&mut self, points: impl Iterator<Item = (u32, Point)> + Clone) {
        let mut counts = vec![0u32; self.radii.len()];
        points.clone().for_each(|(owner, _)| counts[owner as usize] += 1);
        self.spans.clear();
        self.limits.clear();
        let mut end = 0;
        for count in counts {
            self.spans.push(end..end);
            end += count + count / 4 + ROOM;
            self.limits.push(end);
        }
        self.slots = Slots::empty(end as usize + LANES);
        points.for_each(|(owner, point)| {
            let span = &mut self.spans[owner as usize];
            self.slots.set(span.end as usize, point);
            span.end += 1;
        });
    }

    /// Sums of the cells that have changed.
    fn add_up(&mut self, is_stale: &[bool]) {
        let moment = |([x, y, z], weight): ([f32; 3], f32)| [x, y, z, 1.0].map(|c| f64::from(c) * f64::from(weight));
        let sum = |e: usize| self.members(e).map(moment).fold([0.0; 4], add);
        let pieces = par::map_range(is_stale.len().div_ceil(PIECE), |piece| {
            let part = piece * PIECE..is_stale.len().min((piece + 1) * PIECE);
            part.map(|e| if is_stale[e] { sum(e) } else { self.sums[e] }).collect::<Vec<_>>()
        });
        self.sums = pieces.concat();
    }
}

impl Slots {
    fn empty(count: usize) -> Self {
        let zeros = vec![0.0; count];
        Self { x: zeros.clone(), y: zeros.clone(), z: zeros.clone(), weight: zeros, id: vec![0; count] }
    }

    /// A direction.
    fn at(&self, slot: usize) -> [f32; 3] {
        [self.x[slot], self.y[slot], self.z[slot]]
    }

    fn get(&self, slot: usize) -> Point {
        (self.at(slot), self.weight[slot], self.id[slot])
    }

    fn set(&mut self, slot: usize, ([x, y, z], weight, id): Point) {
        (self.x[slot], self.y[slot], self.z[slot]) = (x, y, z);
        (self.weight[slot], self.id[slot]) = (weight, id);
    }
}

/// Whether every number occurs once.
fn is_permutation(numbers: &[u32]) -> bool {
    let mut seen = vec![false; numbers.len()];
    numbers.iter().all(|&n| !std::mem::replace(&mut seen[n as usize], true))
}

/// The numbers of the bits that are set, rising.
fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        bit
    })
}

/// The nearest by [`squared_f64`], where f32 cannot tell.
fn decide(point: [f32; 3], candidates: &List) -> u32 {
    let (mut nearest, mut who) = (f64::INFINITY, 0);
    for c in 0..candidates.len() {
        let d = squared_f64(point.map(f64::from), candidates.at(c));
        if d < nearest {
            (nearest, who) = (d, candidates.id(c));
        }
    }
    who
}

#[cfg(test)]
mod tests {
    use super::super::lloyd::approach_means;
    use super::super::seed::seed;
    use super::super::testing::{brute_force, scattered};
    use super::*;

    fn expect_nearest(points: &Points, cells: &Cells, entries: &Entries, exact: bool) {
        let owners = cells.owners(points.len());
        let mut sums = vec![[0.0; 4]; entries.len()];
        for (group, g) in points.groups.iter().enumerate() {
            let span = entries.spans[group].clone();
            for i in g.points.clone() {
                let expected = span.start + brute_force(points.at(i), &entries.directions[span.clone()]);
                let found = owners[i] as usize;
                let distance = |e: usize| squared_f64(points.at(i).map(f64::from), entries.directions[e]).sqrt();
                assert!(found == expected || !exact && distance(found) - distance(expected) < 1e-7, "{i}");
                let [x, y, z] = points.at(i).map(f64::from);
                sums[found] = add(sums[found], [x, y, z, 1.0].map(|c| c * f64::from(points.weight[i])));
            }
        }
        for (found, expected) in cells.sums().iter().zip(&sums) {
            assert!((0..4).all(|k| (found[k] - expected[k]).abs() < 1e-6));
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let points = scattered(20_000, 2);
        let (mut entries, owners) = seed(&points, 300);
        let mut best = Cells::new(&points, &owners, entries.len());
        let mut plain = Cells { level: Level::baseline(), ..best.clone() };
        for _ in 0..5 {
            best.assign(&entries);
            plain.assign(&entries);
            assert_eq!((best.owners(20_000), &best.radii), (plain.owners(20_000), &plain.radii));
            approach_means(&mut entries, best.sums(), 1.5);
        }
        best.assign_exact(&entries);
        plain.assign_exact(&entries);
        assert_eq!(best.owners(20_000), plain.owners(20_000));
    }

    #[test]
    fn step_after_step_points_are_where_brute_force_puts_them() {
        for (count, groups, entries) in [(1, 1, 1), (40, 3, 5), (3000, 1, 300), (3000, 2, 64)] {
            let points = scattered(count, groups);
            let (mut entries, owners) = seed(&points, entries);
            // The worst guess: all points in one cell of their group.
            let firsts: Vec<u32> =
                entries.groups().iter().map(|&g| entries.spans[usize::from(g)].start as u32).collect();
            let guess: Vec<u32> = owners.iter().map(|&owner| firsts[owner as usize]).collect();
            let mut cells = Cells::new(&points, &guess, entries.len());
            for step in 0..12 {
                cells.assign(&entries);
                expect_nearest(&points, &cells, &entries, false);
                match step {
                    // Only a few move, one of them far away.
                    5..8 => {
                        let (last, first) = (entries.spans[0].end - 1, entries.spans[0].start);
                        entries.directions[first] = points.at(step);
                        entries.directions[last] = points.at(0);
                    }
                    8 => {
                        let span = entries.spans[0].clone();
                        let mut new_of: Vec<u32> = (0..entries.len() as u32).collect();
                        new_of[span.clone()].reverse();
                        entries.directions[span].reverse();
                        cells.renumber(&new_of);
                    }
                    9 => cells.renumber(&firsts),
                    _ => approach_means(&mut entries, cells.sums(), 1.4),
                }
            }
            // The same table again, looked at more closely.
            cells.assign(&entries);
            cells.assign_exact(&entries);
            expect_nearest(&points, &cells, &entries, true);
            // Duplicates: the lower index must win.
            let span = entries.spans[0].clone();
            entries.directions[span.end - 1] = entries.directions[span.start];
            cells.assign_exact(&entries);
            expect_nearest(&points, &cells, &entries, true);
        }
    }
}
