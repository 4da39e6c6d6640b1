//! The counted costs, and what is refused.

use rilievo_polar::{Cost, Frame, LightTables, Model, UnitCost, UnitKind, Width};

fn cost(kind: UnitKind) -> UnitCost {
    let tables = LightTables::new(Width::PAPER, LightTables::FULL, LightTables::FULL, 20);
    Model::new(kind, Width::PAPER, Frame::default()).cost(&tables)
}

fn counts(cost: Cost) -> [u32; 5] {
    [cost.multipliers, cost.adders, cost.dividers, cost.roots, cost.tables]
}

#[test]
fn table_1_is_counted_not_typed() {
    // Peercy and Ernst, Kim's illumination and the published unit have the paper's numbers, from their own structure.
    let peercy = cost(UnitKind::Peercy);
    assert_eq!(counts(peercy.set_up.cost), [27, 18, 9, 3, 0]);
    assert_eq!(counts(peercy.illumination.cost), [7, 5, 0, 0, 1]);
    let kim = cost(UnitKind::Kim);
    assert_eq!(counts(kim.illumination.cost), [6, 5, 0, 0, 12]);
    let published = cost(UnitKind::Published);
    assert_eq!(counts(published.set_up.cost), [6, 16, 0, 0, 12]);
    assert_eq!(counts(published.illumination.cost), [2, 11, 0, 0, 8]);
    for cost in [peercy.set_up, peercy.illumination, kim.illumination, published.set_up, published.illumination] {
        assert!(!cost.quoted);
    }
}

#[test]
fn exact_units_cost_what_is_claimed() {
    for (kind, expected) in [
        (UnitKind::E1, [8, 31, 0, 0, 24]),
        (UnitKind::E2, [10, 25, 0, 0, 12]),
        (UnitKind::E3, [6, 20, 0, 0, 12]),
        (UnitKind::E4, [4, 23, 0, 0, 18]),
        (UnitKind::E4d, [2, 12, 0, 0, 12]),
    ] {
        assert_eq!(counts(cost(kind).total()), expected, "{kind}");
    }
}

#[test]
fn what_the_text_does_not_determine_is_quoted() {
    let kim = cost(UnitKind::Kim);
    assert!(kim.set_up.quoted);
    assert_eq!(counts(kim.set_up.cost), [31, 18, 0, 0, 6]);
    let kugler = cost(UnitKind::Kugler);
    assert!(kugler.set_up.quoted && kugler.illumination.quoted);
    assert_eq!((kugler.set_up.cost.maps, kugler.illumination.cost.maps), (1, 2));
    // "Reduces multiplication operations up to 78 %": 37 to 8.
    let published = cost(UnitKind::Published).total();
    assert_eq!((kim.total().multipliers, published.multipliers), (37, 8));
}

#[test]
fn the_papers_tables_take_its_8_kilobytes() {
    assert_eq!(cost(UnitKind::Published).set_up.cost.table_bits, 8 * 8192);
}

#[test]
fn e3_has_ten_tables_of_cosines() {
    let light = 2 * 16 * 256;
    assert_eq!(cost(UnitKind::E3).total().table_bits - light, 40_960);
}

#[test]
fn table_bits_follow_the_width() {
    for bits in Width::RANGE {
        let width = Width::new(bits).unwrap();
        let tables = LightTables::new(Width::PAPER, LightTables::FULL, LightTables::FULL, 1);
        let cost = Model::new(UnitKind::E3, width, Frame::default()).cost(&tables).total();
        assert_eq!(cost.table_bits, ((10 * 16) << bits) + 2 * 16 * 256);
    }
}

#[test]
fn widths_that_cannot_be_built_are_refused_with_the_reason() {
    for bits in [0, 3, 15, 64] {
        let error = Width::new(bits).unwrap_err().to_string();
        assert!(error.contains(&format!("2^{bits} entries")) && error.contains("4 to 14"), "{error}");
    }
}

#[test]
fn an_unknown_unit_lists_those_there_are() {
    let error = "e5".parse::<UnitKind>().unwrap_err().to_string();
    for unit in UnitKind::ALL {
        assert!(error.contains(unit.name()), "{error}");
        assert_eq!(unit.name().parse(), Ok(unit));
    }
}
