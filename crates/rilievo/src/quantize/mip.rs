//! The smaller levels of an index map (Tarini et al. 2000, § 5.2).
//!
//! Index maps are never averaged: each texel gets the entry nearest to the mean of the normals it stands for, among the
//! entries of the material that most of them have.

use super::entries::{Entries, squared_f64};
use super::index::Rows;
use super::nearest::Nearest;
use crate::measure::{AngleStats, AngleSums, angle_of_chord};
use crate::normal::{Bare, Cascade, Texel};
use crate::{Grid, IndexMap, par};

/// All levels below the full size, made while its rows come.
#[derive(Debug)]
pub(super) struct Levels<'a> {
    cascade: Cascade,
    entries: &'a Entries,
    nearest: &'a Nearest,
    /// The group (material) of each entry.
    groups: Vec<u8>,
    levels: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    size: (u32, u32),
    indices: Vec<u16>,
    /// Against the mean normals of the level.
    error: AngleSums,
}

impl<'a> Levels<'a> {
    pub(super) fn new(size: (u32, u32), entries: &'a Entries, nearest: &'a Nearest) -> Self {
        let cascade = Cascade::new(size);
        let level = |size: (u32, u32)| {
            let texels = size.0 as usize * size.1 as usize;
            Level { size, indices: Vec::with_capacity(texels), error: AngleSums::new(texels as u64) }
        };
        let levels = cascade.sizes().into_iter().map(level).collect();
        Self { cascade, entries, nearest, groups: entries.groups(), levels }
    }

    /// Takes the next rows, and the entries of their texels: these tell the materials.
    pub(super) fn push(&mut self, rows: &Rows<'_>, indices: &[u16]) {
        let Self { cascade, entries, nearest, groups, levels } = self;
        let texel = |(i, (&normal, &entry)): (usize, (&Bare, &u16))| {
            Texel::new(normal, groups[usize::from(entry)], rows.is_covered(i))
        };
        cascade.push(rows.normals.iter().zip(indices).enumerate().map(texel), |level, texels| {
            let Level { size, indices, error } = &mut levels[level];
            let mut found = vec![(0, 0.0); texels.len()];
            let width = size.0 as usize;
            par::for_each_row(&mut found, width, |row, found| {
                for (slot, texel) in found.iter_mut().zip(&texels[row * width..]) {
                    let direction = texel.normal.vec().to_array().map(f64::from);
                    let entry = nearest.find(usize::from(texel.material), direction);
                    let distance2 = squared_f64(direction, entries.directions[entry as usize]);
                    *slot = (entry as u16, angle_of_chord(distance2));
                }
            });
            indices.extend(found.iter().map(|f| f.0));
            found.iter().for_each(|f| error.add(f.1));
        });
    }

    /// The levels, largest first, and the error of each.
    pub(super) fn finish(self) -> crate::Result<(Vec<IndexMap>, Vec<AngleStats>)> {
        let (mut maps, mut errors) = (Vec::new(), Vec::new());
        for level in self.levels {
            maps.push(Grid::new(level.size.0, level.size.1, level.indices)?);
            errors.extend(level.error.finish());
        }
        Ok((maps, errors))
    }
}
