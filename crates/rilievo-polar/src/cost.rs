//! What units are built of: counted from their own data paths, or quoted where a text gives a number and no structure.

use crate::logic::Cost;

/// The cost of a stage and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageCost {
    /// The cost.
    pub cost: Cost,
    /// Whether it is the printed number, Table 1 of the paper, because the text does not determine a structure.
    pub quoted: bool,
}

impl StageCost {
    pub(crate) const fn counted(cost: Cost) -> Self {
        Self { cost, quoted: false }
    }

    const fn quoted(multipliers: u32, adders: u32, tables: u32, maps: u32) -> Self {
        let cost = Cost {
            multipliers,
            adders,
            tables,
            maps,
            dividers: 0,
            roots: 0,
            table_bits: 0,
            mirrors: 0,
            comparators: 0,
            shifters: 0,
        };
        Self { cost, quoted: true }
    }
}

/// Kim's set-up.
pub(crate) const KIM_SET_UP: StageCost = StageCost::quoted(31, 18, 6, 0);
/// Kugler's set-up: its map has 32 KB.
pub(crate) const KUGLER_SET_UP: StageCost = StageCost::quoted(5, 2, 3, 1);
/// Kugler's illumination: its maps have 1 MB each.
pub(crate) const KUGLER_ILLUMINATION: StageCost = StageCost::quoted(8, 4, 5, 2);

/// The cost of a unit, as the paper's Table 1 divides it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnitCost {
    /// To the vectors in reference space.
    pub set_up: StageCost,
    /// From there to the intensity, light tables included.
    pub illumination: StageCost,
}

impl UnitCost {
    /// Both stages.
    pub fn total(&self) -> Cost {
        self.set_up.cost + self.illumination.cost
    }
}

/// A row of the paper's Table 1 that speaks of the same unit, to print beside what is counted: multipliers, adders,
/// tables of set-up and of illumination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Printed {
    /// Multipliers, adders, tables of the set-up.
    pub set_up: [u32; 3],
    /// Multipliers, adders, tables of the illumination; the table has none for Peercy, whose row Ernst's completes.
    pub illumination: [u32; 3],
}
