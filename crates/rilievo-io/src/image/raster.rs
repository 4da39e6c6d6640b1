//! What every decoder hands over: samples as they are stored.

use rilievo::Grid;

use crate::error::{Error, Result};

/// How the samples of a map were stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Depth {
    /// Up to 8 bits: steps of 1/255 at best.
    U8,
    /// 16 bits.
    U16,
    /// Floats of 16, 32 or 64 bits.
    F32,
}

/// The samples of all texels, interleaved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Samples {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// A picture as it is stored: gray (1 channel), gray + alpha (2), RGB (3) or RGBA (4).
///
/// Its size has passed the limits, and its samples fill it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Raster {
    size: (u32, u32),
    channels: usize,
    samples: Samples,
}

impl Raster {
    /// Wraps samples; fails if they do not fill the size, which no decoder should let happen.
    pub(crate) fn new(name: &str, size: (u32, u32), channels: usize, samples: Samples) -> Result<Self> {
        let expected = rilievo::grid::check_size(size.0.into(), size.1.into()).map_err(|e| Error::invalid(name, e))?;
        let raster = Self { size, channels, samples };
        let (expected, actual) = (expected * channels, raster.len());
        if !(1..=4).contains(&channels) || actual != expected {
            return Err(Error::format(name, "texels", format!("{actual} samples where {expected} belong")));
        }
        Ok(raster)
    }

    fn len(&self) -> usize {
        match &self.samples {
            Samples::U8(v) => v.len(),
            Samples::U16(v) => v.len(),
            Samples::F32(v) => v.len(),
        }
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        self.size
    }

    pub(crate) fn channels(&self) -> usize {
        self.channels
    }

    pub(crate) fn samples(&self) -> &Samples {
        &self.samples
    }

    pub(crate) fn depth(&self) -> Depth {
        match self.samples {
            Samples::U8(_) => Depth::U8,
            Samples::U16(_) => Depth::U16,
            Samples::F32(_) => Depth::F32,
        }
    }

    pub(crate) fn has_color(&self) -> bool {
        self.channels >= 3
    }

    fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// The place of texel `i` in a message.
    pub(crate) fn place(&self, i: usize) -> String {
        let width = self.size.0 as usize;
        format!("texel ({}, {})", i % width, i / width)
    }

    /// Where alpha is above zero; `None` if that is everywhere.
    pub(crate) fn covered(&self) -> Option<Grid<bool>> {
        if !self.has_alpha() {
            return None;
        }
        fn above_zero<T: Copy + PartialOrd + Default>(v: &[T], channels: usize) -> Vec<bool> {
            v.chunks_exact(channels).map(|t| t[channels - 1] > T::default()).collect()
        }
        let covered = match &self.samples {
            Samples::U8(v) => above_zero(v, self.channels),
            Samples::U16(v) => above_zero(v, self.channels),
            Samples::F32(v) => above_zero(v, self.channels),
        };
        if covered.iter().all(|&c| c) {
            return None;
        }
        Some(self.grid(covered))
    }

    /// A grid of this size.
    ///
    /// # Panics
    /// If there is not one value per texel.
    pub(crate) fn grid<T>(&self, texels: Vec<T>) -> Grid<T> {
        Grid::new(self.size.0, self.size.1, texels).expect("invariant: one value per texel of a checked size")
    }

    /// The first texel whose red, green and blue differ.
    pub(crate) fn first_colored(&self) -> Option<usize> {
        fn first<T: PartialEq>(v: &[T], channels: usize) -> Option<usize> {
            v.chunks_exact(channels).position(|t| t[0] != t[1] || t[1] != t[2])
        }
        if !self.has_color() {
            return None;
        }
        match &self.samples {
            Samples::U8(v) => first(v, self.channels),
            Samples::U16(v) => first(v, self.channels),
            // NaN differs from itself, but is not a colour.
            Samples::F32(v) => v.chunks_exact(self.channels).position(|t| {
                let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
                !(same(t[0], t[1]) && same(t[1], t[2]))
            }),
        }
    }
}
