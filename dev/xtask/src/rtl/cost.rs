//! What a synthesiser counts, beside what the models count.

use anyhow::{Context, Result, bail};
use rilievo_polar::{LightTables, UnitKind};
use std::collections::BTreeMap;

use super::{Bench, Unit, read};
use crate::run::Run;

/// Cells by kind, and the bits of all memories.
#[derive(Debug, Default, PartialEq)]
struct Statistics {
    cells: BTreeMap<String, u64>,
    memory_bits: u64,
}

/// Multipliers and table bits must be the model's; adders are shown.
pub(super) fn run(bench: &Bench) -> Result<()> {
    eprintln!("                  multipliers         adders           table bits   registers");
    eprintln!("unit            model  Yosys       model  Yosys      model    Yosys");
    for unit in &bench.units {
        let counted = count(bench, unit)?;
        // Without the light's tables, which are the application's.
        let light = LightTables::new(bench.width, LightTables::FULL, LightTables::FULL, 1);
        let light_bits: usize = light.roms().iter().map(|rom| 16 * rom.words().len()).sum();
        let total = unit.model.cost(&light).total();
        let table_bits = total.table_bits - light_bits as u64;
        // The sum of diffuse and specular light is not the hardware's either.
        let adders = u64::from(total.adders) - 1;
        let (multipliers, sums) = (counted.of("$mul"), counted.of("$add") + counted.of("$sub"));
        let registers = counted.of("$dff") + counted.of("$sdff");
        eprintln!(
            "{:<14}  {:>5}  {multipliers:>5}      {adders:>6}  {sums:>5}     {table_bits:>6}   {:>6}  {registers:>10}",
            unit.kind.name(),
            total.multipliers,
            counted.memory_bits
        );
        if multipliers != u64::from(total.multipliers) || counted.memory_bits != table_bits {
            bail!("{}: multipliers or table bits are not the model's", unit.kind);
        }
        if unit.kind == UnitKind::E3
            && bench.width == rilievo_polar::Width::PAPER
            && (multipliers, table_bits) != (6, 40_960)
        {
            bail!("E3 has {multipliers} multipliers and {table_bits} table bits, not 6 and 40960");
        }
    }
    eprintln!(
        "Yosys has more adders: to it, rounding an angle to a step of a table, reading a quarter wave from its other end, 1 + cos and \
         180° less an angle are sums too. The models count them with the table, as gates, or as mirrors."
    );
    Ok(())
}

fn count(bench: &Bench, unit: &Unit) -> Result<Statistics> {
    let top = unit.kind.name();
    let script = format!(
        "{}; hierarchy -check -top {top}; proc; flatten; opt -full; wreduce; opt_clean; stat",
        read(bench, unit)?
    );
    // The tables are found from where it runs.
    let said = Run::new("yosys").current_dir(&bench.folder).arg("-p").arg(script).output()?;
    parse(&said).with_context(|| format!("{top}: yosys printed no statistics"))
}

/// The last statistics of Yosys' output.
fn parse(said: &str) -> Option<Statistics> {
    let (_, last) = said.rsplit_once("Number of wires:")?;
    let mut statistics = Statistics::default();
    for line in last.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [name, count] if name.starts_with('$') => {
                statistics.cells.insert(name.to_owned(), count.parse().ok()?);
            }
            ["Number", "of", "memory", "bits:", count] => statistics.memory_bits = count.parse().ok()?,
            _ => {}
        }
    }
    Some(statistics)
}

impl Statistics {
    fn of(&self, cell: &str) -> u64 {
        self.cells.get(cell).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_read() {
        let said = "noise\n   Number of wires:   3\n   Number of memories:    10\n   Number of memory bits:        40960\n   Number of cells: 7\n     $add      31\n     $mul       6\n";
        let found = parse(said).unwrap();
        assert_eq!((found.of("$mul"), found.of("$add"), found.of("$sub"), found.memory_bits), (6, 31, 0, 40_960));
        assert_eq!(parse("nothing"), None);
    }
}
