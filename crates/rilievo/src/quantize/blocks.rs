//! Balls around runs of entries, so that most of a large table is passed over eight entries at a time.

use std::ops::Range;

use super::candidates::{Candidates, Record, TINY, record};
use super::points::LANES;
use super::tree::{SLACK, squared};

/// Balls around the blocks of one group's entries. Entries that follow each other should lie close together: any order
/// gives the same answers, a bad one later.
#[derive(Debug)]
pub(super) struct Blocks {
    /// The group's entries.
    records: Vec<Record>,
    balls: Vec<([f32; 3], f32)>,
}

impl Blocks {
    /// Blocks of the entries `span`.
    pub(super) fn new(directions: &[[f32; 3]], span: Range<usize>) -> Self {
        let balls = directions[span.clone()].chunks(LANES).map(ball).collect();
        Self { records: span.map(|e| record(directions[e], e as u32)).collect(), balls }
    }

    /// The numbers of all blocks.
    pub(super) fn all(&self) -> Vec<u32> {
        (0..self.balls.len() as u32).collect()
    }

    /// Those blocks of `list` that may hold the entry nearest to some point of a ball, in the same order.
    pub(super) fn near(&self, list: &[u32], center: [f32; 3], radius: f32) -> Vec<u32> {
        let distances: Vec<f32> = list.iter().map(|&b| squared(self.balls[b as usize].0, center).sqrt()).collect();
        // Every block has an entry, and it is no farther than the far side of the block's ball.
        let both = || list.iter().zip(&distances).map(|(&b, &d)| (b, d, self.balls[b as usize].1));
        let nearest = both().map(|(_, d, r)| d + r).fold(f32::INFINITY, f32::min);
        let reach = (nearest + 2.0 * radius) * (1.0 + SLACK) + TINY;
        both().filter(|&(_, d, r)| d * (1.0 - SLACK) <= reach + r * (1.0 + SLACK)).map(|(b, ..)| b).collect()
    }

    /// The entries of some blocks, numbered as in the table.
    pub(super) fn candidates(&self, list: &[u32]) -> Candidates {
        Candidates::joined(list.iter().map(|&block| {
            let first = block as usize * LANES;
            &self.records[first..(first + LANES).min(self.records.len())]
        }))
    }
}

/// A ball around the box around some directions.
fn ball(directions: &[[f32; 3]]) -> ([f32; 3], f32) {
    let fold =
        |with: fn(f32, f32) -> f32| directions.iter().copied().reduce(|a, b| [0, 1, 2].map(|k| with(a[k], b[k])));
    let (low, high) = (fold(f32::min).unwrap_or_default(), fold(f32::max).unwrap_or_default());
    let center = [0, 1, 2].map(|k| (low[k] + high[k]) * 0.5);
    let farthest = directions.iter().map(|&d| squared(center, d)).fold(0.0, f32::max);
    (center, farthest.sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::testing::{brute_force, scattered};
    use super::*;

    #[test]
    fn the_nearest_entry_is_always_in_a_block_that_is_near() {
        let (points, table) = (scattered(300, 1), scattered(203, 1));
        let directions: Vec<[f32; 3]> = (0..table.len()).map(|i| table.at(i)).collect();
        let blocks = Blocks::new(&directions, 0..directions.len());
        for radius in [0.0, 0.05, 0.7] {
            let mut passed_over = 0;
            for i in 0..points.len() {
                let center = points.at(i);
                let near = blocks.near(&blocks.all(), center, radius);
                passed_over += blocks.all().len() - near.len();
                let inside = blocks.candidates(&near);
                let inside: Vec<u32> = inside.iter(inside.all()).map(|(entry, _)| entry).collect();
                for j in 0..points.len() {
                    if squared(points.at(j), center).sqrt() <= radius {
                        assert!(inside.contains(&(brute_force(points.at(j), &directions) as u32)));
                    }
                }
            }
            assert!(passed_over > 0, "{radius}");
        }
    }
}
