//! Where in a pixel the renderer looks.

use crate::fill::SUBPIXEL_BITS;

/// How many places of a pixel are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Samples {
    /// Its centre.
    #[default]
    One,
    /// Four places: smooth outlines. Each surface that is seen at one of them is shaded once, at the centre of the pixel, and
    /// the four colours are averaged in linear light.
    Four,
}

impl Samples {
    /// How many there are.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }

    /// How far they lie from the centre at most, along each axis, in sub-pixels.
    pub(super) fn reach(self) -> i32 {
        match self {
            Self::One => 0,
            Self::Four => 3 * EIGHTH,
        }
    }
}

const EIGHTH: i32 = 1 << (SUBPIXEL_BITS - 3);

/// The places, in sub-pixels from the centre: a grid turned so that no two share a row or a column, and edges near either axis
/// pass them one by one.
#[inline(always)]
pub(super) const fn places<const SAMPLES: usize>() -> [[i32; 2]; SAMPLES] {
    let turned = [[-1, -3], [3, -1], [-3, 1], [1, 3]];
    let mut places = [[0; 2]; SAMPLES];
    if SAMPLES > 1 {
        let mut i = 0;
        while i < SAMPLES {
            places[i] = [turned[i][0] * EIGHTH, turned[i][1] * EIGHTH];
            i += 1;
        }
    }
    places
}
