//! The pixels of one tile while it is drawn.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

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
    pub(super) fn clear(&mut self, background: u32) {
        self.depth.fill([NOTHING; 16]);
        self.color.fill([background; 16]);
        self.farthest.fill([NOTHING; BLOCKS]);
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
    pub(super) fn copy_to(&self, rows: &mut [Rgba8], stride: usize, x: usize) -> u64 {
        let width = TILE.min(stride - x);
        let mut covered = 0;
        for (y, row) in rows.chunks_mut(stride).enumerate().take(TILE) {
            let row: &mut [u32] = bytemuck::cast_slice_mut(&mut row[x..x + width]);
            let blocks = y / BLOCK * BLOCKS..(y / BLOCK + 1) * BLOCKS;
            let line = y % BLOCK * BLOCK;
            // Four pixels at a time: a copy of constant length is an instruction, any other a call.
            let (whole, rest) = row.as_chunks_mut::<BLOCK>();
            let split = whole.len();
            for (pixels, block) in whole.iter_mut().zip(&self.color[blocks.clone()]) {
                *pixels = std::array::from_fn(|i| block[line + i]);
            }
            if let Some(block) = self.color[blocks.clone()].get(split) {
                rest.copy_from_slice(&block[line..line + rest.len()]);
            }
            for (i, block) in self.depth[blocks].iter().enumerate() {
                let inside = width.saturating_sub(i * BLOCK).min(BLOCK);
                covered += block[line..line + inside].iter().map(|&d| u64::from(d != NOTHING)).sum::<u64>();
            }
        }
        covered
    }
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
