//! Maps that are not in memory: rows that come in bands, as often as they are asked for.

use std::borrow::Cow;

use super::entries::Entries;
use super::index::{Indexer, Rows};
use super::nearest::Nearest;
use super::points::Points;
use super::table::{self, Made, error_of, gutter};
use super::tally::{Counted, Tally, code};
use super::texels::decode_all;
use super::{Options, Quantized, bound, check_entries};
use crate::normal::Bare;
use crate::{Error, Grid, Normal, Progress, QuantizedMap, Space, par};

/// A normal map that can be gone through from top to bottom, more than once.
///
/// The library holds no more than a band of it at a time, so a map may be larger than memory.
pub trait RowSource<S: Space> {
    /// What may go wrong on the way; errors of the library are passed on as such.
    type Error: From<crate::Error>;

    /// Width and height in texels.
    fn size(&self) -> (u32, u32);

    /// Shows all rows to `visit`, from the top, in bands of whole rows: as many as some 2²⁰ texels make are a good
    /// measure, since a band is what the cores share. Stops at the first error of its own or of `visit`.
    ///
    /// Every call must show the same rows. If it does not, entries are valid but arbitrary.
    ///
    /// # Errors
    /// Those of reading, and what `visit` returns.
    fn rows(&mut self, visit: &mut Visit<'_, S, Self::Error>) -> Result<(), Self::Error>;
}

/// What a [`RowSource`] shows its rows to.
pub type Visit<'v, S, E> = dyn FnMut(Band<'_, S>) -> Result<(), E> + 'v;

/// Some whole rows of a map, one or more, left to right and from the top.
#[derive(Debug, Clone, Copy)]
pub struct Band<'a, S> {
    /// The texels.
    pub texels: BandTexels<'a, S>,
    /// Which of them count; all if there is no list. See [`super::Options::covered`].
    pub covered: Option<&'a [bool]>,
    /// The material of each; one for all if there is no list. See [`super::Options::materials`].
    pub materials: Option<&'a [u8]>,
}

/// What a band holds; compare [`super::Texels`].
#[derive(Debug, Clone, Copy)]
pub enum BandTexels<'a, S> {
    /// Unit vectors.
    Normals(&'a [Normal<S>]),
    /// 24-bit colours, read by [`crate::normal::decode_u8`] (+Y up).
    Rgb8(&'a [[u8; 3]]),
}

impl<S> BandTexels<'_, S> {
    /// How many texels there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Normals(normals) => normals.len(),
            Self::Rgb8(colors) => colors.len(),
        }
    }
}

impl<S: Space> Band<'_, S> {
    /// Whether texel `i` counts.
    pub(super) fn is_covered(&self, i: usize) -> bool {
        self.covered.is_none_or(|c| c[i])
    }
}

/// Quantises a map that passes by twice, once to make the table and once to index its texels. Only the index map is held
/// in memory: 2 bytes per texel, 2⅔ with mip levels.
///
/// The result for 24-bit colours without materials is that of [`super::quantize`] to the bit. Otherwise normals that lie
/// within some thousandths of a degree (a few hundredths in maps with millions of distinct ones all over the sphere) shape
/// the table as one, and [`Quantized::distinct`] counts them as one; texels still get the nearest entry of their own normal,
/// and errors are those of the texels.
///
/// # Errors
/// As [`super::quantize`], and those of the source; [`Error::Parameter`] if `options` has a coverage mask or materials,
/// which come with the rows; [`Error::Length`] if the rows do not fill the map.
pub fn quantize_rows<S: Space, R: RowSource<S>>(
    source: &mut R,
    options: &Options<'_>,
    progress: &dyn Progress,
) -> Result<Quantized<S>, R::Error> {
    let &Options { entries: count, effort, materials, covered, .. } = options;
    check_entries(count)?;
    if materials.is_some() || covered.is_some() {
        return Err(Error::parameter("materials or coverage", "a whole map", "none: they come with the rows").into());
    }
    let (width, height) = source.size();
    crate::grid::check_size(width.into(), height.into())?;

    let mut tally = Tally::new();
    pass(source, "counting normals", progress, |_, band| tally.add(&band))?;
    let Counted { points, colors } = tally.finish();
    let Made { table, entries, owners } = table::make(&points, count, effort, progress)?;

    let mut owner_of = colors.map(|(distinct, point_of)| {
        let mut owner_of = vec![NONE; 1 << 24];
        distinct.iter().zip(point_of).for_each(|(&color, point)| owner_of[code(color)] = owners[point as usize]);
        owner_of
    });
    let nearest = Nearest::new(&entries);
    let search = Search { points: &points, entries: &entries, nearest: &nearest };
    let base = Grid::filled(width, height, 0u16)?;
    // The errors of counted colours are those of the texels.
    let mut indexer = Indexer::new(base, options, &entries, &nearest, owner_of.is_none());
    let needs_rows = indexer.needs_rows();
    pass(source, "indexing texels", progress, |first, band| {
        let slots = indexer.slots(first..first + band.texels.count());
        match (&mut owner_of, band.texels) {
            (Some(owner_of), BandTexels::Rgb8(codes)) => search.look_up(owner_of, codes, slots),
            _ => search.find(&band, width as usize, slots),
        }
        if needs_rows {
            indexer.push(&Rows { first, normals: &band.normals(), covered: band.covered });
        }
    })?;
    let indexed = indexer.finish()?;
    let bare = Quantized {
        error: indexed.error.unwrap_or_else(|| error_of(&points, &entries, &owners)),
        map: QuantizedMap::new(table, indexed.chain)?,
        level_errors: indexed.level_errors,
        zador_rms_rad: bound::zador_rms_rad(&points, entries.len()),
        distinct: points.len(),
    };
    Ok(bare.relabel())
}

/// No entry yet.
const NONE: u32 = u32::MAX;

/// Goes through a map once; `work` gets the number of the first texel of each band.
fn pass<S: Space, R: RowSource<S>>(
    source: &mut R,
    name: &str,
    progress: &dyn Progress,
    mut work: impl FnMut(usize, Band<'_, S>),
) -> Result<(), R::Error> {
    let (width, height) = source.size();
    let (width, expected) = (width as usize, width as usize * height as usize);
    progress.begin(name, height.into());
    let mut done = 0;
    source.rows(&mut |band| {
        let count = band.texels.count();
        let lists = [band.covered.map(<[bool]>::len), band.materials.map(<[u8]>::len)];
        let fits = count.is_multiple_of(width) && lists.iter().flatten().all(|&l| l == count);
        if !fits || done + count > expected {
            return Err(Error::Length { what: "texels of the rows", expected, actual: done + count }.into());
        }
        work(done, band);
        done += count;
        progress.advance((count / width) as u64);
        Ok(())
    })?;
    if done != expected {
        return Err(Error::Length { what: "texels of the rows", expected, actual: done }.into());
    }
    Ok(())
}

/// Finds the entries of texels.
struct Search<'a> {
    points: &'a Points,
    entries: &'a Entries,
    nearest: &'a Nearest,
}

impl Search<'_> {
    /// Entries of colours, most of them known; the others are added.
    fn look_up(&self, owner_of: &mut [u32], codes: &[[u8; 3]], slots: &mut [u16]) {
        for (slot, &color) in slots.iter_mut().zip(codes) {
            let owner = &mut owner_of[code(color)];
            if *owner == NONE {
                // Only gutter has it.
                let normal: Bare = crate::normal::decode_u8(color);
                *owner = gutter(self.entries, self.nearest, Some(0), normal.vec().to_array());
            }
            *slot = *owner as u16;
        }
    }

    /// Entries of any texels.
    fn find<S: Space>(&self, band: &Band<'_, S>, width: usize, slots: &mut [u16]) {
        let normals = band.normals();
        par::for_each_row(slots, width, |row, slots| {
            for (i, slot) in (row * width..).zip(slots) {
                let material = band.materials.map_or(0, |m| m[i]);
                let group = self.points.groups.binary_search_by_key(&material, |g| g.material).ok();
                let normal = normals[i].vec().to_array();
                let entry = match group {
                    Some(group) => self.nearest.find(group, normal.map(f64::from)),
                    None => gutter(self.entries, self.nearest, None, normal),
                };
                *slot = entry as u16;
            }
        });
    }
}

impl<'a, S: Space> Band<'a, S> {
    /// The texels as unit vectors.
    fn normals(&self) -> Cow<'a, [Bare]> {
        match self.texels {
            BandTexels::Normals(normals) => Cow::Borrowed(Normal::relabel_all(normals)),
            BandTexels::Rgb8(codes) => Cow::Owned(decode_all(codes)),
        }
    }
}
