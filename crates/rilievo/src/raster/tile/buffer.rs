//! The pixels of one tile while it is drawn.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u32x16};

use crate::color::Rgba8;

/// Pixels along a side of a tile.
pub(super) const TILE: usize = 64;
/// Pixels along a side of a block: what sixteen lanes work on together. (Squares beat rows of sixteen: small and thin triangles
/// leave fewer lanes idle.)
pub(super) const BLOCK: usize = 4;
/// Blocks along a side of a tile.
pub(super) const BLOCKS: usize = TILE / BLOCK;

/// Depth where nothing was drawn.
const NOTHING: f32 = f32::INFINITY;

/// Depth and encoded colour, block by block, and within a block row by row.
#[repr(C, align(64))]
pub(super) struct Tile {
    depth: [[f32; BLOCK * BLOCK]; BLOCKS * BLOCKS],
    color: [[u32; BLOCK * BLOCK]; BLOCKS * BLOCKS],
    /// For each block, no pixel lies farther: what is hidden altogether need not be looked at.
    farthest: [[f32; BLOCKS]; BLOCKS],
}

impl Tile {
    /// A tile on which nothing was drawn yet.
    pub(super) fn new(background: u32) -> Self {
        Self {
            depth: [[NOTHING; 16]; BLOCKS * BLOCKS],
            color: [[background; 16]; BLOCKS * BLOCKS],
            farthest: [[NOTHING; BLOCKS]; BLOCKS],
        }
    }

    /// Makes it empty again.
    pub(super) fn clear(&mut self, level: Level, background: u32) {
        dispatch!(level, simd => self.clear_lanes(simd, background));
    }

    #[inline(always)]
    fn clear_lanes<S: Simd>(&mut self, simd: S, background: u32) {
        let (nothing, background) = (f32x16::splat(simd, NOTHING), u32x16::splat(simd, background));
        for (depth, color) in self.depth.iter_mut().zip(&mut self.color) {
            nothing.store_array(depth);
            background.store_array(color);
        }
        for row in &mut self.farthest {
            nothing.store_array(row);
        }
    }

    /// Depths of a block.
    #[inline(always)]
    pub(super) fn depth<S: Simd>(&self, simd: S, block: usize) -> f32x16<S> {
        f32x16::load_array_ref(simd, &self.depth[block])
    }

    /// Writes the depths of a block; `farthest` if all of its pixels have become nearer than that.
    #[inline(always)]
    pub(super) fn set_depth<S: Simd>(&mut self, block: usize, depth: f32x16<S>, farthest: Option<f32>) {
        depth.store_array(&mut self.depth[block]);
        if let Some(farthest) = farthest {
            let place = &mut self.farthest[block / BLOCKS][block % BLOCKS];
            *place = place.min(farthest);
        }
    }

    /// For the blocks of a row: no pixel lies farther.
    #[inline(always)]
    pub(super) fn farthest<S: Simd>(&self, simd: S, by: usize) -> f32x16<S> {
        f32x16::load_array_ref(simd, &self.farthest[by])
    }

    /// Colours of a block.
    #[inline(always)]
    pub(super) fn color<S: Simd>(&self, simd: S, block: usize) -> u32x16<S> {
        u32x16::load_array_ref(simd, &self.color[block])
    }

    /// Writes the colours of a block.
    #[inline(always)]
    pub(super) fn set_color<S: Simd>(&mut self, block: usize, color: u32x16<S>) {
        color.store_array(&mut self.color[block]);
    }

    /// Copies the tile into rows of `stride` pixels, the first of which begin at its corner; returns how many pixels
    /// something was drawn on.
    pub(super) fn copy_to(&self, level: Level, rows: &mut [Rgba8], stride: usize, x: usize) -> u64 {
        dispatch!(level, simd => self.copy_lanes(simd, rows, stride, x))
    }

    #[inline(always)]
    fn copy_lanes<S: Simd>(&self, simd: S, rows: &mut [Rgba8], stride: usize, x: usize) -> u64 {
        let width = TILE.min(stride - x);
        let height = TILE.min(rows.len() / stride);
        for (y, row) in rows.chunks_exact_mut(stride).enumerate().take(TILE) {
            let row: &mut [u32] = bytemuck::cast_slice_mut(&mut row[x..x + width]);
            let blocks = &self.color[y / BLOCK * BLOCKS..][..BLOCKS];
            let line = y % BLOCK * BLOCK;
            // Four pixels at a time: a copy of constant length is an instruction, any other a call.
            let (whole, rest) = row.as_chunks_mut::<BLOCK>();
            let split = whole.len();
            for (pixels, block) in whole.iter_mut().zip(blocks) {
                *pixels = [block[line], block[line + 1], block[line + 2], block[line + 3]];
            }
            if let Some(block) = blocks.get(split) {
                rest.copy_from_slice(&block[line..line + rest.len()]);
            }
        }
        let mut covered = 0;
        for (i, depth) in self.depth.iter().enumerate() {
            let drawn = f32x16::load_array_ref(simd, depth).simd_lt(f32x16::splat(simd, NOTHING)).to_bitmask();
            // At the right and lower border of the picture, blocks reach beyond it.
            let (columns, lines) =
                (width.saturating_sub(i % BLOCKS * BLOCK), height.saturating_sub(i / BLOCKS * BLOCK));
            covered += u64::from((drawn & pixels_within(columns, lines)).count_ones());
        }
        covered
    }
}

/// The pixels of a block within its first `columns` and `lines`, a bit for each.
fn pixels_within(columns: usize, lines: usize) -> u64 {
    let (columns, lines) = (columns.min(BLOCK), lines.min(BLOCK));
    let row = (1 << columns) - 1;
    (0x1111 * row) & ((1 << (lines * BLOCK)) - 1)
}

/// An opaque pixel, as it lies in memory.
#[inline(always)]
pub(super) fn pack<S: Simd>(simd: S, [r, g, b]: [u32x16<S>; 3]) -> u32x16<S> {
    let opaque = u32x16::splat(simd, u32::from_le_bytes([0, 0, 0, 255]));
    r | (g << 8) | (b << 16) | opaque
}

/// A pixel as [`Tile`] keeps it.
pub(super) fn word(color: Rgba8) -> u32 {
    u32::from_le_bytes([color.r, color.g, color.b, color.a])
}
