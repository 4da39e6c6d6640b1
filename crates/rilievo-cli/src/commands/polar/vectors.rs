//! `rilievo polar vectors`: pixels in a unit's words, and what it makes of them.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use rilievo::polar::{Model, Sample};

use super::{FrameArgs, heading};
use crate::args::{TableBitsArg, UnitArg};

const AFTER_HELP: &str = "\
Examples:
  rilievo polar vectors e3 --count 3
  rilievo polar vectors published --corners --count 20000 -o published.txt
  rilievo polar vectors e4d --light 120,40 --half 100,25

A line is a pixel: the words of the unit's ports in their order, then N'·L' and N'·H', all 16 bits
in hexadecimal. Lines that begin with // say what they are. Angles are binary, a turn is 2^16;
numbers are Q2.14, slopes Q4.12, in two's complement.";

/// Print test vectors for a unit: its words and its results.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The unit.
    unit: UnitArg,
    /// Random pixels.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(0..=10_000_000))]
    count: u32,
    /// Other random pixels.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// First, every combination of vectors along the axes and of bump vectors upright, at 45 degrees and lying: 20 736.
    #[arg(long)]
    corners: bool,
    /// Address bits of the tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "8")]
    table_bits: TableBitsArg,
    #[command(flatten)]
    frame: FrameArgs,
    /// The file [default: stdout].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let (unit, frame) = (args.unit.0, args.frame.frame(args.unit.0));
    let model = Model::new(unit, args.table_bits.0, frame);
    let ports: Vec<String> = unit.ports().iter().map(ToString::to_string).collect();
    let mut text =
        format!("// {}\n// {} -> N'.L' N'.H'\n", heading(unit, args.table_bits.0.bits(), &frame), ports.join(" "));
    text += &match model.limit() {
        Some(limit) => format!("// off the exact products by {limit} at most, of 2^14\n"),
        None => "// no limit follows from the word lengths: the method itself errs, or its words end\n".to_owned(),
    };
    let corners = args.corners.then(Sample::corners).into_iter().flatten();
    for sample in corners.chain(Sample::random(args.seed).take(args.count as usize)) {
        let words = sample.words(unit);
        let products = model.products(&words).map(|product| product as u16);
        for word in words.iter().chain(&products) {
            // Writing to a string cannot fail.
            let _ = write!(text, "{word:04x} ");
        }
        text.pop();
        text.push('\n');
    }
    super::write(args.output.as_deref(), &text)
}
