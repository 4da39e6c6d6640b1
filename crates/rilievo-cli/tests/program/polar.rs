//! The bump units by their figures, their vectors and their tables.

use rilievo::polar::{Model, UnitKind, Width};
use serde_json::Value;

use crate::runner::Room;

/// The object of a unit in an array of them.
fn of<'a>(rows: &'a Value, unit: &str) -> &'a Value {
    rows.as_array().unwrap().iter().find(|row| row["unit"] == unit).unwrap_or_else(|| panic!("no {unit} in {rows}"))
}

/// Multipliers, adders, tables of a stage.
fn counts(row: &Value, stage: &str) -> [u64; 3] {
    ["multipliers", "adders", "tables"].map(|what| row[stage][what].as_u64().unwrap())
}

#[test]
fn table_1_is_counted() {
    let room = Room::new();
    let rows = room.run("polar table --json").ok().json();
    let names: Vec<&str> = rows.as_array().unwrap().iter().map(|row| row["unit"].as_str().unwrap()).collect();
    assert_eq!(names, UnitKind::ALL.map(UnitKind::name));
    for (unit, set_up, illumination) in [
        ("peercy", [27, 18, 0], [7, 5, 1]),
        ("kim", [31, 18, 6], [6, 5, 12]),
        ("kugler", [5, 2, 3], [8, 4, 5]),
        ("published", [6, 16, 12], [2, 11, 8]),
    ] {
        let row = of(&rows, unit);
        assert_eq!((counts(row, "setup"), counts(row, "illumination")), (set_up, illumination), "{unit}");
        for stage in ["setup", "illumination"] {
            assert_eq!(counts(row, stage), counts(&row["printed"], stage), "{unit}");
        }
    }
    for (unit, total) in [("e3", [6, 20, 12]), ("e4", [4, 23, 18]), ("e4d", [2, 12, 12])] {
        assert_eq!(counts(of(&rows, unit), "total"), total, "{unit}");
        assert!(of(&rows, unit)["printed"].is_null());
    }
    let peercy = &of(&rows, "peercy")["setup"];
    assert_eq!((peercy["dividers"].as_u64(), peercy["roots"].as_u64()), (Some(9), Some(3)));
    // What is quoted is marked, and what no text gives is not made up.
    assert_eq!(of(&rows, "kim")["setup"]["quoted"], true);
    assert!(of(&rows, "kim")["setup"]["table_bits"].is_null());
    // The unit's own tables and the light's of 256 words.
    let bits = |bits: &str| of(&room.run(bits).ok().json(), "e3")["total"]["table_bits"].as_u64().unwrap();
    assert_eq!(bits("polar table --json"), 40_960 + 2 * 2 * 256 * 16 / 2);
    assert!(bits("polar table --json --table-bits 10") > 4 * 40_960);
    let text = String::from_utf8(room.run("polar table --gates").ok().stdout).unwrap();
    assert!(text.contains("shifters") && text.contains("31*") && text.contains("6/16/12"), "{text}");
}

#[test]
fn errors_are_as_known() {
    let room = Room::new();
    let rows = room.run("polar errors published exact-z e3 e4d --samples 20000 --json --quiet").ok().json();
    let figure = |unit: &str, what: &str, which: &str| of(&rows, unit)[what][which].as_f64().unwrap();
    assert!((figure("published", "rotation_deg", "mean") - 15.8).abs() < 0.5);
    assert!((figure("published", "rotation_deg", "rms") - 19.8).abs() < 0.5);
    assert!((figure("exact-z", "rotation_deg", "max") - 8.6).abs() < 0.1);
    assert!((0.17..0.21).contains(&figure("published", "products", "rms")));
    assert!(figure("e3", "products", "rms") <= 0.0015 && figure("e3", "products", "max") <= 0.006);
    assert!(of(&rows, "published")["limit"].is_null());
    assert!(of(&rows, "e3")["limit"].as_f64().unwrap() >= figure("e3", "products", "max"));
    assert!(of(&rows, "e3")["rotation_deg"].is_null());
    assert!(of(&rows, "e3")["specular"]["50"]["max"].as_f64().unwrap() < 0.1);
    let widths = room.run("polar errors e3 --table-bits 4,6,8 --samples 5000 --json --exponents 3").ok().json();
    let rms: Vec<f64> = widths.as_array().unwrap().iter().map(|r| r["products"]["rms"].as_f64().unwrap()).collect();
    assert!(rms.len() == 3 && rms[0] > 2.0 * rms[1] && rms[1] > 2.0 * rms[2], "{rms:?}");
    // Bump vectors that hardly lean leave E1 less to err with.
    let max = |steepest: u32| {
        let run = format!("polar errors e1 --samples 20000 --steepest {steepest} --json");
        of(&room.run(&run).ok().json(), "e1")["products"]["max"].as_f64().unwrap()
    };
    assert!(max(20) < max(90));
    let text = String::from_utf8(room.run("polar errors published --samples 2000").ok().stdout).unwrap();
    assert!(text.contains("n=50 rms") && text.contains("in floating point"), "{text}");
}

#[test]
fn vectors_are_what_the_model_says() {
    let room = Room::new();
    for unit in UnitKind::ALL {
        room.run(&format!("polar vectors {unit} --count 50 --seed 3 -o v.txt")).ok();
        let text = String::from_utf8(room.read("v.txt")).unwrap();
        let (comments, lines): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with("//"));
        assert_eq!((comments.len(), lines.len()), (3, 50));
        assert!(comments[0].contains(unit.name()) && comments[1].contains(&unit.ports()[0].to_string()));
        if unit.is_distant() {
            // Tables of a light need the light; the model is made with the program's.
            assert!(comments[0].contains("phi and theta of L"));
            continue;
        }
        let model = Model::new(unit, Width::PAPER, rilievo::polar::Frame::default());
        for line in lines {
            let words: Vec<u16> = line.split(' ').map(|word| u16::from_str_radix(word, 16).unwrap()).collect();
            let (inputs, results) = words.split_at(unit.ports().len());
            assert_eq!(model.products(inputs).map(|p| p as u16), results, "{unit}: {line}");
        }
    }
    let out = room.run("polar vectors e4 --corners --count 0").ok().stdout;
    assert_eq!(out.iter().filter(|&&b| b == b'\n').count(), 20_736 + 3);
    room.run("polar vectors e3 --count 1 --light 30,45").warns(&["--light: not used"]);
    room.run("polar table --json --gates").warns(&["--gates: not used"]);
    let [a, b] = ["30,45", "120,70"].map(|light| room.run(&format!("polar vectors e4d --light {light}")).ok().stdout);
    assert!(a != b);
}

#[test]
fn roms_are_listed_printed_and_written() {
    let room = Room::new();
    let list = String::from_utf8(room.run("polar rom e3").ok().stdout).unwrap();
    assert!(list.lines().count() > 1, "{list}");
    let name = list.lines().nth(1).unwrap().split_whitespace().next().unwrap();
    let words = |bits: u32| {
        let said = room.run(&format!("polar rom e3 --table {name} --table-bits {bits}")).ok();
        let text = String::from_utf8(said.stdout).unwrap();
        assert!(text.starts_with("// rilievo ") && text.lines().skip(1).all(|l| u16::from_str_radix(l, 16).is_ok()));
        text.lines().count() - 1
    };
    assert_eq!((words(8), words(10)), (256, 1024));
    room.run("polar rom published -o roms").ok();
    let published = String::from_utf8(room.run("polar rom published").ok().stdout).unwrap();
    assert_eq!(std::fs::read_dir(room.path("roms")).unwrap().count(), published.lines().count() - 1);
    room.run("polar rom e3 --table nothing").fails(2, &["e3", "'nothing'", name]);
}

#[test]
fn wrong_units_and_widths_are_refused_with_the_reason() {
    let room = Room::new();
    for command in ["errors e5", "vectors e5", "rom e5"] {
        room.run(&format!("polar {command}")).fails(2, &["'e5'", "published", "e4d"]);
    }
    for command in ["table", "errors e3", "vectors e3", "rom e3"] {
        for bits in [3, 15] {
            room.run(&format!("polar {command} --table-bits {bits}")).fails(2, &["4 to 14"]);
        }
    }
    room.run("polar errors e3 --steepest 91").fails(2, &["0 to 90"]);
    room.run("polar errors e3 --samples 0").fails(2, &["samples"]);
    room.run("polar errors e3 --exponents 0").fails(2, &["exponents"]);
    room.run("polar vectors e4d --light 30,190").fails(2, &["0 to 180"]);
    room.run("polar vectors e3 -o no/such/folder.txt").fails(3, &["folder.txt"]);
}
