//! Quantising normal maps: a small table of normals and an index map into it (Tarini et al. 2000, § 4).
//!
//! First the distinct directions are found, and fewer that stand for them (the nodes of a quadtree); the table is seeded by
//! cutting clusters in two and shaped by Lloyd's iteration, at first on the few, then on all; points stay in the cells of
//! their entries from step to step. The table is rounded to what files hold and sorted along a Hilbert curve, and only
//! then is every texel given its nearest entry.
//!
//! - **Determinism:** class A: the same bits for any thread count, with and without `rayon`. Work is cut into pieces that
//!   do not depend on the machine, and only + − × ÷ √ in a fixed order decide anything.

mod bound;
mod candidates;
mod cells;
mod coarse;
mod colors;
mod dither;
mod entries;
mod index;
mod lloyd;
mod local_search;
mod mip;
mod nearest;
mod octahedral;
mod points;
mod radix;
mod round;
mod rows;
mod search;
mod seed;
mod split_merge;
mod spread;
mod table;
mod tally;
#[cfg(test)]
mod testing;
mod texels;
mod tree;
mod vicinity;

pub use bound::fejes_toth_rms_rad;
pub use dither::Dither;
pub use rows::{Band, BandTexels, RowSource, Visit, quantize_rows};
pub use search::quantize_within;
pub use texels::Texels;

use self::index::{Indexer, Rows};
use self::nearest::Nearest;
use self::points::{Gathered, NO_POINT, gather};
use self::table::{Made, error_of, gutter};
use self::texels::Source;
use crate::indexed::{IndexMap, MAX_ENTRIES, MaterialMap, QuantizedMap};
use crate::measure::AngleStats;
use crate::{Error, Grid, Normal, Object, Progress, Result, Space, par};

/// Rows that are worked on together. Not part of the result.
const BAND_ROWS: usize = 64;

/// How much work the quantiser does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Effort {
    /// Few steps: 1 to 2 % more error in a third to a quarter of the time.
    Fast,
    /// The default.
    #[default]
    Normal,
    /// Many steps, for the last half per cent.
    Best,
}

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// Number of table entries, 1 … 65 536. A map with fewer distinct (normal, material) pairs gets just these.
    pub entries: u32,
    /// How hard to try.
    pub effort: Effort,
    /// A material per texel: entries are (normal, material) pairs and a texel never changes material.
    pub materials: Option<&'a MaterialMap>,
    /// Texels that count. The others (gutter) do not shape the table; they get the nearest entry of their material, or
    /// of any where their material has none.
    pub covered: Option<&'a Grid<bool>>,
    /// Whether to build the index maps of all mip levels.
    pub mip_levels: bool,
    /// How the texels of the largest level choose their entries. Smaller levels take the nearest: their normals are
    /// means already, and noise in them would flicker as levels change.
    pub dither: Dither,
}

impl Default for Options<'_> {
    /// 2048 entries, the paper's choice; normal effort, one material, all texels, one level.
    fn default() -> Self {
        Self {
            entries: 2048,
            effort: Effort::Normal,
            materials: None,
            covered: None,
            mip_levels: false,
            dither: Dither::None,
        }
    }
}

/// A quantised map and what it cost.
#[derive(Debug, Clone)]
pub struct Quantized<S> {
    /// The map.
    pub map: QuantizedMap<S>,
    /// Angular error over the covered texels of level 0, as they are: dithered ones with the entries they got.
    pub error: AngleStats,
    /// Angular error of each smaller level, against the mean normals of that level ([`crate::normal::normal_levels`]) over
    /// all of its texels; empty without [`Options::mip_levels`].
    pub level_errors: Vec<AngleStats>,
    /// RMS angle, in radians, that Zador's theorem lets one expect of the best table of this size for the map's own density
    /// of normals. An estimate for large tables and smooth densities, not a bound: measured errors may lie on both sides.
    pub zador_rms_rad: f64,
    /// Distinct (normal, material) pairs among the covered texels.
    pub distinct: usize,
}

impl Quantized<Object> {
    fn relabel<S: Space>(self) -> Quantized<S> {
        let Self { map, error, level_errors, zador_rms_rad, distinct } = self;
        Quantized { map: map.map_normals(Normal::relabel), error, level_errors, zador_rms_rad, distinct }
    }
}

/// Quantises `map` to a table of `options.entries` normals. The map may be one of normals or of 24-bit colours.
///
/// Every entry is a unit normal that 16 bits per component hold exactly, and every texel has the entry of its material
/// that is nearest to it (of equally near ones, the first) unless it is dithered. Entries are sorted by material, and
/// within a material along a Hilbert curve over the sphere.
///
/// - **Space:** that of `map`; nothing here depends on it.
/// - **Memory:** up to 20 bytes per texel beside the map while it works, and some 80 per distinct normal.
/// - **Accuracy:** on a uniform sphere within ½ % of [`fejes_toth_rms_rad`], held by `tests/quantize_quality.rs`.
///
/// # Errors
/// [`Error::Parameter`] for a number of entries outside 1 … 65 536 or below the number of materials in use,
/// [`Error::SizeMismatch`] if `materials` or `covered` have another size than `map`, [`Error::Missing`] if no texel is
/// covered.
pub fn quantize<'a, S: Space>(
    map: impl Into<Texels<'a, S>>,
    options: &Options<'_>,
    progress: &dyn Progress,
) -> Result<Quantized<S>> {
    let map = map.into();
    check_entries(options.entries)?;
    options.materials.map_or(Ok(()), |m| map.expect_same_size("material map", m))?;
    options.covered.map_or(Ok(()), |c| map.expect_same_size("coverage mask", c))?;
    quantize_bare(map.size(), map.source(), options, progress).map(Quantized::relabel)
}

/// [`quantize`] without the label; see [`crate::normal::Bare`].
fn quantize_bare(
    (width, height): (u32, u32),
    texels: Source<'_>,
    options: &Options<'_>,
    progress: &dyn Progress,
) -> Result<Quantized<Object>> {
    let &Options { entries: count, effort, materials, covered, .. } = options;
    progress.begin("finding distinct normals", 1);
    let Gathered { points, mut class_of, point_of } = gather(texels, materials, covered);
    progress.advance(1);
    let Made { table, entries, owners } = table::make(&points, count, effort, progress)?;

    progress.begin("indexing texels", 1);
    let entry_of = par::map_range(point_of.len(), |class| owners[point_of[class] as usize]);
    let nearest = Nearest::new(&entries);
    let group_of = |texel: usize| {
        let material = materials.map_or(0, |m| m.texels()[texel]);
        points.groups.binary_search_by_key(&material, |g| g.material).ok()
    };
    // The index of each texel takes the place of its class: one array less.
    par::for_each_row(&mut class_of, width as usize, |y, row| {
        for (x, slot) in row.iter_mut().enumerate() {
            let texel = y * width as usize + x;
            *slot = match *slot {
                NO_POINT => gutter(&entries, &nearest, group_of(texel), texels.normal(texel).vec().to_array()),
                class => entry_of[class as usize],
            };
        }
    });
    let base: IndexMap = Grid::new(width, height, par::map_range(class_of.len(), |texel| class_of[texel] as u16))?;
    progress.advance(1);

    let mut indexer = Indexer::new(base, options, &entries, &nearest, false);
    if indexer.needs_rows() {
        progress.begin("dithering, smaller levels", height.into());
        for first in (0..height).step_by(BAND_ROWS) {
            let rows = first as usize..(first as usize + BAND_ROWS).min(height as usize);
            let band = rows.start * width as usize..rows.end * width as usize;
            let covered = covered.map(|c| &c.texels()[band.clone()]);
            indexer.push(&Rows { first: band.start, normals: &texels.decoded(band), covered });
            progress.advance(rows.len() as u64);
        }
    }
    let indexed = indexer.finish()?;
    let error = indexed.error.unwrap_or_else(|| error_of(&points, &entries, &owners));
    Ok(Quantized {
        map: QuantizedMap::new(table, indexed.chain)?,
        error,
        level_errors: indexed.level_errors,
        zador_rms_rad: bound::zador_rms_rad(&points, entries.len()),
        distinct: points.len(),
    })
}

fn check_entries(count: u32) -> Result<()> {
    if count == 0 || count as usize > MAX_ENTRIES {
        return Err(Error::parameter("entries", count, format_args!("1 to {MAX_ENTRIES}")));
    }
    Ok(())
}
