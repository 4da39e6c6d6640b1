//! Table 1 of Lee et al.: what the units are built of.

use anyhow::Result;
use rilievo::polar::{Frame, LightTables, Model, UnitCost, UnitKind, Width};

use super::unit_key;
use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};

pub(crate) fn run(_: &Kit<'_>) -> Result<Findings> {
    let mut found = Findings::default();
    found.paper(
        "Table 1 sets the unit beside Peercy's, Kugler's, Kim's and Ernst's by multipliers, adders and look-up tables, for set-up \
         (vectors into the reference space) and for illumination, and finds 78 % of the multiplications saved.",
    );
    found.here(
        "Counted from the data paths themselves: each unit is written once over operators, and the same text runs as integers and is \
         counted. A stage whose structure a text does not give is quoted from the table and marked “q”. All tables have 256 words of 16 bits, \
         also the light's; their bits are what the units fold by symmetry. Dividers, roots and maps are named where there are any.",
    );
    let cells = |name: &str| ["×", "+", "LUT"].map(|what| format!("{name} {what}"));
    let mut columns = vec![Column::here("unit")];
    columns.extend(cells("set-up").map(Column::here));
    columns.push(Column::paper("paper × / + / LUT"));
    columns.extend(cells("light").map(Column::here));
    columns.push(Column::paper("paper × / + / LUT"));
    columns.extend(cells("both").map(Column::here));
    columns.extend(["table bits", "besides"].map(Column::here));
    let caption = "Multipliers, adders and look-up tables. Peercy's illumination is Ernst's. Units below “published” are not in the paper.";
    let mut table = Table::new(caption, columns);
    // What light they are for does not matter to the count.
    let tables = LightTables::new(Width::PAPER, LightTables::FULL, LightTables::FULL, 20);
    let mut multipliers = [0.0; 2];
    for unit in UnitKind::ALL {
        let cost = Model::new(unit, Width::PAPER, Frame::default()).cost(&tables);
        match unit {
            UnitKind::Kim => multipliers[0] = f64::from(cost.total().multipliers),
            UnitKind::Published => multipliers[1] = f64::from(cost.total().multipliers),
            _ => {}
        }
        table.row(row(unit, &cost));
        figures(unit, &cost, &mut found);
    }
    found.show(table);
    let saved = 100.0 * (1.0 - multipliers[1] / multipliers[0]);
    found.against("multipliers_saved_percent", saved, 78.0);
    found.remark(format!(
        "The counts are the paper's where the text determines a structure. Its 78 % are {saved:.1} % of Kim's multipliers: the only row \
         against which so many are saved. Table 1 has 11 adders for the illumination, the text 13: equations (24) and (25) as printed have 13, \
         written as an interpolation between two cosines they have 11. E3 is exact and smaller than the published unit on all three counts; E4 saves two \
         more multipliers for six tables; E4d serves distant lights alone."
    ));
    Ok(found)
}

fn row(unit: UnitKind, cost: &UnitCost) -> Vec<String> {
    let total = cost.total();
    let mut cells = vec![unit.name().to_owned()];
    let printed = unit.printed();
    let stages = [(&cost.set_up, printed.map(|p| p.set_up)), (&cost.illumination, printed.map(|p| p.illumination))];
    for (stage, paper) in stages {
        let quoted = if stage.quoted { " q" } else { "" };
        let c = &stage.cost;
        cells.extend([c.multipliers, c.adders, c.tables].map(|n| format!("{n}{quoted}")));
        cells.push(paper.map_or("–".to_owned(), |p| p.map(|n| n.to_string()).join(" / ")));
    }
    cells.extend([total.multipliers, total.adders, total.tables].map(|n| n.to_string()));
    cells.push(if cost.set_up.quoted { "–".to_owned() } else { total.table_bits.to_string() });
    let besides = [(total.dividers, "dividers"), (total.roots, "roots"), (total.maps, "maps")];
    let named: Vec<String> = besides.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    cells.push(if named.is_empty() { "–".to_owned() } else { named.join(", ") });
    cells
}

fn figures(unit: UnitKind, cost: &UnitCost, found: &mut Findings) {
    let key = unit_key(unit);
    let kinds = ["multipliers", "adders", "tables"];
    let stages = [("setup", &cost.set_up), ("illumination", &cost.illumination)];
    for (s, (name, stage)) in stages.into_iter().enumerate() {
        let counted = [stage.cost.multipliers, stage.cost.adders, stage.cost.tables];
        for (k, (kind, n)) in kinds.into_iter().zip(counted).enumerate() {
            let key = format!("{key}_{name}_{kind}");
            match unit.printed().map(|p| [p.set_up, p.illumination][s][k]) {
                Some(paper) => found.against(key, f64::from(n), f64::from(paper)),
                None => found.figure(key, f64::from(n)),
            }
        }
    }
}
