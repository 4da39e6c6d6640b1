//! `rilievo polar rom`: what is in a unit's tables.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use rilievo::polar::{Model, Rom};

use super::rows::Rows;
use super::{FrameArgs, heading};
use crate::args::{TableBitsArg, UnitArg};
use crate::exit::{remark, usage};

const AFTER_HELP: &str = "\
Examples:
  rilievo polar rom e3                             its tables by name
  rilievo polar rom e3 --table sine                one of them
  rilievo polar rom published -o rom               all of them, rom/published_sine.hex and so on

A line is a word of 16 bits in hexadecimal, as Verilog's $readmemh reads it; the first is a comment.
Tables of the light are the application's and not among them.";

/// List or write the tables of a unit.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The unit.
    unit: UnitArg,
    /// Print this table.
    #[arg(long, value_name = "NAME", conflicts_with = "output")]
    table: Option<String>,
    /// Address bits of the tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "8")]
    table_bits: TableBitsArg,
    #[command(flatten)]
    frame: FrameArgs,
    /// A folder for all tables; it is made if it is not there.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let frame = args.frame.frame(args.unit.0);
    let heading = heading(args.unit.0, args.table_bits.0.bits(), &frame);
    let model = Model::new(args.unit.0, args.table_bits.0, frame);
    let roms = model.roms();
    if let Some(name) = &args.table {
        let Some(rom) = roms.iter().find(|rom| rom.name() == name) else {
            let names: Vec<&str> = roms.iter().map(|rom| rom.name()).collect();
            let there =
                if names.is_empty() { "it has none".to_owned() } else { format!("there are {}", names.join(", ")) };
            return Err(usage(format!("{} has no table '{name}'; {there}", args.unit.0)));
        };
        return super::write(None, &text(&heading, rom));
    }
    match &args.output {
        Some(folder) => write_all(args, &heading, &roms, folder),
        None => super::write(None, &list(&roms)),
    }
}

fn text(heading: &str, rom: &Rom) -> String {
    let words: String = rom.words().iter().map(|word| format!("{word:04x}\n")).collect();
    format!("// {heading}, table {}\n{words}", rom.name())
}

fn list(roms: &[&Rom]) -> String {
    let mut rows = Rows::new(["table", "words", "bits"]);
    for rom in roms {
        let words = rom.words().len();
        rows.push(vec![rom.name().to_owned(), words.to_string(), (16 * words).to_string()]);
    }
    rows.to_text()
}

fn write_all(args: &Args, heading: &str, roms: &[&Rom], folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    for rom in roms {
        let path = folder.join(format!("{}_{}.hex", args.unit.0, rom.name()));
        super::write(Some(&path), &text(heading, rom))?;
        remark(path.display().to_string());
    }
    Ok(())
}
