//! `rilievo polar`: the bump units for hardware, by their figures and their words.

mod errors;
mod rom;
mod rows;
mod table;
mod vectors;

use std::path::Path;

use anyhow::Result;
use clap::Subcommand;
use rilievo::polar::{Direction, Frame, UnitKind};

use crate::args::number;
use crate::exit::{self, Outcome};

const AFTER_HELP: &str = "\
Examples:
  rilievo polar table                                   what each unit is built of
  rilievo polar errors e3 e4 --table-bits 6,8,10        how far it is from exact arithmetic
  rilievo polar vectors e3 --corners --count 20000 -o e3.txt
  rilievo polar rom e3 -o rom                           its tables for $readmemh
  rilievo render sphere --height bricks.png --method polar --unit e3

Units: blinn, peercy, kugler, kim, of other papers; published, of Lee et al., and exact-z, the same
with exact Z; e1, e2, e3, e4 are exact, e4d too, for distant lights.";

/// Show what the polar bump units cost, how far they err, and what is in their tables.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Table(table::Args),
    Errors(errors::Args),
    Vectors(vectors::Args),
    Rom(rom::Args),
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    match &args.command {
        Command::Table(args) => table::run(args)?,
        Command::Errors(args) => errors::run(args)?,
        Command::Vectors(args) => vectors::run(args)?,
        Command::Rom(args) => rom::run(args)?,
    }
    Ok(Outcome::Done)
}

/// A frame of a distant light and viewer, of which `kugler` and `e4d` hold tables.
#[derive(Debug, clap::Args)]
struct FrameArgs {
    /// Towards the light, for units with tables of a distant one: φ from +X, θ from the pole +Z, in degrees [default: 30,45].
    #[arg(long, value_name = "PHI,THETA", allow_hyphen_values = true, value_parser = direction)]
    light: Option<Direction>,
    /// Halfway between light and viewer, likewise [default: 30,22].
    #[arg(long, value_name = "PHI,THETA", allow_hyphen_values = true, value_parser = direction)]
    half: Option<Direction>,
}

impl FrameArgs {
    /// The frame; for a unit that has no use for it, a warning if it was given.
    fn frame(&self, unit: UnitKind) -> Frame {
        for (flag, given) in [("--light", self.light), ("--half", self.half)] {
            if given.is_some() && !unit.is_distant() {
                exit::warn(flag, &format!("not used: {unit} takes directions by the pixel"));
            }
        }
        let default = Frame::default();
        Frame { light: self.light.unwrap_or(default.light), half: self.half.unwrap_or(default.half) }
    }
}

fn direction(text: &str) -> Result<Direction, String> {
    let wrong = || format!("'{text}' is not PHI,THETA in degrees, THETA from 0 to 180, as in 30,45");
    let (phi, theta) = text.split_once(',').ok_or_else(wrong)?;
    let (phi, theta) = (number(phi)?, number(theta)?);
    if !phi.is_finite() || !(0.0..=180.0).contains(&theta) {
        return Err(wrong());
    }
    let word = |degrees: f64| (degrees.rem_euclid(360.0) * 65_536.0 / 360.0).round() as u32 as u16;
    Ok(Direction { azimuth: word(phi), polar: word(theta) })
}

/// The one line that tells which words these are.
fn heading(unit: UnitKind, bits: u32, frame: &Frame) -> String {
    let mut line = format!("rilievo {}, unit {unit}, tables of 2^{bits} words", env!("CARGO_PKG_VERSION"));
    if unit.is_distant() {
        let words = |d: Direction| format!("{:04x} {:04x}", d.azimuth, d.polar);
        line += &format!("; phi and theta of L {}, of H {}", words(frame.light), words(frame.half));
    }
    line
}

/// To a file, or to stdout without one.
fn write(output: Option<&Path>, text: &str) -> Result<()> {
    Ok(rilievo_io::write_atomic(output.unwrap_or(Path::new("-")), text.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_binary_angles() {
        assert_eq!(direction("90,45"), Ok(Direction { azimuth: 1 << 14, polar: 1 << 13 }));
        assert_eq!(direction("-90,180"), Ok(Direction { azimuth: 3 << 14, polar: 1 << 15 }));
        for wrong in ["90", "0,181", "0,-1", "a,b"] {
            assert!(direction(wrong).is_err(), "{wrong}");
        }
    }
}
