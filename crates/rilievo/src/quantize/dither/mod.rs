//! Dithering: neighbours take different entries, so that what a filter or an eye averages is the normal that was meant.
//!
//! A table of a few hundred entries turns smooth curvature into facets of several degrees. Dithering trades them for
//! noise at the frequency of the texels. A texel only ever takes entries of its own material, and gutter keeps its
//! nearest entries: it neither gives errors nor receives them.

mod blue_noise;
mod diffusion;
mod triangles;

use self::diffusion::Diffusion;
use self::triangles::Triangles;
use super::entries::{Entries, squared_f64};
use super::index::Rows;
use super::nearest::Nearest;
use crate::IndexMap;

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
struct Table<'a> {
    entries: &'a Entries,
    nearest: &'a Nearest,
    /// Which group (material) each entry belongs to.
    group_of: Vec<u8>,
}

impl Table<'_> {
    fn direction(&self, entry: u32) -> [f32; 3] {
        self.entries.directions[entry as usize]
    }

    /// The group of texel `i` of `rows` whose nearest entry is `own`; `None` if it keeps that entry.
    ///
    /// Gutter does, and so do normals that stand in the table up to its rounding: flat parts stay flat, whatever is
    /// beside them.
    fn dithered_group(&self, rows: &Rows<'_>, i: usize, own: u16) -> Option<u8> {
        let is_exact = || squared_f64(rows.direction(i), self.direction(own.into())) <= EXACT * EXACT;
        (rows.is_covered(i) && !is_exact()).then(|| self.group_of[usize::from(own)])
    }
}

/// Dithers an index map whose rows come from the top and whose texels have their nearest entries.
pub(super) struct Ditherer<'a> {
    table: Table<'a>,
    method: Method,
}

enum Method {
    None,
    Diffusion(Diffusion),
    BlueNoise(Triangles),
}

impl<'a> Ditherer<'a> {
    pub(super) fn new(method: Dither, size: (u32, u32), entries: &'a Entries, nearest: &'a Nearest) -> Self {
        let table = Table { entries, nearest, group_of: entries.groups() };
        let method = match method {
            Dither::None => Method::None,
            Dither::Diffusion => Method::Diffusion(Diffusion::new(size, &table)),
            Dither::BlueNoise => Method::BlueNoise(Triangles::new(entries, nearest)),
        };
        Self { table, method }
    }

    /// Takes the next rows; tells `done` of rows whose entries will not change any more, and of these entries.
    pub(super) fn push(&mut self, rows: &Rows<'_>, indices: &mut IndexMap, done: &mut dyn FnMut(Rows<'_>, &[u16])) {
        let width = indices.width() as usize;
        let texels = indices.texels_mut();
        let own = rows.first..rows.first + rows.normals.len();
        match &mut self.method {
            Method::None => {}
            Method::Diffusion(diffusion) => return diffusion.push(&self.table, rows, texels, done),
            Method::BlueNoise(triangles) => {
                blue_noise::choose(&self.table, triangles, rows, width, &mut texels[own.clone()]);
            }
        }
        done(*rows, &texels[own]);
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
