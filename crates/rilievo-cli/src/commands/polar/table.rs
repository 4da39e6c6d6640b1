//! `rilievo polar table`: what the units are built of.

use anyhow::Result;
use rilievo::polar::{Cost, Frame, LightTables, Model, StageCost, UnitKind};
use serde_json::{Value, json};

use super::rows::Rows;
use crate::args::TableBitsArg;
use crate::exit;

const AFTER_HELP: &str = "\
Examples:
  rilievo polar table
  rilievo polar table --gates                      also what the paper does not count
  rilievo polar table --json --table-bits 10 | jq '.[] | {unit, total}'

Counts come from the units' own data paths. Stages marked * are quoted from the paper, as their texts
give no structure. Under \"paper\" is the paper's Table 1: multipliers/adders/look-up tables.";

/// Count what each unit is built of, beside the paper's Table 1.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Address bits of the tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "8")]
    table_bits: TableBitsArg,
    /// Address bits of the light's tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "8")]
    light_bits: TableBitsArg,
    /// Show what the paper does not count: mirrors, comparators, shifters.
    #[arg(long)]
    gates: bool,
    /// Print an array of objects.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    // What light they are for does not matter to the count.
    let tables = LightTables::new(args.light_bits.0, LightTables::FULL, LightTables::FULL, 20);
    let costs = UnitKind::ALL.map(|unit| {
        let cost = Model::new(unit, args.table_bits.0, Frame::default()).cost(&tables);
        (unit, cost.set_up, cost.illumination, StageCost { cost: cost.total(), quoted: cost.set_up.quoted })
    });
    if args.json {
        if args.gates {
            exit::warn("--gates", "not used: the objects have them in any case");
        }
        let objects = costs.map(|(unit, set_up, illumination, total)| {
            let printed =
                unit.printed().map(|p| json!({ "setup": counts(p.set_up), "illumination": counts(p.illumination) }));
            json!({
                "unit": unit.name(),
                "setup": stage(&set_up),
                "illumination": stage(&illumination),
                "total": stage(&total),
                "printed": printed,
            })
        });
        return super::write(None, &format!("{}\n", Value::from(objects.to_vec())));
    }
    let mut heading = vec!["unit"];
    for name in [["set-up ×", "+", "LUT", "paper"], ["light ×", "+", "LUT", "paper"]] {
        heading.extend(name);
    }
    heading.extend(["both ×", "+", "LUT", "÷", "√", "maps", "table bits"]);
    if args.gates {
        heading.extend(["mirrors", "comparators", "shifters"]);
    }
    let mut rows = Rows::new(heading);
    for (unit, set_up, illumination, total) in costs {
        let mut cells = vec![unit.name().to_owned()];
        let printed = unit.printed().map(|p| [p.set_up, p.illumination]);
        for (s, stage) in [set_up, illumination].into_iter().enumerate() {
            let mark = if stage.quoted { "*" } else { "" };
            cells.extend([stage.cost.multipliers, stage.cost.adders, stage.cost.tables].map(|n| format!("{n}{mark}")));
            cells.push(printed.map_or("-".to_owned(), |p| p[s].map(|n| n.to_string()).join("/")));
        }
        let c = total.cost;
        cells.extend([c.multipliers, c.adders, c.tables, c.dividers, c.roots, c.maps].map(|n| n.to_string()));
        cells.push(if total.quoted { "-".to_owned() } else { c.table_bits.to_string() });
        if args.gates {
            let gates = [c.mirrors, c.comparators, c.shifters];
            cells.extend(gates.map(|n| if total.quoted { "-".to_owned() } else { n.to_string() }));
        }
        rows.push(cells);
    }
    super::write(None, &(rows.to_text() + "* as printed\n"))
}

/// A stage for programs. What a quoted stage's text does not give is null.
fn stage(stage: &StageCost) -> Value {
    let Cost { multipliers, adders, dividers, roots, tables, table_bits, maps, mirrors, comparators, shifters } =
        stage.cost;
    let known = |n: u64| if stage.quoted { Value::Null } else { n.into() };
    json!({
        "multipliers": multipliers, "adders": adders, "dividers": dividers, "roots": roots, "tables": tables,
        "table_bits": known(table_bits), "maps": maps, "mirrors": known(mirrors.into()),
        "comparators": known(comparators.into()), "shifters": known(shifters.into()), "quoted": stage.quoted,
    })
}

fn counts([multipliers, adders, tables]: [u32; 3]) -> Value {
    json!({ "multipliers": multipliers, "adders": adders, "tables": tables })
}
