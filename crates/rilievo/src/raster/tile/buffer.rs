//! The pixels of one tile while it is drawn.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u32x16};

use super::samples::Samples;
use crate::color::Rgba8;
use crate::simd::{LANES, splat, splat3, srgb_code, srgb_light, three};

/// Pixels along a side of a tile.
pub(super) const TILE: usize = 64;
/// Pixels along a side of a block: what sixteen lanes work on together. (Squares beat rows of sixteen: small and thin triangles
/// leave fewer lanes idle.)
pub(super) const BLOCK: usize = 4;
/// Blocks along a side of a tile.
pub(super) const BLOCKS: usize = TILE / BLOCK;

/// Depth where nothing was drawn.
const NOTHING: f32 = f32::INFINITY;

/// Depth, and a word that is an encoded colour or a number of [`super::visible::Owners`]: block by block, within it sample by
/// sample, within those row by row.
pub(super) struct Tile {
    depth: Vec<Lanes<f32>>,
    words: Vec<Lanes<u32>>,
    /// For each block, no sample lies farther: what is hidden altogether need not be looked at.
    farthest: [Lanes<f32>; BLOCKS],
    samples: usize,
}

/// A row of lanes, where one load gets it.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct Lanes<T>([T; LANES]);

impl Lanes<f32> {
    /// Of depths: where something was drawn.
    #[inline(always)]
    fn drawn<S: Simd>(&self, simd: S) -> u64 {
        f32x16::load_array_ref(simd, &self.0).simd_lt(f32x16::splat(simd, NOTHING)).to_bitmask()
    }
}

impl Tile {
    /// A tile with so many samples a pixel; it is to be cleared first.
    pub(super) fn new(samples: Samples) -> Self {
        let samples = samples.count();
        Self {
            depth: vec![Lanes([NOTHING; LANES]); BLOCKS * BLOCKS * samples],
            words: vec![Lanes([0; LANES]); BLOCKS * BLOCKS * samples],
            farthest: [Lanes([NOTHING; LANES]); BLOCKS],
            samples,
        }
    }

    /// How many samples a pixel has: 1 or 4.
    #[inline(always)]
    pub(super) fn samples(&self) -> usize {
        self.samples
    }

    /// Makes it empty.
    pub(super) fn clear(&mut self, level: Level, background: u32) {
        dispatch!(level, simd => self.clear_lanes(simd, background));
    }

    #[inline(always)]
    fn clear_lanes<S: Simd>(&mut self, simd: S, background: u32) {
        let (nothing, background) = (f32x16::splat(simd, NOTHING), u32x16::splat(simd, background));
        for (depth, words) in self.depth.iter_mut().zip(&mut self.words) {
            nothing.store_array(&mut depth.0);
            background.store_array(&mut words.0);
        }
        for row in &mut self.farthest {
            nothing.store_array(&mut row.0);
        }
    }

    /// Depths of a sample of a block, given by block · samples + sample.
    #[inline(always)]
    pub(super) fn depth<S: Simd>(&self, simd: S, at: usize) -> f32x16<S> {
        f32x16::load_array_ref(simd, &self.depth[at].0)
    }

    /// Writes depths.
    #[inline(always)]
    pub(super) fn set_depth<S: Simd>(&mut self, at: usize, depth: f32x16<S>) {
        depth.store_array(&mut self.depth[at].0);
    }

    /// For the blocks of a row: no sample lies farther.
    #[inline(always)]
    pub(super) fn farthest<S: Simd>(&self, simd: S, by: usize) -> f32x16<S> {
        f32x16::load_array_ref(simd, &self.farthest[by].0)
    }

    /// All samples of a block have become nearer than this.
    #[inline(always)]
    pub(super) fn set_farthest(&mut self, block: usize, farthest: f32) {
        let place = &mut self.farthest[block / BLOCKS].0[block % BLOCKS];
        // Not `min`, which asks for NaN as well.
        if farthest < *place {
            *place = farthest;
        }
    }

    /// Words of a sample of a block, given by block · samples + sample.
    #[inline(always)]
    pub(super) fn word<S: Simd>(&self, simd: S, at: usize) -> u32x16<S> {
        u32x16::load_array_ref(simd, &self.words[at].0)
    }

    /// Writes words.
    #[inline(always)]
    pub(super) fn set_word<S: Simd>(&mut self, at: usize, word: u32x16<S>) {
        word.store_array(&mut self.words[at].0);
    }

    /// Copies the tile into rows of `stride` pixels, the first of which begin at its corner; returns how many pixels
    /// something was drawn on. Samples become one colour first.
    pub(super) fn copy_to(&mut self, level: Level, rows: &mut [Rgba8], stride: usize, x: usize) -> u64 {
        dispatch!(level, simd => {
            if self.samples > 1 {
                self.resolve(simd);
            }
            self.copy_lanes(simd, rows, stride, x)
        })
    }

    /// The mean of the samples of each pixel, in linear light, as the word of its first sample; depth as near as any.
    ///
    /// Empty samples are transparent: they make the pixel so in part, and say nothing of its colour.
    #[inline(always)]
    fn resolve<S: Simd>(&mut self, simd: S) {
        let samples = self.samples;
        for block in 0..BLOCKS * BLOCKS {
            let first = self.word(simd, block * samples);
            let mut differs = u32x16::splat(simd, 0);
            let mut nearest = self.depth(simd, block * samples);
            for at in block * samples + 1..(block + 1) * samples {
                differs |= self.word(simd, at) ^ first;
                nearest = nearest.min(self.depth(simd, at));
            }
            self.set_depth(block * samples, nearest);
            if differs.simd_eq(u32x16::splat(simd, 0)).all_true() {
                continue;
            }
            let mut sum = splat3(simd, [0.0; 3]);
            let mut opaque = splat(simd, 0.0);
            for at in block * samples..(block + 1) * samples {
                let word = self.word(simd, at);
                let solid = (word >> 24).simd_gt(u32x16::splat(simd, 0)).select(splat(simd, 1.0), splat(simd, 0.0));
                let light = three!(k => srgb_light(simd, (word >> (8 * k as u32)) & 0xff));
                sum = three!(k => light[k].mul_add(solid, sum[k]));
                opaque += solid;
            }
            let share = 1.0 / opaque.max(splat(simd, 1.0));
            let [r, g, b] = three!(k => srgb_code(simd, sum[k] * share));
            let alpha = (opaque * (255.0 / samples as f32) + 0.5).to_int::<u32x16<S>>();
            let mean = r | (g << 8) | (b << 16) | (alpha << 24);
            // Nothing at all is all zeros, as it was.
            let mean = opaque.simd_gt(splat(simd, 0.0)).select(mean, u32x16::splat(simd, 0));
            self.set_word(block * samples, mean);
        }
    }

    #[inline(always)]
    fn copy_lanes<S: Simd>(&self, simd: S, rows: &mut [Rgba8], stride: usize, x: usize) -> u64 {
        let width = TILE.min(stride - x);
        let height = TILE.min(rows.len() / stride);
        let samples = self.samples;
        for (y, row) in rows.chunks_exact_mut(stride).enumerate().take(TILE) {
            let row: &mut [u32] = bytemuck::cast_slice_mut(&mut row[x..x + width]);
            let blocks = self.words[y / BLOCK * BLOCKS * samples..].chunks_exact(samples);
            let line = y % BLOCK * BLOCK;
            for (pixels, block) in row.chunks_mut(BLOCK).zip(blocks) {
                let block = &block[0].0;
                // Four pixels at a time: a copy of constant length is an instruction, any other a call.
                match pixels.first_chunk_mut::<BLOCK>() {
                    Some(four) => *four = [block[line], block[line + 1], block[line + 2], block[line + 3]],
                    None => pixels.copy_from_slice(&block[line..line + pixels.len()]),
                }
            }
        }
        let mut covered = 0;
        if [width, height] == [TILE, TILE] {
            for depth in self.depth.iter().step_by(samples) {
                covered += depth.drawn(simd).count_ones();
            }
            return u64::from(covered);
        }
        for (i, depth) in self.depth.iter().step_by(samples).enumerate() {
            // At the right and lower border of the picture, blocks reach beyond it.
            let (columns, lines) =
                (width.saturating_sub(i % BLOCKS * BLOCK), height.saturating_sub(i / BLOCKS * BLOCK));
            covered += (depth.drawn(simd) & pixels_within(columns, lines)).count_ones();
        }
        u64::from(covered)
    }
}

/// The pixels of a block within its first `columns` and `lines`, a bit for each.
fn pixels_within(columns: usize, lines: usize) -> u64 {
    let (columns, lines) = (columns.min(BLOCK), lines.min(BLOCK));
    let row = (1 << columns) - 1;
    (0x1111 * row) & ((1 << (lines * BLOCK)) - 1)
}

/// A pixel as [`Tile`] keeps it.
pub(super) fn word(color: Rgba8) -> u32 {
    u32::from_le_bytes([color.r, color.g, color.b, color.a])
}
