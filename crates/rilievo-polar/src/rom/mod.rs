//! Tables of 16-bit words: what the data paths look up instead of computing.

pub(crate) mod exact;
mod sine;
mod tables;

pub(crate) use sine::Sine;

use alloc::vec::Vec;
use core::fmt;

/// How many address bits tables have: 2^width entries a quarter wave.
///
/// Eight is the paper's. Below four a table is no table; above fourteen it would have more entries than a quarter
/// turn of a 16-bit angle has values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Width(u32);

impl Width {
    /// The width of the paper's tables: 256 entries.
    pub const PAPER: Self = Self(8);
    /// The fewest and the most address bits.
    pub const RANGE: core::ops::RangeInclusive<u32> = 4..=14;

    /// A width in address bits.
    ///
    /// # Errors
    /// [`WidthError`] outside 4 to 14.
    pub const fn new(bits: u32) -> Result<Self, WidthError> {
        if bits < *Self::RANGE.start() || bits > *Self::RANGE.end() { Err(WidthError(bits)) } else { Ok(Self(bits)) }
    }

    /// Address bits.
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Entries of a table, 2^width.
    pub const fn entries(self) -> usize {
        1 << self.0
    }
}

/// A table width that no unit can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WidthError(pub u32);

impl fmt::Display for WidthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(bits) = self;
        let why = if *bits < *Width::RANGE.start() {
            "the logarithmic address of the arc tangent alone takes 4 bits"
        } else {
            "a quarter turn of a 16-bit angle has no more than 2^14 values"
        };
        write!(f, "tables of 2^{bits} entries cannot be built: widths are 4 to 14 bits, since {why}")
    }
}

impl core::error::Error for WidthError {}

/// A table of 16-bit words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rom {
    name: &'static str,
    words: Vec<u16>,
}

impl Rom {
    pub(crate) fn new(name: &'static str, words: impl Iterator<Item = u16>) -> Self {
        Self { name, words: words.collect() }
    }

    /// What it holds, as files are named.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Its words, by address.
    pub fn words(&self) -> &[u16] {
        &self.words
    }

    /// Address bits: its length is a power of two.
    pub(crate) fn address_bits(&self) -> u32 {
        self.words.len().ilog2()
    }
}

/// Fractional bits of values: Q2.14.
pub const FRACTION: u32 = 14;
/// One, in Q2.14.
pub const ONE: i64 = 1 << FRACTION;
/// A quarter turn of a 16-bit binary angle.
pub const QUARTER: i64 = 1 << 14;
/// Half a turn.
pub const HALF: i64 = 1 << 15;
/// Fractional bits of reciprocals: Q6.10, at most just below 64.
pub(crate) const RECIPROCAL_FRACTION: u32 = 10;
