//! Moving entries from where they are hardly missed to where they help.
//!
//! Lloyd's iteration never carries an entry across a region that has its fill. So now and then the entries that cost
//! least to merge into their neighbour are taken out, and the clusters that gain most are split (as in Fritzke's LBG-U
//! 1997, but many at a time). Materials share one list, so entries pass from one to another here.

use super::cells::Cells;
use super::entries::{Entries, unit};
use super::octahedral::hilbert;
use super::spread::Spread;
use super::vicinity::neighbours;
use crate::par;

/// A split must gain so much more than the merge costs: both are estimates.
const MARGIN: f64 = 1.15;
/// Variance that is left along a line cut at its middle is a quarter.
const GAIN_OF_SPLIT: f64 = 0.75;
/// Halves of a uniform line have their means √3⁄2 of its standard deviation from its own mean.
const HALF_MEAN: f64 = 0.866_025_403_784_438_6;

struct Split {
    gain: f64,
    entry: usize,
    offset: [f64; 3],
}

struct Merge {
    cost: f64,
    entry: usize,
    /// The entry that takes over; the entry itself where there is nothing to take over.
    into: usize,
}

/// Moves at most `limit` entries and puts all in order; returns how many were moved. `at` are the means of the cells.
pub(super) fn split_merge(cells: &mut Cells, at: &mut Entries, limit: usize) -> usize {
    let mut splits = splits(cells);
    let mut merges = merges(cells, at);
    splits.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    merges.sort_by(|a, b| a.cost.total_cmp(&b.cost));

    let group_of: Vec<usize> = at.groups().into_iter().map(usize::from).collect();
    let mut remaining: Vec<usize> = at.spans.iter().map(ExactSizeIterator::len).collect();
    let mut touched = vec![false; at.len()];
    // Who takes over.
    let mut heir: Vec<u32> = (0..at.len() as u32).collect();
    let mut removed = vec![false; at.len()];
    let mut added: Vec<Vec<[f32; 3]>> = vec![Vec::new(); at.spans.len()];
    let mut moved = 0;
    let mut next = splits.iter().peekable();
    for merge in &merges {
        let group = group_of[merge.entry];
        if moved == limit || touched[merge.entry] || touched[merge.into] || remaining[group] == 1 {
            continue;
        }
        let busy = |s: &Split| touched[s.entry] || s.entry == merge.entry || s.entry == merge.into;
        while next.next_if(|s| busy(s)).is_some() {}
        let Some(split) = next.peek() else { break };
        if split.gain <= MARGIN * merge.cost {
            break;
        }
        let center = at.directions[split.entry].map(f64::from);
        let half = |sign: f64| unit([0, 1, 2].map(|k| center[k] + sign * split.offset[k]));
        let (Some(first), Some(second)) = (half(1.0), half(-1.0)) else { break };
        for entry in [merge.entry, merge.into, split.entry] {
            touched[entry] = true;
        }
        let both = super::tree::add(cells.sums()[merge.entry], cells.sums()[merge.into]);
        if let (Some(joined), true) = (unit([both[0], both[1], both[2]]), merge.entry != merge.into) {
            at.directions[merge.into] = joined;
        }
        removed[merge.entry] = true;
        heir[merge.entry] = merge.into as u32;
        remaining[group] -= 1;
        at.directions[split.entry] = first;
        added[group_of[split.entry]].push(second);
        remaining[group_of[split.entry]] += 1;
        moved += 1;
    }
    let new_of = rebuild(at, &removed, added);
    let heirs: Vec<u32> = heir.iter().map(|&h| new_of[h as usize]).collect();
    cells.renumber(&heirs);
    moved
}

/// Takes entries out, adds others to their groups, and sorts each group; returns the new number of each that stays.
fn rebuild(at: &mut Entries, removed: &[bool], added: Vec<Vec<[f32; 3]>>) -> Vec<u32> {
    let mut new_of = vec![0; at.len()];
    let (mut groups, mut first) = (Vec::new(), 0);
    for (new, span) in added.into_iter().zip(&at.spans) {
        let kept = span.clone().filter(|&e| !removed[e]).map(|e| (at.directions[e], Some(e)));
        let mut all: Vec<_> = kept.chain(new.into_iter().map(|direction| (direction, None))).collect();
        all.sort_by_cached_key(|&(direction, _)| hilbert(direction));
        for (new, &(_, old)) in (first..).zip(&all) {
            if let Some(old) = old {
                new_of[old] = new;
            }
        }
        first += all.len() as u32;
        groups.push(all.into_iter().map(|(direction, _)| direction).collect());
    }
    *at = Entries::from_groups(groups);
    new_of
}

/// What splitting each cell would gain.
fn splits(cells: &Cells) -> Vec<Split> {
    par::map_range(cells.sums().len(), |entry| {
        let sum = cells.sums()[entry];
        let mut spread = Spread::default();
        for (p, weight) in cells.members(entry) {
            spread.add([0, 1, 2].map(|k| f64::from(p[k]) - sum[k] / sum[3]), f64::from(weight));
        }
        let (axis, along) = spread.principal();
        let deviation = (along / sum[3].max(f64::MIN_POSITIVE)).sqrt();
        Split { gain: GAIN_OF_SPLIT * along, entry, offset: axis.map(|a| a * HALF_MEAN * deviation) }
    })
}

/// What merging each cell into its neighbour would cost.
fn merges(cells: &Cells, at: &Entries) -> Vec<Merge> {
    let neighbours = neighbours(at);
    let merge = |entry: usize| {
        let weight = cells.sums()[entry][3];
        if weight == 0.0 {
            return Some(Merge { cost: 0.0, entry, into: entry });
        }
        let (into, distance) = neighbours[entry]?;
        let other = cells.sums()[into as usize][3];
        Some(Merge { cost: weight * other / (weight + other) * distance, entry, into: into as usize })
    };
    par::map_range(at.len(), merge).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::super::points::Points;
    use super::*;

    #[test]
    fn an_entry_moves_to_the_material_that_needs_it() {
        // Material 0 is one direction with two entries, material 1 two directions with one entry.
        let (a, b) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let points = Points::new([(0, vec![(a, 9.0)]), (1, vec![(a, 1.0), (b, 1.0)])]);
        let mut entries = Entries::from_groups([vec![a, a], vec![unit([1.0, 1.0, 0.0]).unwrap()]]);
        let mut cells = Cells::new(&points, &[0, 2, 2], 3);
        cells.assign(&entries);
        assert_eq!(split_merge(&mut cells, &mut entries, 4), 1);
        let owners = cells.owners(3);
        assert!(owners[0] == 0 && owners[1] == owners[2] && entries.spans[1].contains(&(owners[1] as usize)));
        assert_eq!(entries.spans, [0..1, 1..3]);
        assert_eq!(entries.directions[0], a);
    }
}
