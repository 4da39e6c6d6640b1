//! `cargo xtask rtl`: the hardware of the polar units against their integer models.
//!
//! The models are the specification. The contents of the tables come from them, every pixel replayed must come out of the simulated
//! hardware to the bit, and what a synthesiser counts must be what the models count.

mod cost;
mod place;
mod replay;
mod roms;

use anyhow::{Result, bail};
use clap::Args;
use rilievo_polar::{Frame, Model, UnitKind, Width};
use std::path::{Path, PathBuf};

use crate::needs;
use crate::run::Run;
use crate::workspace::root;

/// Random pixels for each unit, unless asked for others.
const SAMPLES: usize = 25_000;
/// The units there is hardware for; a unit's top module has its name.
const UNITS: [UnitKind; 3] = [UnitKind::Published, UnitKind::E3, UnitKind::E4];

#[derive(Args)]
pub(crate) struct Options {
    /// Write rtl/rom anew instead of comparing it.
    #[arg(long)]
    write: bool,
    /// Address bits of the tables, 4 to 14; rtl/rom holds those of 8.
    #[arg(long, value_name = "A", default_value_t = Width::PAPER.bits())]
    table_bits: u32,
    /// Random pixels for each unit, besides all corners.
    #[arg(long, value_name = "N", default_value_t = SAMPLES)]
    samples: usize,
    /// Place and route for a Lattice ECP5 instead, and say how fast the units run. Takes minutes.
    #[arg(long)]
    place: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { write: false, table_bits: Width::PAPER.bits(), samples: SAMPLES, place: false }
    }
}

/// A unit with its model.
struct Unit {
    kind: UnitKind,
    model: Model,
}

/// What is worked with: models, and a folder that has the tables in `rom`.
struct Bench {
    width: Width,
    units: Vec<Unit>,
    folder: PathBuf,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let Ok(width) = Width::new(options.table_bits) else {
        bail!("--table-bits {}: address bits of a table are 4 to 14", options.table_bits);
    };
    let model = |kind| Unit { kind, model: Model::new(kind, width, Frame::default()) };
    let folder = target().join("rtl").join(format!("tables-of-{}-bits", width.bits()));
    let bench = Bench { width, units: UNITS.map(model).into(), folder };
    let roms = roms::of(&bench.units);
    if options.write {
        return roms::write(&roms, &root().join("rtl/rom"));
    }
    if width == Width::PAPER {
        roms::check(&roms, &root().join("rtl/rom"))?;
        eprintln!("rtl/rom: {} tables are the models'", roms.len());
    }
    roms::write(&roms, &bench.folder.join("rom"))?;
    if options.place {
        return place::run(&bench);
    }
    needs::demand(&["verilator", "yosys"])?;
    for unit in &bench.units {
        lint(&bench, unit)?;
        replay::run(&bench, unit, options.samples)?;
    }
    cost::run(&bench)
}

/// No warning of any kind.
fn lint(bench: &Bench, unit: &Unit) -> Result<()> {
    Run::new("verilator")
        .args(["--lint-only", "-Wall", "--top-module", unit.kind.name()])
        .arg(format!("-GA={}", bench.width.bits()))
        .args(sources()?)
        .output()?;
    eprintln!("{}: lint finds nothing", unit.kind);
    Ok(())
}

/// The modules, in an order that does not depend on the file system.
fn sources() -> Result<Vec<PathBuf>> {
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(root().join("rtl"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "sv") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// What Yosys reads first: the modules, and the width of a unit's tables.
fn read(bench: &Bench, unit: &Unit) -> Result<String> {
    let files: Vec<String> = sources()?.iter().map(|path| path.display().to_string()).collect();
    Ok(format!("read_verilog -sv {}; chparam -set A {} {}", files.join(" "), bench.width.bits(), unit.kind))
}

/// Where cargo builds: nothing is built in the checkout's own folders.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |dir| root().join(Path::new(&dir)))
}
