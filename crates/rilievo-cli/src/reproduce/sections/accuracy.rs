//! Accuracy against cost of all units.

use anyhow::Result;
use rilievo::Progress;
use rilievo::polar::{
    ErrorStats, Frame, LightSampling, LightTables, Model, PixelSampling, UnitErrors, UnitKind, Width, unit_errors,
};

use super::unit_key;
use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};
use crate::reproduce::page::{Axis, Plot, Series};

/// Table widths that are measured.
const BITS: [u32; 6] = [4, 6, 8, 10, 12, 14];
/// Units whose tables can be counted and have any width, as lines.
const LINES: [UnitKind; 7] =
    [UnitKind::Published, UnitKind::ExactZ, UnitKind::E1, UnitKind::E2, UnitKind::E3, UnitKind::E4, UnitKind::E4d];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let pixels = PixelSampling { count: if kit.quick { 5_000 } else { 50_000 }, ..PixelSampling::default() };
    let light = LightSampling { width: Width::PAPER, exponents: &[] };
    let tables = LightTables::new(Width::PAPER, LightTables::FULL, LightTables::FULL, 20);
    let mut found = Findings::default();
    found.paper(
        "The hardware is compared by the number of its parts; what accuracy they buy is not measured, and all tables have 256 words.",
    );
    found.here(format!(
        "Each unit's integer model against exact arithmetic on the same words: RMS error of N'·L' and N'·H' over {} random pixels, bump vectors up to the horizon, for tables of 2⁴ to 2¹⁴ \
         words. Bits are the unit's own tables, folded by symmetry, with the light's, one of 256 words for each inner product. Kim's are not known.",
        pixels.count
    ));
    kit.bars.begin("units and widths", (UnitKind::ALL.len() + LINES.len() * (BITS.len() - 1)) as u64);
    let measure = |unit, width| -> Result<UnitErrors> {
        let errors = unit_errors(unit, width, light, &pixels)?;
        kit.bars.advance(1);
        Ok(errors)
    };
    let mut by_bits = Vec::new();
    let columns = ["unit", "×", "+", "LUT", "RMS error", "largest", "limit"].map(Column::here);
    let caption =
        "All parts of a unit and its errors, tables of 256 words. The limit follows from the word lengths alone.";
    let mut table = Table::new(caption, columns.to_vec());
    let mut by_multipliers = Vec::new();
    for unit in UnitKind::ALL {
        let key = unit_key(unit);
        let cost = |width| Model::new(unit, width, Frame::default()).cost(&tables).total();
        let errors = measure(unit, Width::PAPER)?;
        let ErrorStats { rms, max, .. } = errors.products;
        found.figure(format!("{key}_rms"), rms);
        found.figure(format!("{key}_max"), max);
        let limit = errors.limit.map_or("–".to_owned(), |limit| format!("{limit:.4}"));
        let parts = cost(Width::PAPER);
        let counts = [parts.multipliers, parts.adders, parts.tables].map(|n| n.to_string());
        let mut cells = vec![unit.name().to_owned()];
        cells.extend(counts);
        cells.extend([format!("{rms:.4}"), format!("{max:.4}"), limit]);
        table.row(cells);
        by_multipliers.push(Series::point(unit.name(), [f64::from(parts.multipliers), rms]));
        if LINES.contains(&unit) {
            let mut points = Vec::new();
            for bits in BITS {
                let width = Width::new(bits)?;
                let rms = if width == Width::PAPER { rms } else { measure(unit, width)?.products.rms };
                points.push([cost(width).table_bits as f64, rms]);
            }
            by_bits.push(Series::measured(unit.name(), points));
        }
    }
    found.show(table);
    let caption = "Accuracy against multipliers: RMS error of an inner product, tables of 256 words. Down and to the left is better. \
         Peercy's unit has no tables of its own, but nine dividers and three roots besides.";
    found.show(Plot::new(caption, Axis::linear("multipliers"), Axis::decades("RMS error"), by_multipliers));
    let caption = "Accuracy against table bits: the same error with tables of 2⁴, 2⁶ … 2¹⁴ words. Exact methods gain with every bit until 16-bit words are the limit; the published method does not.";
    found.show(Plot::new(caption, Axis::doublings("table bits"), Axis::decades("RMS error"), by_bits));
    found.remark(
        "E3 stands alone in the lower left: six multipliers, and only its tables err. E4 trades accuracy near the horizon, where an arc sine is steep, for two multipliers; E4d has \
         two, for one distant light. No table makes the published unit or the one with exact Z better: their error is the method's. Kim's unit is as accurate as E1, at 37 multipliers.",
    );
    Ok(found)
}
