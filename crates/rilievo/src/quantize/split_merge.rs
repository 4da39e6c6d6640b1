//! Moving entries from where they are hardly missed to where they help.
//!
//! Lloyd's iteration never carries an entry across a region that has its fill. So now and then the entries that cost
//! least to merge into their neighbour are taken out, and the clusters that gain most are split (as in Fritzke's LBG-U
//! 1997, but many at a time). Materials share one list, so entries pass from one to another here.

use super::assign::Assignment;
use super::entries::{Entries, unit};
use super::nearest::Nearest;
use super::points::Points;
use super::spread::Spread;

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

/// Moves at most `limit` entries; returns how many. `at` are the means of the clusters of `assignment`.
pub(super) fn split_merge(points: &Points, assignment: &Assignment, at: &mut Entries, limit: usize) -> usize {
    let mut splits = splits(points, assignment, at);
    let mut merges = merges(assignment, at);
    splits.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    merges.sort_by(|a, b| a.cost.total_cmp(&b.cost));

    let group_of: Vec<usize> = at.spans.iter().enumerate().flat_map(|(g, s)| s.clone().map(move |_| g)).collect();
    let mut remaining: Vec<usize> = at.spans.iter().map(ExactSizeIterator::len).collect();
    let mut touched = vec![false; at.len()];
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
        let both = super::tree::add(assignment.sums[merge.entry], assignment.sums[merge.into]);
        if let (Some(joined), true) = (unit([both[0], both[1], both[2]]), merge.entry != merge.into) {
            at.directions[merge.into] = joined;
        }
        removed[merge.entry] = true;
        remaining[group] -= 1;
        at.directions[split.entry] = first;
        added[group_of[split.entry]].push(second);
        remaining[group_of[split.entry]] += 1;
        moved += 1;
    }
    if moved > 0 {
        let groups = added.into_iter().zip(&at.spans).map(|(new, span)| {
            let kept = span.clone().filter(|&e| !removed[e]).map(|e| at.directions[e]);
            kept.chain(new).collect()
        });
        *at = Entries::from_groups(groups.collect::<Vec<_>>());
    }
    moved
}

/// What splitting each cluster would gain.
fn splits(points: &Points, assignment: &Assignment, at: &Entries) -> Vec<Split> {
    let sums = &assignment.sums;
    let mut spreads = vec![Spread::default(); at.len()];
    for (i, &owner) in assignment.owners.iter().enumerate() {
        let (p, sum) = (points.at(i), sums[owner as usize]);
        let offset = [0, 1, 2].map(|k| f64::from(p[k]) - sum[k] / sum[3]);
        spreads[owner as usize].add(offset, f64::from(points.weight[i]));
    }
    let split = |(entry, spread): (usize, &Spread)| {
        let (axis, along) = spread.principal();
        let deviation = (along / sums[entry][3].max(f64::MIN_POSITIVE)).sqrt();
        Split { gain: GAIN_OF_SPLIT * along, entry, offset: axis.map(|a| a * HALF_MEAN * deviation) }
    };
    spreads.iter().enumerate().map(split).collect()
}

/// What merging each cluster into its neighbour would cost.
fn merges(assignment: &Assignment, at: &Entries) -> Vec<Merge> {
    let nearest = Nearest::new(at);
    let merge = |group: usize, entry: usize| {
        let weight = assignment.sums[entry][3];
        if weight == 0.0 {
            return Some(Merge { cost: 0.0, entry, into: entry });
        }
        let (into, distance) = nearest.neighbour(group, entry as u32, at.directions[entry])?;
        let other = assignment.sums[into as usize][3];
        Some(Merge { cost: weight * other / (weight + other) * distance, entry, into: into as usize })
    };
    (at.spans.iter().enumerate())
        .flat_map(|(group, span)| span.clone().map(move |entry| (group, entry)))
        .filter_map(|(group, entry)| merge(group, entry))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::assign::Assigner;
    use super::super::tree::Tree;
    use super::*;

    #[test]
    fn an_entry_moves_to_the_material_that_needs_it() {
        // Material 0 is one direction with two entries, material 1 two directions with one entry.
        let (a, b) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let points = Points::new([(0, vec![(a, 9.0)]), (1, vec![(a, 1.0), (b, 1.0)])]);
        let tree = Tree::build(&points, 4);
        let mut entries = Entries::from_groups([vec![a, a], vec![unit([1.0, 1.0, 0.0]).unwrap()]]);
        let assignment = Assigner::new(&points, &tree).assign(&entries);
        assert_eq!(split_merge(&points, &assignment, &mut entries, 4), 1);
        assert_eq!(entries.spans, [0..1, 1..3]);
        assert_eq!(entries.directions[0], a);
    }
}
