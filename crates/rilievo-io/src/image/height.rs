//! Height maps in.

use rilievo::Grid;

use super::decode_raster;
use super::raster::{Depth, Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// A height map as it was stored.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightImage {
    /// Heights, white is up: 0 … 1 from integers (exactly sample / 255 or / 65535), floats as they are stored.
    pub heights: Grid<f32>,
    /// Where alpha is above zero; `None` if that is everywhere.
    pub covered: Option<Grid<bool>>,
    /// How the samples were stored: 8 bits make steps that show in the normals.
    pub depth: Depth,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Decodes gray, or colour whose channels are equal, as heights.
///
/// Floats that are not finite are an error, except where alpha is zero: there the height is 0.
///
/// # Errors
/// [`Error::Format`] for a damaged file, a colour picture or values that are not finite; [`Error::Limits`];
/// [`Error::Unsupported`].
pub fn decode_height(source: &Source, limits: &Limits) -> Result<HeightImage> {
    heights(source, &decode_raster(source, limits)?)
}

pub(super) fn heights(source: &Source, raster: &Raster) -> Result<HeightImage> {
    let name = source.name();
    if let Some(at) = raster.first_colored() {
        let reason = "red, green and blue differ: this looks like a colour picture or a normal map, not like heights; \
                      give a gray picture";
        return Err(Error::format(name, raster.place(at), reason));
    }
    let covered = raster.covered();
    let channels = raster.channels();
    let heights = match raster.samples() {
        Samples::U8(v) => v.chunks_exact(channels).map(|t| f32::from(t[0]) / 255.0).collect(),
        Samples::U16(v) => v.chunks_exact(channels).map(|t| f32::from(t[0]) / 65_535.0).collect(),
        Samples::F32(v) => finite(name, raster, v, covered.as_ref())?,
    };
    let mut warnings = Vec::new();
    if raster.depth() == Depth::U8 && matches!(super::sniff(source.bytes()), Some(super::Format::Jpeg)) {
        warnings.push("JPEG is lossy: its block pattern will show in the normals; use a PNG of 16 bits".to_owned());
    }
    warnings.extend(far_outside(&heights, covered.as_ref()));
    Ok(HeightImage { heights: raster.grid(heights), covered, depth: raster.depth(), warnings })
}

/// A warning if heights run far outside 0 … 1, as they do in metres. Integers never do.
fn far_outside(heights: &[f32], covered: Option<&Grid<bool>>) -> Option<String> {
    let inside = heights.iter().enumerate().filter(|(i, _)| covered.is_none_or(|c| c.texels()[*i]));
    let (low, high) = inside.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), (_, &h)| (low.min(h), high.max(h)));
    (low < -1.0 || high > 2.0).then(|| {
        format!(
            "heights run from {low} to {high}, not from 0 to 1: --depth is the height of 1.0 as a fraction of the width, \
             so scale them, or give a depth that fits (for metres: 1 / the width in metres)"
        )
    })
}

fn finite(name: &str, raster: &Raster, samples: &[f32], covered: Option<&Grid<bool>>) -> Result<Vec<f32>> {
    let mut heights: Vec<f32> = samples.chunks_exact(raster.channels()).map(|t| t[0]).collect();
    if let Some(covered) = covered {
        let outside = heights.iter_mut().zip(covered.texels()).filter(|(h, covered)| !**covered && !h.is_finite());
        outside.for_each(|(h, _)| *h = 0.0);
    }
    if let Some(first) = heights.iter().position(|h| !h.is_finite()) {
        let count = heights.iter().filter(|h| !h.is_finite()).count();
        let reason = format!("{count} heights are not finite numbers, the first one here; fill the holes first");
        return Err(Error::format(name, raster.place(first), reason));
    }
    Ok(heights)
}
