//! The quantiser's errors do not grow: each is held against `quality.csv`.
//!
//! A smaller error is not written down by itself: bless it, so that it stays.

use std::path::{Path, PathBuf};

use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, Texels, quantize};
use rilievo::{Convention, Grid, Object};
use rilievo_io::{Limits, NormalImage, Source, decode_normals};

/// Room for another processor's way of doing the same, of which there should be none.
const SLACK: f64 = 1.002;
const BUNNY: &str = "normal/bunny_object_1536x1024.png";

fn efforts() -> [(&'static str, Effort); 2] {
    [("fast", Effort::Fast), ("normal", Effort::Normal)]
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("quality.csv")
}

/// (map, entries, effort) → RMS error in degrees.
fn written() -> Vec<(String, f64)> {
    let text = std::fs::read_to_string(file()).expect("quality.csv is part of the project");
    let row = |line: &str| {
        let (key, rms) = line.rsplit_once(',').expect("map,entries,effort,rms_deg");
        (key.to_owned(), rms.parse().expect("a number"))
    };
    text.lines().skip(1).map(row).collect()
}

fn measured(name: &str, map: Texels<'_, Object>) -> Vec<(String, f64)> {
    let mut rows = Vec::new();
    for entries in [256, 2048, 16_384] {
        for (effort_name, effort) in efforts() {
            let options = Options { entries, effort, ..Options::default() };
            let error = quantize(map, &options, &Silent).expect("valid options").error;
            rows.push((format!("{name},{entries},{effort_name}"), error.rms_rad.to_degrees()));
        }
    }
    rows
}

fn bunny() -> Option<NormalImage<Object>> {
    let source = Source::open(&testkit::shared_file(BUNNY)?, &Limits::default()).expect("the file is there");
    Some(decode_normals(&source, Convention::Gl, &Limits::default()).expect("a normal map"))
}

#[test]
fn errors_are_no_larger_than_written() {
    let sphere = Grid::new(1000, 1000, testkit::uniform_sphere(1_000_000, 1)).expect("a million normals");
    let mut rows = measured("sphere", (&sphere).into());
    let bunny = bunny();
    if let Some(bunny) = &bunny {
        rows.extend(measured("bunny", bunny.texels()));
    }
    if std::env::var("RILIEVO_BLESS").as_deref() == Ok("1") {
        assert!(bunny.is_some(), "without the shared maps their rows would be lost");
        let line = |(key, rms): &(String, f64)| format!("{key},{rms:.5}\n");
        let text: String = rows.iter().map(line).collect();
        std::fs::write(file(), format!("map,entries,effort,rms_deg\n{text}")).expect("the project can be written to");
    }
    let written = written();
    for (key, found) in rows {
        let (_, most) =
            written.iter().find(|(k, _)| *k == key).unwrap_or_else(|| panic!("{key} is not in quality.csv"));
        println!("{key}: {found:.5}° (written: {most:.5}°)");
        assert!(found <= most * SLACK, "{key}: {found:.5}° where it was {most:.5}°");
    }
}
