//! Normal maps in.

use rilievo::normal::{decode_u8, decode_u16, spread_normals};
use rilievo::quantize::Texels;
use rilievo::{Convention, Grid, Normal, NormalMap, Space};

use super::decode_raster;
use super::lengths::Lengths;
use super::raster::{Depth, Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// A normal map as it was stored.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalImage<S> {
    /// Unit normals, +Y up; +Z where not covered.
    pub normals: NormalMap<S>,
    /// The 24-bit colours they were decoded from, +Y up: a quantiser is faster with them. `None` for other depths, and
    /// where not all is covered.
    pub colors: Option<Grid<[u8; 3]>>,
    /// Where alpha is above zero; `None` if that is everywhere.
    pub covered: Option<Grid<bool>>,
    /// How the samples were stored.
    pub depth: Depth,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl<S: Space> NormalImage<S> {
    /// What to give to [`rilievo::quantize::quantize`]: the colours if there are any, else the normals.
    pub fn texels(&self) -> Texels<'_, S> {
        self.colors.as_ref().map_or(Texels::Normals(&self.normals), Texels::Rgb8)
    }
}

/// Decodes a colour picture as normals and renormalises them.
///
/// Integers stand for `c / max · 2 − 1`, floats for themselves, so x, y, z lie in −1 … 1. `convention` is what the
/// file has; the result is +Y up.
///
/// # Errors
/// [`Error::Format`] for a damaged file, a gray one, or texels without direction (zero or not finite) where alpha is
/// not zero; [`Error::Limits`]; [`Error::Unsupported`].
pub fn decode_normals<S: Space>(source: &Source, convention: Convention, limits: &Limits) -> Result<NormalImage<S>> {
    normals(source, &decode_raster(source, limits)?, convention, false)
}

/// As [`decode_normals`], but texels without direction get the normal of the nearest texel that has one (the map repeats),
/// and a warning says how many they were and where the first one is.
///
/// # Errors
/// As [`decode_normals`]; [`Error::Format`] if no texel has a direction.
pub fn repair_normals<S: Space>(source: &Source, convention: Convention, limits: &Limits) -> Result<NormalImage<S>> {
    normals(source, &decode_raster(source, limits)?, convention, true)
}

pub(super) fn normals<S: Space>(
    source: &Source,
    raster: &Raster,
    convention: Convention,
    repair: bool,
) -> Result<NormalImage<S>> {
    if !raster.has_color() {
        let reason = "a gray picture holds heights, not normals; make a normal map of it first";
        return Err(Error::format(source.name(), "header", reason));
    }
    let covered = raster.covered();
    let inside = covered.as_ref();
    let (mut lengths, mut repaired) = (Lengths::default(), None);
    let normals = match raster.samples() {
        Samples::U8(v) => {
            lengths.measure(v, raster.channels(), 0, inside.map(Grid::texels), |c| f32::from(c) / 127.5 - 1.0);
            convert(raster, v, inside, |c| convention.apply(decode_u8(c)))
        }
        Samples::U16(v) => {
            lengths.measure(v, raster.channels(), 0, inside.map(Grid::texels), |c| f32::from(c) / 32_767.5 - 1.0);
            convert(raster, v, inside, |c| convention.apply(decode_u16(c)))
        }
        Samples::F32(v) => {
            let without = Directionless::find::<S>(raster, v, inside);
            if let (Some(without), false) = (&without, repair) {
                return Err(Error::format(source.name(), raster.place(without.first), without.reason()));
            }
            lengths.measure(v, raster.channels(), 0, inside.map(Grid::texels), |c| c);
            let mut normals = convert(raster, v, inside, |c| convention.apply(Normal::new_or(c.into(), Normal::Z)));
            if let Some(without) = without {
                normals = without.repair(source.name(), raster, v, inside, normals)?;
                repaired = Some(without.warning(raster));
            }
            normals
        }
    };
    let mut warnings = lengths.warnings::<S>(raster.depth(), |i| raster.place(i));
    warnings.extend(repaired);
    let colors = match raster.samples() {
        Samples::U8(v) if covered.is_none() => Some(raster.grid(colors(v, raster.channels(), convention))),
        _ => None,
    };
    Ok(NormalImage { normals: raster.grid(normals), colors, covered, depth: raster.depth(), warnings })
}

/// The colours alone, +Y up. 255 − c stands for exactly the opposite of c.
pub(super) fn colors(samples: &[u8], channels: usize, convention: Convention) -> Vec<[u8; 3]> {
    let green = |g: u8| if convention == Convention::Dx { 255 - g } else { g };
    samples.chunks_exact(channels).map(|t| [t[0], green(t[1]), t[2]]).collect()
}

/// One normal per texel, rows in parallel; +Z where not covered.
fn convert<S: Space, T: Copy + Sync>(
    raster: &Raster,
    samples: &[T],
    covered: Option<&Grid<bool>>,
    decode: impl Fn([T; 3]) -> Normal<S> + Sync + Send,
) -> Vec<Normal<S>> {
    let (width, channels) = (raster.size().0 as usize, raster.channels());
    let mut normals = vec![Normal::Z; samples.len() / channels];
    rilievo::par::for_each_row(&mut normals, width, |y, row| {
        let texels = samples[y * width * channels..].chunks_exact(channels);
        for (x, (n, t)) in row.iter_mut().zip(texels).enumerate() {
            if covered.is_none_or(|c| c.texels()[y * width + x]) {
                *n = decode([t[0], t[1], t[2]]);
            }
        }
    });
    normals
}

/// Covered texels of floats that are zero or not finite.
#[derive(Debug)]
struct Directionless {
    count: usize,
    first: usize,
}

impl Directionless {
    /// `None` if there are none.
    fn find<S: Space>(raster: &Raster, samples: &[f32], covered: Option<&Grid<bool>>) -> Option<Self> {
        let known = known::<S>(raster, samples);
        let mut bad = known.enumerate().filter(|(i, known)| !known && covered.is_none_or(|c| c.texels()[*i]));
        let (first, _) = bad.next()?;
        Some(Self { count: 1 + bad.count(), first })
    }

    fn reason(&self) -> String {
        let count = self.count;
        format!(
            "{count} texels are zero or not finite, the first one here; `quantize --repair` gives them their nearest neighbour's \
             normal, and alpha 0 takes them out"
        )
    }

    fn warning(&self, raster: &Raster) -> String {
        let (count, place) = (self.count, raster.place(self.first));
        format!(
            "{count} texels were zero or not finite, the first one {place}; they got their nearest neighbour's normal"
        )
    }

    /// `normals` with the holes filled.
    fn repair<S: Space>(
        &self,
        name: &str,
        raster: &Raster,
        samples: &[f32],
        covered: Option<&Grid<bool>>,
        normals: Vec<Normal<S>>,
    ) -> Result<Vec<Normal<S>>> {
        let inside = |i: usize| covered.is_none_or(|c| c.texels()[i]);
        let known: Vec<bool> = known::<S>(raster, samples).enumerate().map(|(i, known)| known && inside(i)).collect();
        if !known.contains(&true) {
            return Err(Error::format(name, "texels", "not one has a direction: there is nothing to repair them from"));
        }
        let mut map = raster.grid(normals);
        spread_normals(&mut map, &raster.grid(known), u32::MAX);
        Ok(map.into_texels())
    }
}

/// Whether each texel has a direction.
fn known<S: Space>(raster: &Raster, samples: &[f32]) -> impl Iterator<Item = bool> {
    samples.chunks_exact(raster.channels()).map(|t| Normal::<S>::new([t[0], t[1], t[2]].into()).is_some())
}
