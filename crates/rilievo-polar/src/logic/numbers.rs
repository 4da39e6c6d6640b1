//! A data path that is run.

use super::{Logic, Reading, Stage};
use crate::rom::{Rom, Sine};

/// Runs a data path on whole numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers;

impl Logic for Numbers {
    type Value = i64;

    #[inline(always)]
    fn stage(&self, _: Stage) {}

    #[inline(always)]
    fn add(&self, a: i64, b: i64) -> i64 {
        a + b
    }

    #[inline(always)]
    fn sub(&self, a: i64, b: i64) -> i64 {
        a - b
    }

    #[inline(always)]
    fn turn(&self, a: i64, b: i64) -> i64 {
        (a + b) & 0xffff
    }

    #[inline(always)]
    fn turn_back(&self, a: i64, b: i64) -> i64 {
        (a - b) & 0xffff
    }

    #[inline(always)]
    fn multiply(&self, a: i64, b: i64, shift: u32) -> i64 {
        (a * b) >> shift
    }

    #[inline(always)]
    fn divide(&self, a: i64, b: i64, shift: u32) -> i64 {
        (a << shift).checked_div(b).unwrap_or(0)
    }

    #[inline(always)]
    fn root(&self, a: i64) -> i64 {
        a.max(0).isqrt()
    }

    #[inline(always)]
    fn read<const N: usize>(&self, rom: &Rom, _: Reading, addresses: [i64; N]) -> [i64; N] {
        addresses.map(|address| i64::from(rom.words()[address as usize]))
    }

    #[inline(always)]
    fn wave<const N: usize>(&self, sine: &Sine, _: Reading, angles: [i64; N]) -> [i64; N] {
        angles.map(|angle| sine.at(angle))
    }

    #[inline(always)]
    fn mirror(&self, a: i64, f: impl Fn(i64) -> i64) -> i64 {
        f(a)
    }

    #[inline(always)]
    fn mirror_by(&self, a: i64, by: i64, f: impl Fn(i64, i64) -> i64) -> i64 {
        f(a, by)
    }

    #[inline(always)]
    fn greater(&self, a: i64, b: i64) -> i64 {
        i64::from(a > b)
    }

    #[inline(always)]
    fn shift(&self, a: i64, by: i64, f: impl Fn(i64, i64) -> i64) -> i64 {
        f(a, by)
    }

    #[inline(always)]
    fn gates<const N: usize>(&self, a: [i64; N], f: impl Fn([i64; N]) -> i64) -> i64 {
        f(a)
    }
}
