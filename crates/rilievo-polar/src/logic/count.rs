//! A data path that is counted.

use core::cell::Cell;
use core::iter::Sum;
use core::ops::Add;

use super::{Logic, Reading};
use crate::rom::{Rom, Sine};

/// The two stages whose cost the paper's Table 1 gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Up to the vectors in reference space ("illumination environment setup").
    SetUp,
    /// From there to the intensity.
    Illumination,
}

/// What a stage is built of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Products of two values.
    pub multipliers: u32,
    /// Sums and differences of values or angles.
    pub adders: u32,
    /// Quotients.
    pub dividers: u32,
    /// Square roots.
    pub roots: u32,
    /// Look-up tables; one that is read by two vectors stands there twice.
    pub tables: u32,
    /// Their bits.
    pub table_bits: u64,
    /// Maps, indexed by vectors instead of scalars.
    pub maps: u32,
    /// Sign changes and reflections of angles, which the paper does not count: inverters and a carry each.
    pub mirrors: u32,
    /// Comparisons of two values, which it does not count either.
    pub comparators: u32,
    /// Shifts by a variable number of places.
    pub shifters: u32,
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            multipliers: self.multipliers + other.multipliers,
            adders: self.adders + other.adders,
            dividers: self.dividers + other.dividers,
            roots: self.roots + other.roots,
            tables: self.tables + other.tables,
            table_bits: self.table_bits + other.table_bits,
            maps: self.maps + other.maps,
            mirrors: self.mirrors + other.mirrors,
            comparators: self.comparators + other.comparators,
            shifters: self.shifters + other.shifters,
        }
    }
}

impl Sum for Cost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), Add::add)
    }
}

/// Counts the operators of a data path. Values carry nothing: what is counted cannot depend on them.
#[derive(Debug)]
pub(crate) struct Count {
    stage: Cell<Stage>,
    costs: [Cell<Cost>; 2],
}

impl Count {
    pub(crate) fn new() -> Self {
        Self { stage: Cell::new(Stage::SetUp), costs: Default::default() }
    }

    /// What was counted in a stage.
    pub(crate) fn cost(&self, stage: Stage) -> Cost {
        self.costs[stage as usize].get()
    }

    fn note(&self, cost: Cost) {
        let cell = &self.costs[self.stage.get() as usize];
        cell.set(cell.get() + cost);
    }

    fn adder(&self) {
        self.note(Cost { adders: 1, ..Cost::default() });
    }
}

impl Logic for Count {
    type Value = ();

    fn stage(&self, stage: Stage) {
        self.stage.set(stage);
    }

    fn add(&self, (): (), (): ()) {
        self.adder();
    }

    fn sub(&self, (): (), (): ()) {
        self.adder();
    }

    fn turn(&self, (): (), (): ()) {
        self.adder();
    }

    fn turn_back(&self, (): (), (): ()) {
        self.adder();
    }

    fn multiply(&self, (): (), (): (), _: u32) {
        self.note(Cost { multipliers: 1, ..Cost::default() });
    }

    fn divide(&self, (): (), (): (), _: u32) {
        self.note(Cost { dividers: 1, ..Cost::default() });
    }

    fn root(&self, (): ()) {
        self.note(Cost { roots: 1, ..Cost::default() });
    }

    fn read<const N: usize>(&self, rom: &Rom, reading: Reading, _: [(); N]) -> [(); N] {
        let bits = 16 * rom.words().len() as u64;
        self.note(match reading {
            Reading::Single | Reading::TwoPorts => Cost { tables: 1, table_bits: bits, ..Cost::default() },
            Reading::TwoWords => Cost { tables: 1, table_bits: 2 * bits, ..Cost::default() },
            Reading::Map => Cost { maps: 1, ..Cost::default() },
        });
        [(); N]
    }

    fn wave<const N: usize>(&self, sine: &Sine, reading: Reading, angles: [(); N]) -> [(); N] {
        self.read(sine.rom(), reading, angles)
    }

    fn mirror(&self, (): (), _: impl Fn(i64) -> i64) {
        self.note(Cost { mirrors: 1, ..Cost::default() });
    }

    fn mirror_by(&self, (): (), (): (), _: impl Fn(i64, i64) -> i64) {
        self.note(Cost { mirrors: 1, ..Cost::default() });
    }

    fn greater(&self, (): (), (): ()) {
        self.note(Cost { comparators: 1, ..Cost::default() });
    }

    fn shift(&self, (): (), (): (), _: impl Fn(i64, i64) -> i64) {
        self.note(Cost { shifters: 1, ..Cost::default() });
    }

    fn gates<const N: usize>(&self, _: [(); N], _: impl Fn([i64; N]) -> i64) {}
}
