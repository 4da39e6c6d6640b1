//! Iterated local search for the last per mille (Lourenço, Martin and Stützle 2003).
//!
//! Lloyd's iteration ends in one of very many local optima: the cells form patches of a hexagonal lattice with faults
//! between them. So one place after another is shaken, the iteration is run again, and what is better is kept.

use super::cells::Cells;
use super::entries::Entries;
use super::lloyd::{approach_means, shake};
use super::tree::squared;
use crate::Progress;
use crate::random::scramble;

/// How hard to search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    /// Places to shake.
    pub rounds: u32,
    /// Steps after each.
    pub steps: u32,
    /// How far the mean is overshot in all but the last two.
    pub omega: f64,
}

/// Entries that are shaken together: a few rings of cells about one. More would rarely settle into something better.
const KICKED: u64 = 20;
/// Part of the way to a random point of its own that an entry is drawn.
const HEAT: f64 = 0.9;

/// Improves a table for the points in its cells; never makes it worse for them.
pub(super) fn local_search(
    mut best: Entries,
    mut cells: Cells,
    search: Search,
    progress: &dyn Progress,
) -> (Entries, Cells) {
    cells.assign(&best);
    let mut score = total(cells.sums());
    for round in 0..u64::from(search.rounds) {
        let (mut tried, mut tried_cells) = (best.clone(), cells.clone());
        let center = best.directions[(scramble(round << 32 | 1) % best.len() as u64) as usize];
        let many = 1 + scramble(round << 32 | 2) % KICKED.min(best.len() as u64);
        let mut distances: Vec<f32> = best.directions.iter().map(|&e| squared(e, center)).collect();
        let (_, &mut reach, _) = distances.clone().select_nth_unstable_by(many as usize - 1, f32::total_cmp);
        distances.iter_mut().for_each(|d| *d = if *d <= reach { 1.0 } else { 0.0 });
        shake(&mut tried, &cells, |entry| HEAT * f64::from(distances[entry]), 1 << 31 | round);
        for step in 0..search.steps {
            tried_cells.assign(&tried);
            approach_means(&mut tried, tried_cells.sums(), if step + 2 < search.steps { search.omega } else { 1.0 });
        }
        tried_cells.assign(&tried);
        let reached = total(tried_cells.sums());
        if reached > score {
            (best, cells, score) = (tried, tried_cells, reached);
        }
        progress.advance(1);
    }
    (best, cells)
}

/// Σ |s| over the entries' sums s of weight × point. With every entry at the mean of its points the sum of squared
/// distances is a constant less twice this, so the larger the better.
fn total(sums: &[[f64; 4]]) -> f64 {
    sums.iter().map(|[x, y, z, _]| (x * x + y * y + z * z).sqrt()).sum()
}

#[cfg(test)]
mod tests {
    use super::super::seed::seed;
    use super::super::testing::scattered;
    use super::*;
    use crate::progress::Silent;

    #[test]
    fn searching_longer_is_never_worse_and_helps() {
        let points = scattered(4000, 1);
        let (start, owners) = seed(&points, 40);
        let mut cells = Cells::new(&points, &owners, 40);
        cells.assign(&start);
        let mut last = total(cells.sums());
        let first = last;
        for rounds in [5, 40] {
            let search = Search { rounds, steps: 8, omega: 1.5 };
            let (_, found) = local_search(start.clone(), cells.clone(), search, &Silent);
            let reached = total(found.sums());
            assert!(reached >= last, "{reached} {last}");
            last = reached;
        }
        assert!(last > first);
    }
}
