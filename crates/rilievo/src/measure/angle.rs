//! Angles between normal maps.
use crate::{Grid, NormalMap, Result, Space};
/// Statistics of the angles between two normal maps, in radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AngleStats {
    /// Mean.
    pub mean_rad: f64,
    /// Root mean square.
    pub rms_rad: f64,
    /// 99th percentile.
    pub p99_rad: f64,
    /// Largest.
    pub max_rad: f64,
    /// Texels compared.
    pub count: u64,
}
/// Compares texel by texel; only where `covered` says so, if given.
///
/// # Errors
/// x
pub fn angle_stats<S: Space>(
    reference: &NormalMap<S>,
    other: &NormalMap<S>,
    covered: Option<&Grid<bool>>,
) -> Result<AngleStats> {
    let _ = (reference, other, covered);
    Ok(AngleStats::default())
}
