//! The smaller levels of an index map (Tarini et al. 2000, § 5.2).
//!
//! Index maps are never averaged: each texel gets the entry nearest to the mean of the normals it stands for, among the
//! entries of the material that most of them have.

use super::entries::{Entries, squared_f64};
use super::nearest::Nearest;
use crate::measure::{AngleStats, angle_of_chord, weighted_angle_stats};
use crate::normal::normal_levels;
use crate::{Grid, IndexMap, MipChain, NormalMap, Space, par};

/// All levels of an index map, and the error of each but the first against the mean normals of that level.
pub(super) struct Levels {
    pub chain: MipChain<u16>,
    pub errors: Vec<AngleStats>,
}

/// All levels below `base`, and `base` itself.
pub(super) fn mip_chain<S: Space>(
    map: &NormalMap<S>,
    base: IndexMap,
    covered: Option<&Grid<bool>>,
    entries: &Entries,
    nearest: &Nearest,
) -> crate::Result<Levels> {
    // Which material's entries a texel uses, by position in the table's spans.
    let group_of = |entry: u16| entries.spans.partition_point(|s| s.end <= usize::from(entry)) as u8;
    let groups: Vec<u8> = (0..entries.len()).map(|e| group_of(e as u16)).collect();
    let group_map = base.map(|&entry| groups[usize::from(entry)]);
    let levels = normal_levels(map.clone(), Some(group_map), covered)?;
    let group_levels = levels.materials.iter().flat_map(MipChain::levels).skip(1);
    let (mut chain, mut errors) = (vec![base], Vec::new());
    for (normals, level_groups) in levels.normals.levels().iter().skip(1).zip(group_levels) {
        let above = &chain[chain.len() - 1];
        let mut level = Grid::filled(normals.width(), normals.height(), 0u16)?;
        par::for_each_row(level.texels_mut(), normals.width() as usize, |y, row| {
            for (x, entry) in row.iter_mut().enumerate() {
                let at = (x as u32, y as u32);
                let group = level_groups[at];
                // A texel of the block above is a good first guess, if its material won.
                let guess = above[(2 * at.0, 2 * at.1)];
                let hint = (groups[usize::from(guess)] == group)
                    .then(|| (u32::from(guess), entries.directions[usize::from(guess)]));
                let direction = normals[at].vec().to_array().map(f64::from);
                *entry = nearest.find(usize::from(group), direction, hint) as u16;
            }
        });
        let angles: Vec<(f64, u64)> = (normals.texels().iter().zip(level.texels()))
            .map(|(n, &entry)| {
                let direction = n.vec().to_array().map(f64::from);
                (angle_of_chord(squared_f64(direction, entries.directions[usize::from(entry)])), 1)
            })
            .collect();
        errors.push(weighted_angle_stats(&angles));
        chain.push(level);
    }
    Ok(Levels { chain: MipChain::from_levels(chain)?, errors })
}
