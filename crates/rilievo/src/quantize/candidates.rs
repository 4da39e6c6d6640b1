//! The entries that may still be nearest to something inside a ball.

use std::ops::Range;

use super::points::LANES;
use super::tree::{SLACK, squared};

/// Absolute slack where squares underflow; no two different unit vectors of f32 that matter are so close.
pub(super) const TINY: f32 = 1e-15;
/// Coordinate of padding: farther than anything on the sphere, and its square is still finite.
const FAR: f32 = 1e9;

/// A candidate: x, y, z, and the bits of its number. One store moves it.
pub(super) type Record = [f32; 4];

/// The record of an entry.
pub(super) fn record([x, y, z]: [f32; 3], id: u32) -> Record {
    [x, y, z, f32::from_bits(id)]
}

/// A stack of lists of candidates. Every list is followed by [`LANES`] entries that are too far to matter, so that loops
/// over lanes need no end of their own.
#[derive(Debug, Clone)]
pub(super) struct Candidates {
    list: Vec<Record>,
    /// Squared distances, while a list is filtered.
    distances: Vec<[f32; LANES]>,
}

/// Padding.
const NOBODY: Record = [FAR, FAR, FAR, 0.0];

/// The squared distance from a ball's centre beyond which nothing is nearest to any of its points, if the candidate
/// nearest to the centre is at the squared distance `nearest`.
#[inline(always)]
fn reach(nearest: f32, radius: f32) -> f32 {
    let reach = (nearest.sqrt() + 2.0 * radius) * (1.0 + SLACK) + TINY;
    reach * reach
}

impl Candidates {
    /// The first list: directions with their numbers.
    pub(super) fn new(list: impl Iterator<Item = ([f32; 3], u32)>) -> Self {
        let mut list: Vec<_> = list.map(|(direction, id)| record(direction, id)).collect();
        list.extend([NOBODY; LANES]);
        Self { list, distances: Vec::new() }
    }

    /// The same of runs of records.
    pub(super) fn joined<'a>(runs: impl ExactSizeIterator<Item = &'a [Record]>) -> Self {
        // Room for the first two lists made of this one.
        let mut list = Vec::with_capacity((3 * runs.len() + 8) * LANES);
        runs.for_each(|run| list.extend_from_slice(run));
        list.extend([NOBODY; LANES]);
        Self { list, distances: Vec::new() }
    }

    /// Where the first list lies, as long as it is the only one.
    pub(super) fn all(&self) -> Range<usize> {
        0..self.list.len() - LANES
    }

    /// The number of the candidate at `at`.
    #[inline(always)]
    pub(super) fn id(&self, at: usize) -> u32 {
        self.list[at][3].to_bits()
    }

    /// Number and direction of the candidates of a list.
    #[inline(always)]
    pub(super) fn iter(&self, list: Range<usize>) -> impl Iterator<Item = (u32, [f32; 3])> + '_ {
        self.list[list].iter().map(|&[x, y, z, id]| (id.to_bits(), [x, y, z]))
    }

    /// Makes the list of those candidates of `parent` that may be nearest to a point of a ball, behind `parent`. Lists
    /// that were there are gone.
    #[inline(always)]
    pub(super) fn filter(&mut self, parent: Range<usize>, center: [f32; 3], radius: f32) -> Range<usize> {
        let first = parent.end + LANES;
        self.reserve(first + parent.len() + 2 * LANES);
        let (below, above) = self.list.split_at_mut(first);
        let blocks = below[parent.start..].as_chunks::<LANES>().0;
        let blocks = &blocks[..parent.len().div_ceil(LANES)];
        // Distances first, in a loop without branches.
        let (mut nearest, mut who) = ([f32::MAX; LANES], [0u32; LANES]);
        for (index, (block, d)) in blocks.iter().zip(&mut self.distances).enumerate() {
            for l in 0..LANES {
                let [x, y, z, _] = block[l];
                d[l] = squared([x, y, z], center);
                let closer = d[l] < nearest[l];
                nearest[l] = if closer { d[l] } else { nearest[l] };
                who[l] = if closer { index as u32 } else { who[l] };
            }
        }
        let mut best = 0;
        for l in 1..LANES {
            best = if nearest[l] < nearest[best] { l } else { best };
        }
        let (nearest, [x, y, z, _]) = (nearest[best], blocks[who[best] as usize][best]);
        let best = [x, y, z];
        let (reach, diameter) = (reach(nearest, radius), 4.0 * radius * radius * (1.0 + SLACK));
        let mut count = 0;
        for (block, d) in blocks.iter().zip(&self.distances) {
            let mut keep = [0u8; LANES];
            for l in 0..LANES {
                let [x, y, z, _] = block[l];
                // Beaten: the whole ball lies on the best one's side of the plane between the two.
                let ahead = d[l] - nearest - d[l] * SLACK;
                let apart = diameter * squared([x, y, z], best);
                let beaten = (ahead > TINY) & (ahead * ahead > apart);
                keep[l] = u8::from((d[l] <= reach) & !beaten);
            }
            if keep == [0; LANES] {
                continue;
            }
            for l in 0..LANES {
                // Written in any case, counted only if kept: no branch to mispredict.
                above[count] = block[l];
                count += usize::from(keep[l]);
            }
        }
        above[count..count + LANES].fill(NOBODY);
        first..first + count
    }

    fn reserve(&mut self, length: usize) {
        if self.list.len() < length {
            self.list.resize(2 * length, NOBODY);
            self.distances.resize(2 * length / LANES, [0.0; LANES]);
        }
    }
}
