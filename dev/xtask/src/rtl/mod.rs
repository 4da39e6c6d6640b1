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

use crate::run::{Run, on_path};
use crate::workspace::root;

/// The units there is hardware for; a unit's top module has its name.
const UNITS: [UnitKind; 3] = [UnitKind::Published, UnitKind::E3, UnitKind::E4];

#[derive(Args)]
pub(crate) struct Options {
    /// Write rtl/rom anew instead of comparing it.
    #[arg(long)]
    write: bool,
    /// Address bits of the tables, 4 to 14; rtl/rom holds those of 8.
    #[arg(long, value_name = "A", default_value_t = 8)]
    table_bits: u32,
    /// Random pixels for each unit, besides all corners.
    #[arg(long, value_name = "N", default_value_t = 25_000)]
    samples: usize,
    /// Place and route for a Lattice ECP5 instead, and say how fast the units run. Takes minutes.
    #[arg(long)]
    place: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { write: false, table_bits: Width::PAPER.bits(), samples: 25_000, place: false }
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
    for tool in ["verilator", "yosys"] {
        if !on_path(tool) {
            bail!("{tool} is missing. On Debian or Ubuntu: apt-get install --no-install-recommends {tool}");
        }
    }
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

/// Where cargo builds: nothing is built in the checkout's own folders.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |dir| root().join(Path::new(&dir)))
}
