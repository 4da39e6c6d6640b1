//! Dithering: neighbours take different entries, so that what a filter or an eye averages is the normal that was meant.
//!
//! A table of a few hundred entries turns smooth curvature into facets of several degrees. Dithering trades them for
//! noise at the frequency of the texels. A texel only ever takes entries of its own material, and gutter keeps its
//! nearest entries: it neither gives errors nor receives them.

mod blue_noise;
mod diffusion;
mod triangles;

use super::entries::{Entries, squared_f64};
use super::nearest::Nearest;
use crate::{Grid, IndexMap};

/// How texels choose their entries.
///
/// - **Accuracy:** errors of single texels grow (the bunny's with 256 entries from 4.20° RMS to 5.78° by diffusion and
///   6.21° by blue noise), as entries farther than the nearest are taken too. After a low-pass of σ = 1 texel they fall
///   to 0.25 × and 0.39 × of those without; with 2048 entries to 0.40 × and 0.75 ×. Both held by
///   `tests/quantize_dither.rs`. Normals beyond the outermost entries stay wrong: nothing averages to them.
/// - **Materials, gutter:** a texel never changes material. Texels that are not covered keep their nearest entries,
///   and no error crosses a border of a material or of gutter.
/// - **Size:** noise does not pack well. The bunny's files grow 3 times with 256 entries, 1.5 times with 2048.
/// - **Determinism:** class A, on any number of threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dither {
    /// The nearest entry: the least error of each texel by itself.
    #[default]
    None,
    /// By error diffusion: the closest averages, on one thread, as each texel depends on those before it.
    Diffusion,
    /// By a blue-noise mask: each texel by itself, so nothing creeps across the map and all cores help.
    BlueNoise,
}

/// Distance of a normal to its entry that is only the rounding of 16 bits (of both, and of unstable codes).
const EXACT: f64 = 1e-4;

/// What both methods read.
struct Source<'a, F> {
    /// The normal of a texel, by its place in the map.
    normal: F,
    covered: Option<&'a Grid<bool>>,
    entries: &'a Entries,
    nearest: &'a Nearest,
    /// Which group (material) each entry belongs to.
    group_of: Vec<u8>,
}

impl<F: Fn(usize) -> [f32; 3] + Sync> Source<'_, F> {
    fn normal(&self, texel: usize) -> [f64; 3] {
        (self.normal)(texel).map(f64::from)
    }

    fn direction(&self, entry: u32) -> [f32; 3] {
        self.entries.directions[entry as usize]
    }

    /// The group of a texel whose nearest entry is `own`; `None` if it keeps that entry.
    ///
    /// Gutter does, and so do normals that stand in the table up to its rounding: flat parts stay flat, whatever is
    /// beside them.
    fn dithered_group(&self, texel: usize, own: u16) -> Option<u8> {
        let is_covered = self.covered.is_none_or(|c| c.texels()[texel]);
        let is_exact = || squared_f64(self.normal(texel), self.direction(own.into())) <= EXACT * EXACT;
        (is_covered && !is_exact()).then(|| self.group_of[usize::from(own)])
    }
}

/// Dithers an index map whose texels have their nearest entries. `normal` gives the normal of a texel.
pub(super) fn dither(
    method: Dither,
    indices: &mut IndexMap,
    normal: impl Fn(usize) -> [f32; 3] + Sync,
    covered: Option<&Grid<bool>>,
    entries: &Entries,
    nearest: &Nearest,
) {
    let group_of = entries.spans.iter().zip(0u8..=255).flat_map(|(span, group)| span.clone().map(move |_| group));
    let source = Source { normal, covered, entries, nearest, group_of: group_of.collect() };
    match method {
        Dither::None => {}
        Dither::Diffusion => diffusion::diffuse(&source, indices),
        Dither::BlueNoise => blue_noise::choose(&source, indices),
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
