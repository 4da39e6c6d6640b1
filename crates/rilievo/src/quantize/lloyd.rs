//! Shaping the table: Lloyd's iteration, hurried along and shaken.
//!
//! Plain Lloyd (1982) steps move every entry to the mean of its points. Here they overshoot (ω > 1), which needs
//! fewer steps; entries are moved between regions now and then ([`split_merge`]); and while the table is still hot each
//! entry is drawn towards a random one of its points, a little less with every step, which frees the lattice of the
//! cells from most of its faults (stochastic relaxation: Zeger, Vaisey and Gersho 1992).

use super::Effort;
use super::cells::Cells;
use super::coarse::coarsen;
use super::entries::{Entries, unit};
use super::local_search::{Search, local_search};
use super::points::Points;
use super::seed::seed;
use super::split_merge::split_merge;
use super::tree::{LEAF, Tree};
use crate::Progress;
use crate::random::scramble;

/// How many steps of what.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schedule {
    /// Coarse points per entry.
    density: usize,
    /// Steps with moves between regions and falling heat, on coarse points.
    hot: u32,
    /// Steps without, on coarse points.
    cool: u32,
    /// Steps on all points.
    fine: u32,
    /// Part of the way to a random point of its own that an entry is drawn at first.
    heat: f64,
    /// How far the mean is overshot.
    omega: f64,
    /// Places that are shaken once more, on coarse points ([`local_search`]).
    kicks: u32,
}

impl Schedule {
    /// Small tables get more steps and more points per entry: there both cost little, and one fault of the lattice weighs
    /// more. Measured on a uniform sphere and an 8-bit object-space map with 200 000 distinct normals.
    pub(super) fn new(effort: Effort, count: u32) -> Self {
        let hot = 60 + 80_000u32.div_ceil(count).min(1000);
        let density = match count {
            0..=512 => 64,
            513..=4096 => 32,
            _ => 16,
        };
        match effort {
            Effort::Fast => match count {
                0..=512 => Self { density: 32, hot: 36, cool: 8, fine: 1, heat: 0.3, omega: 1.5, kicks: 0 },
                513..=4096 => Self { density: 12, hot: 12, cool: 2, fine: 3, heat: 0.25, omega: 1.7, kicks: 0 },
                _ => Self { density: 16, hot: 12, cool: 4, fine: 1, heat: 0.3, omega: 1.7, kicks: 0 },
            },
            Effort::Normal => Self { density, hot, cool: 30, fine: 6, heat: 0.4, omega: 1.6, kicks: 0 },
            // A kick costs a dozen steps on everything and mends one place: worth it while there are few places.
            Effort::Best => {
                let kicks = (240_000 / count).min(1200);
                Self { density: 2 * density, hot: 5 * hot, cool: 60, fine: 20, heat: 0.5, omega: 1.6, kicks }
            }
        }
    }
}

/// Hot steps between two rounds of moves.
const ROUND: u32 = 6;
/// Steps after each kick of the local search.
const KICK_STEPS: u32 = 14;

/// A table of `count` entries for `points`, and the points in its cells, within a step or so.
pub(super) fn shape(points: &Points, count: usize, schedule: Schedule, progress: &dyn Progress) -> (Entries, Cells) {
    let Schedule { hot, cool, fine, heat, omega, kicks, .. } = schedule;
    progress.begin("shaping the table", u64::from(hot + cool + kicks + fine));
    let wanted = count.saturating_mul(schedule.density);
    // Unless it saves a good part of the work, coarseness is not worth its error.
    let coarse = (wanted < points.len() / 4 * 3).then(|| coarsen(points, &Tree::build(points, LEAF), wanted));
    let few = coarse.as_ref().map_or(points, |c| &c.points);

    let (mut entries, owners) = seed(few, count);
    let mut cells = Cells::new(few, &owners, count);
    for step in 0..hot {
        cells.assign(&entries);
        let moving = step % ROUND == ROUND - 1;
        approach_means(&mut entries, cells.sums(), if moving { 1.0 } else { omega });
        if moving {
            split_merge(&mut cells, &mut entries, count / 16 + 1);
        } else {
            let left = f64::from(hot - step) / f64::from(hot);
            shake(&mut entries, &cells, |_| heat * left * left, u64::from(step));
        }
        progress.advance(1);
    }
    for step in 0..cool {
        cells.assign(&entries);
        approach_means(&mut entries, cells.sums(), if step + 2 < cool { omega } else { 1.0 });
        progress.advance(1);
    }
    if kicks > 0 {
        let search = Search { rounds: kicks, steps: KICK_STEPS, omega };
        (entries, cells) = local_search(entries, cells, search, progress);
    }
    if let Some(coarse) = &coarse {
        cells = Cells::new(points, &coarse.refine(&cells.owners(few.len())), count);
    }
    for step in 0..fine {
        cells.assign(&entries);
        approach_means(&mut entries, cells.sums(), if step + 2 < fine { omega } else { 1.0 });
        progress.advance(1);
    }
    (entries, cells)
}

/// Moves each entry `omega` of the way to the mean of its points.
pub(super) fn approach_means(entries: &mut Entries, sums: &[[f64; 4]], omega: f64) {
    for (entry, &[x, y, z, _]) in entries.directions.iter_mut().zip(sums) {
        let Some(mean) = unit([x, y, z]) else { continue };
        let aim = [0, 1, 2].map(|k| f64::from(entry[k]) + omega * (f64::from(mean[k]) - f64::from(entry[k])));
        *entry = unit(aim).unwrap_or(mean);
    }
}

/// Draws each entry part of the way to a random one of its points: so the shake is as large as the cell, along the
/// sphere, and towards where there is something.
pub(super) fn shake(entries: &mut Entries, cells: &Cells, part: impl Fn(usize) -> f64, step: u64) {
    for (index, entry) in entries.directions.iter_mut().enumerate() {
        let (part, members) = (part(index), cells.members(index).len());
        if members > 0 && part > 0.0 {
            let p = cells.member(index, (scramble(step << 32 | index as u64) % members as u64) as usize);
            let aim = [0, 1, 2].map(|k| f64::from(entry[k]) + part * (f64::from(p[k]) - f64::from(entry[k])));
            *entry = unit(aim).unwrap_or(*entry);
        }
    }
}
