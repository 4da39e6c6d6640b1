//! What is quantised: normals, or the 24-bit colours that stand for them.

use std::borrow::Cow;
use std::ops::Range;

use crate::normal::{Bare, decode_u8};
use crate::{Grid, Normal, NormalMap, Result, Space, par};

/// A normal map to quantise, in the form it is at hand. `&NormalMap` and `&Grid<[u8; 3]>` turn into it by themselves.
#[derive(Debug)]
pub enum Texels<'a, S> {
    /// Unit vectors.
    Normals(&'a NormalMap<S>),
    /// 24-bit colours, read by [`decode_u8`] (+Y up). The result is that of the decoded map to the bit, in less time:
    /// a bitmap of all 2²⁴ colours finds the distinct ones.
    Rgb8(&'a Grid<[u8; 3]>),
}

impl<S> Clone for Texels<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Texels<'_, S> {}

impl<'a, S> From<&'a NormalMap<S>> for Texels<'a, S> {
    fn from(map: &'a NormalMap<S>) -> Self {
        Self::Normals(map)
    }
}

impl<'a, S> From<&'a Grid<[u8; 3]>> for Texels<'a, S> {
    fn from(codes: &'a Grid<[u8; 3]>) -> Self {
        Self::Rgb8(codes)
    }
}

impl<'a, S: Space> Texels<'a, S> {
    /// Width and height in texels.
    pub(super) fn size(&self) -> (u32, u32) {
        match self {
            Self::Normals(map) => map.size(),
            Self::Rgb8(codes) => codes.size(),
        }
    }

    /// Checks that a mask or another map has the same size.
    pub(super) fn expect_same_size<T>(&self, what: &'static str, other: &Grid<T>) -> Result<()> {
        match self {
            Self::Normals(map) => map.expect_same_size(what, other),
            Self::Rgb8(codes) => codes.expect_same_size(what, other),
        }
    }

    /// The same without their label, row after row.
    pub(super) fn source(&self) -> Source<'a> {
        match self {
            Self::Normals(map) => Source::Normals(Normal::relabel_all(map.texels())),
            Self::Rgb8(codes) => Source::Rgb8(codes.texels()),
        }
    }
}

/// [`Texels`] in reading order.
#[derive(Debug, Clone, Copy)]
pub(super) enum Source<'a> {
    Normals(&'a [Bare]),
    Rgb8(&'a [[u8; 3]]),
}

impl<'a> Source<'a> {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Normals(normals) => normals.len(),
            Self::Rgb8(codes) => codes.len(),
        }
    }

    /// The normal of a texel.
    pub(super) fn normal(&self, texel: usize) -> Bare {
        match self {
            Self::Normals(normals) => normals[texel],
            Self::Rgb8(codes) => decode_u8(codes[texel]),
        }
    }

    /// Some texels as unit vectors.
    pub(super) fn decoded(&self, texels: Range<usize>) -> Cow<'a, [Bare]> {
        match self {
            Self::Normals(normals) => Cow::Borrowed(&normals[texels]),
            Self::Rgb8(codes) => Cow::Owned(decode_all(&codes[texels])),
        }
    }
}

/// Normals of colours.
pub(super) fn decode_all(codes: &[[u8; 3]]) -> Vec<Bare> {
    par::map_range(codes.len(), |i| decode_u8(codes[i]))
}
