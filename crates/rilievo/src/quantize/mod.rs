//! Quantising normal maps (contract; the owner of this folder completes it).
use crate::indexed::{MaterialMap, NormalTable, QuantizedMap};
use crate::measure::AngleStats;
use crate::{Grid, MipChain, Normal, NormalMap, Progress, Result, Space};

/// How much work the quantiser does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Effort {
    /// Few passes.
    Fast,
    /// The default.
    #[default]
    Normal,
    /// As good as it gets.
    Best,
}

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// Number of table entries, 2 … 65 536.
    pub entries: u32,
    /// How hard to try.
    pub effort: Effort,
    /// A material per texel: entries are (normal, material) pairs and a texel never changes material.
    pub materials: Option<&'a MaterialMap>,
    /// Texels that count (false: gutter; they get the nearest entry but do not shape the table).
    pub covered: Option<&'a Grid<bool>>,
    /// Whether to build the index maps of all mip levels.
    pub mip_levels: bool,
}

/// A quantised map and what it cost.
#[derive(Debug, Clone)]
pub struct Quantized<S> {
    /// The map.
    pub map: QuantizedMap<S>,
    /// Angular error over the covered texels of level 0.
    pub error: AngleStats,
}

/// Quantises `map` to a table of `options.entries` normals.
///
/// # Errors
/// x
pub fn quantize<S: Space>(map: &NormalMap<S>, options: &Options<'_>, progress: &dyn Progress) -> Result<Quantized<S>> {
    let _ = (options, progress);
    let table = NormalTable::new(vec![Normal::Z])?;
    let map = QuantizedMap::new(table, MipChain::single(Grid::filled(map.width(), map.height(), 0)?))?;
    Ok(Quantized { map, error: AngleStats::default() })
}

/// The lowest RMS error any table of `entries` normals can reach on a uniform sphere, in radians (Fejes Tóth).
pub fn fejes_toth_rms_rad(entries: u32) -> f64 {
    f64::from(entries)
}
