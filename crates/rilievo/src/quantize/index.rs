//! From nearest entries to index maps: dithering, smaller levels and errors, row by row.

use super::dither::Ditherer;
use super::entries::{Entries, squared_f64};
use super::mip::Levels;
use super::nearest::Nearest;
use super::{Dither, Options};
use crate::measure::{AngleStats, AngleSums, angle_of_chord};
use crate::normal::Bare;
use crate::{IndexMap, MipChain, par};

/// Whole rows of a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows<'a> {
    /// The number of their first texel in the map.
    pub first: usize,
    pub normals: &'a [Bare],
    pub covered: Option<&'a [bool]>,
}

impl Rows<'_> {
    /// Whether their texel `i` counts.
    pub(super) fn is_covered(&self, i: usize) -> bool {
        self.covered.is_none_or(|c| c[i])
    }

    /// The direction of their texel `i`.
    pub(super) fn direction(&self, i: usize) -> [f64; 3] {
        self.normals[i].vec().to_array().map(f64::from)
    }
}

/// Finishes a map whose rows come from the top.
pub(super) struct Indexer<'a> {
    base: IndexMap,
    entries: &'a Entries,
    ditherer: Ditherer<'a>,
    levels: Option<Levels<'a>>,
    error: Option<AngleSums>,
}

/// What comes out.
pub(super) struct Indexed {
    pub chain: MipChain<u16>,
    /// Error over the covered texels as they are, if it was asked for and there are any.
    pub error: Option<AngleStats>,
    pub level_errors: Vec<AngleStats>,
}

impl<'a> Indexer<'a> {
    /// Goes on from a map of nearest entries, or from one that gets them as rows come ([`Indexer::slots`]). The error of
    /// texels that are not dithered is only found if `each_error`.
    pub(super) fn new(
        base: IndexMap,
        options: &Options<'_>,
        entries: &'a Entries,
        nearest: &'a Nearest,
        each_error: bool,
    ) -> Self {
        let texels = base.texels().len() as u64;
        let each_error = each_error || options.dither != Dither::None;
        Self {
            ditherer: Ditherer::new(options.dither, base.size(), entries, nearest),
            levels: options.mip_levels.then(|| Levels::new(base.size(), entries, nearest)),
            error: each_error.then(|| AngleSums::new(texels)),
            base,
            entries,
        }
    }

    /// Whether rows have to be pushed at all.
    pub(super) fn needs_rows(&self) -> bool {
        self.levels.is_some() || self.error.is_some()
    }

    /// The entries of some texels.
    pub(super) fn slots(&mut self, texels: std::ops::Range<usize>) -> &mut [u16] {
        &mut self.base.texels_mut()[texels]
    }

    /// Takes the next rows, whose texels have their nearest entries.
    pub(super) fn push(&mut self, rows: &Rows<'_>) {
        if let Some(levels) = &mut self.levels {
            levels.push(rows, &self.base.texels()[rows.first..][..rows.normals.len()]);
        }
        let Some(error) = &mut self.error else { return };
        let entries = self.entries;
        self.ditherer.push(rows, &mut self.base, &mut |rows, indices| {
            let angle = |i: usize| {
                let entry = entries.directions[usize::from(indices[i])];
                rows.is_covered(i).then(|| angle_of_chord(squared_f64(rows.direction(i), entry)))
            };
            par::map_range(indices.len(), angle).into_iter().flatten().for_each(|angle| error.add(angle));
        });
    }

    /// Call it after the last row.
    pub(super) fn finish(self) -> crate::Result<Indexed> {
        let (levels, level_errors) = self.levels.map_or(Ok(Default::default()), Levels::finish)?;
        let chain = MipChain::from_levels(std::iter::once(self.base).chain(levels).collect())?;
        Ok(Indexed { chain, error: self.error.and_then(AngleSums::finish), level_errors })
    }
}
