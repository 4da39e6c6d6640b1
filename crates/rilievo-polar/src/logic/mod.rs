//! What data paths are made of, and what can be done with one.
//!
//! A unit is written once, over the operators of [`Logic`]. [`Numbers`] runs it, [`Count`] counts what it is made of:
//! a unit's cost is that of the very structure whose results are checked, not a list beside it.

mod blocks;
mod count;
mod numbers;

pub(crate) use blocks::*;
pub(crate) use count::Count;
pub use count::{Cost, Stage};
pub(crate) use numbers::Numbers;

use crate::rom::{Rom, Sine};

/// How a table is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reading {
    /// Once.
    Single,
    /// Twice, through the two ports of one memory.
    TwoPorts,
    /// Two words side by side at one address: twice the bits.
    TwoWords,
    /// A map: addressed by vectors, not scalars.
    Map,
}

/// The operators of a data path.
///
/// Angles are binary (a turn is 2¹⁶, so sums wrap as they should), values Q2.14 unless a unit says otherwise.
pub(crate) trait Logic {
    /// What runs along a wire.
    type Value: Copy;

    /// From here on, what is counted belongs to a stage.
    fn stage(&self, stage: Stage);

    /// A sum, a difference: an adder.
    fn add(&self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn sub(&self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// The same of angles, modulo a turn.
    fn turn(&self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn turn_back(&self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// A product, shifted right, rounded down: a multiplier.
    fn multiply(&self, a: Self::Value, b: Self::Value, shift: u32) -> Self::Value;
    /// `a · 2^shift / b`, rounded towards zero, 0 if `b` is: a divider.
    fn divide(&self, a: Self::Value, b: Self::Value, shift: u32) -> Self::Value;
    /// The root, rounded down: a root extractor.
    fn root(&self, a: Self::Value) -> Self::Value;
    /// Words of a table.
    fn read<const N: usize>(&self, rom: &Rom, reading: Reading, addresses: [Self::Value; N]) -> [Self::Value; N];
    /// Sines of angles, from a quarter wave. Folding and rounding the address belong to the table.
    fn wave<const N: usize>(&self, sine: &Sine, reading: Reading, angles: [Self::Value; N]) -> [Self::Value; N];
    /// A mirror image of a value or an angle if a condition holds: inverters and a carry.
    fn mirror(&self, a: Self::Value, f: impl Fn(i64) -> i64) -> Self::Value;
    fn mirror_by(&self, a: Self::Value, by: Self::Value, f: impl Fn(i64, i64) -> i64) -> Self::Value;
    /// Whether `a > b`: a comparator.
    fn greater(&self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// A shift by a number that is not known beforehand, and the search for a leading one.
    fn shift(&self, a: Self::Value, by: Self::Value, f: impl Fn(i64, i64) -> i64) -> Self::Value;
    /// Wires, gates and multiplexers: counted as nothing.
    fn gates<const N: usize>(&self, a: [Self::Value; N], f: impl Fn([i64; N]) -> i64) -> Self::Value;
}
