//! The smaller levels of an index map (Tarini et al. 2000, § 5.2).
//!
//! Index maps are never averaged: each texel gets the entry nearest to the mean of the normals it stands for. The mean is
//! of the unquantised normals, carried down from level 0, and not of the entries of the level above as one might read the
//! paper: averaging entries adds one quantisation error per level, and costs the same.

use std::collections::BTreeMap;

use super::entries::Entries;
use super::nearest::Nearest;
use crate::mip::{next_size, span};
use crate::{Grid, IndexMap, MipChain, NormalMap, Space, par};

/// One texel of a level.
#[derive(Debug, Clone, Copy)]
struct Texel {
    /// Sum of the normals of level 0 it stands for, of its material only.
    sum: [f32; 3],
    entry: u16,
    /// Which material's entries it uses, by position in the table's spans.
    group: u8,
    /// Gutter counts only where there is nothing else.
    covered: bool,
}

/// All levels below `base`, and `base` itself.
///
/// A texel takes the material that most of its block of the level above has (of equals, the lowest), and the mean of the
/// normals with that material. Memory: a quarter of 20 bytes per texel of the base.
pub(super) fn mip_chain<S: Space>(
    map: &NormalMap<S>,
    base: IndexMap,
    covered: Option<&Grid<bool>>,
    entries: &Entries,
    nearest: &Nearest,
) -> crate::Result<MipChain<u16>> {
    let group_of = |entry: u16| entries.spans.partition_point(|s| s.end <= usize::from(entry)) as u8;
    let groups: Vec<u8> = (0..entries.len()).map(|e| group_of(e as u16)).collect();
    let at = |x, y| {
        let (sum, entry) = (map[(x, y)].vec().to_array(), base[(x, y)]);
        let covered = covered.is_none_or(|c| c[(x, y)]);
        Texel { sum, entry, group: groups[usize::from(entry)], covered }
    };
    let mut smaller = halved(base.size(), at, entries, nearest)?;
    let mut levels = Vec::new();
    while let Some(level) = smaller {
        levels.push(level.map(|t| t.entry));
        smaller = halved(level.size(), |x, y| level[(x, y)], entries, nearest)?;
    }
    levels.insert(0, base);
    MipChain::from_levels(levels)
}

/// The level after one of size `above` whose texels are `at(x, y)`; `None` after 1 × 1.
fn halved(
    above: (u32, u32),
    at: impl Fn(u32, u32) -> Texel + Sync,
    entries: &Entries,
    nearest: &Nearest,
) -> crate::Result<Option<Grid<Texel>>> {
    let Some((width, height)) = next_size(above) else { return Ok(None) };
    let empty = Texel { sum: [0.0; 3], entry: 0, group: 0, covered: false };
    let mut level = Grid::filled(width, height, empty)?;
    par::for_each_row(level.texels_mut(), width as usize, |y, row| {
        let mut block = Vec::with_capacity(9);
        for (x, texel) in row.iter_mut().enumerate() {
            block.clear();
            for sy in span(y as u32, above.1) {
                block.extend(span(x as u32, above.0).map(|sx| at(sx, sy)));
            }
            *texel = reduce(&block, entries, nearest);
        }
    });
    Ok(Some(level))
}

/// One texel from the block above it.
fn reduce(block: &[Texel], entries: &Entries, nearest: &Nearest) -> Texel {
    let covered = block.iter().any(|t| t.covered);
    let counted = || block.iter().filter(|t| t.covered == covered);
    let mut votes = BTreeMap::new();
    counted().for_each(|t| *votes.entry(t.group).or_insert(0) += 1);
    // `max_by_key` takes the last of equals: so from the highest group down.
    let group = votes.iter().rev().max_by_key(|&(_, &count)| count).map_or(0, |(&group, _)| group);
    let mut members = counted().filter(|t| t.group == group);
    let first = members.clone().next().copied().unwrap_or(block[0]);
    let sum =
        members.try_fold([0.0; 3], |a: [f32; 3], t| Some([0, 1, 2].map(|k| a[k] + t.sum[k]))).unwrap_or(first.sum);
    let [x, y, z] = sum.map(f64::from);
    let length = (x * x + y * y + z * z).sqrt();
    // Opposite normals may leave no direction: then the first texel of the block speaks for it.
    let entry = if length > 1e-6 {
        let hint = Some((u32::from(first.entry), entries.directions[usize::from(first.entry)]));
        nearest.find(usize::from(group), [x / length, y / length, z / length], hint) as u16
    } else {
        first.entry
    };
    Texel { sum, entry, group, covered }
}
