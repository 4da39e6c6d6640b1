//! `rilievo polar errors`: the units against exact arithmetic.

use anyhow::Result;
use rilievo::Progress;
use rilievo::polar::{
    ErrorStats, LightSampling, PixelSampling, Rotation, UnitErrors, UnitKind, Width, rotation_errors, unit_errors,
};
use serde_json::{Map, Value, json};

use super::rows::Rows;
use crate::args::{TableBitsArg, UnitArg};
use crate::progress::Bars;
use crate::report::number;

const AFTER_HELP: &str = "\
Examples:
  rilievo polar errors
  rilievo polar errors e3 e4 --table-bits 6,8,10,12        accuracy against the width of the tables
  rilievo polar errors published --samples 2000000 --json

Light, halfway vector and normal are uniform over the upper half of the sphere, and count where the
vector is on the normal's side; bump vectors are uniform within --steepest degrees of the normal.
Errors are of N'·L' and N'·H', between -1 and 1, and of light of reflectance 1. \"limit\" is what
follows from the word lengths alone; \"-\" where the method itself errs.";

/// Measure how far the units are from exact arithmetic on the same words.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The units [default: all].
    #[arg(value_name = "UNIT")]
    units: Vec<UnitArg>,
    /// Address bits of the tables, 4 to 14; several for a comparison.
    #[arg(long, value_name = "A,...", value_delimiter = ',', default_value = "8")]
    table_bits: Vec<TableBitsArg>,
    /// Address bits of the light's tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "10")]
    light_bits: TableBitsArg,
    /// Phong exponents of the specular light.
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "10,50", value_parser = clap::value_parser!(u32).range(1..=65_535))]
    exponents: Vec<u32>,
    /// Pixels.
    #[arg(long, value_name = "N", default_value_t = 200_000, value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    samples: u32,
    /// Other pixels.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The most that bump vectors lean away from the normal, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 90.0, value_parser = lean)]
    steepest: f64,
    /// Print an array of objects.
    #[arg(long)]
    json: bool,
}

fn lean(text: &str) -> Result<f64, String> {
    let wrong = || format!("'{text}' is not an angle of 0 to 90 degrees");
    text.trim().parse().ok().filter(|v| (0.0..=90.0).contains(v)).ok_or_else(wrong)
}

/// What was found of a unit with tables of one width.
struct Found {
    unit: UnitKind,
    width: Width,
    errors: UnitErrors,
    /// In radians.
    rotation: Option<ErrorStats>,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let pixels = PixelSampling { count: args.samples, seed: args.seed, steepest_rad: args.steepest.to_radians() };
    let units: Vec<UnitKind> =
        if args.units.is_empty() { UnitKind::ALL.to_vec() } else { args.units.iter().map(|u| u.0).collect() };
    let light = LightSampling { width: args.light_bits.0, exponents: &args.exponents };
    let bars = Bars::new("polar errors");
    bars.begin("units", (units.len() * args.table_bits.len()) as u64);
    let mut found = Vec::new();
    for unit in units {
        let rotation = match unit {
            UnitKind::Published => Some(rotation_errors(Rotation::Published, &pixels)?),
            UnitKind::ExactZ => Some(rotation_errors(Rotation::ExactZ, &pixels)?),
            _ => None,
        };
        for width in args.table_bits.iter().map(|bits| bits.0) {
            let errors = unit_errors(unit, width, light, &pixels)?;
            found.push(Found { unit, width, errors, rotation });
            bars.advance(1);
        }
    }
    drop(bars);
    let text = if args.json {
        format!("{}\n", Value::from(found.iter().map(to_json).collect::<Vec<_>>()))
    } else {
        to_text(&found, args)
    };
    super::write(None, &text)
}

fn to_text(found: &[Found], args: &Args) -> String {
    let mut heading =
        ["unit", "bits", "N' rms", "mean", "p99", "max", "limit", "diffuse rms", "max"].map(str::to_owned).to_vec();
    for n in &args.exponents {
        heading.extend([format!("n={n} rms"), "max".to_owned()]);
    }
    let mut rows = Rows::new(heading.iter().map(String::as_str));
    for Found { unit, width, errors, .. } in found {
        let number = |v: f64| format!("{v:.5}");
        let p = &errors.products;
        let mut cells = vec![unit.name().to_owned(), width.bits().to_string()];
        cells.extend([p.rms, p.mean, p.p99, p.max].map(number));
        cells.push(errors.limit.map_or("-".to_owned(), number));
        let lit = std::iter::once(&errors.diffuse).chain(errors.specular.iter().map(|(_, stats)| stats));
        cells.extend(lit.flat_map(|stats| [stats.rms, stats.max].map(number)));
        rows.push(cells);
    }
    let mut text = rows.to_text();
    let mut told = Vec::new();
    for Found { unit, rotation, .. } in found {
        let Some(r) = rotation else { continue };
        if told.contains(unit) {
            continue;
        }
        told.push(*unit);
        let [mean, rms, p99, max] = [r.mean, r.rms, r.p99, r.max].map(f64::to_degrees);
        text += &format!(
            "{unit}: its rotation alone, in floating point, errs by {mean:.1} degrees on average, {rms:.1} RMS, {p99:.1} in one of a \
             hundred, {max:.1} at most\n"
        );
    }
    text
}

fn to_json(found: &Found) -> Value {
    let stats = |s: &ErrorStats, scale: f64| {
        let [mean, rms, p99, max] = [s.mean, s.rms, s.p99, s.max].map(|v| number(v * scale));
        json!({ "mean": mean, "rms": rms, "p99": p99, "max": max, "count": s.count })
    };
    let specular: Map<String, Value> =
        found.errors.specular.iter().map(|(n, s)| (n.to_string(), stats(s, 1.0))).collect();
    json!({
        "unit": found.unit.name(),
        "bits": found.width.bits(),
        "products": stats(&found.errors.products, 1.0),
        "limit": found.errors.limit.map(number),
        "diffuse": stats(&found.errors.diffuse, 1.0),
        "specular": specular,
        "rotation_deg": found.rotation.as_ref().map(|r| stats(r, 1f64.to_degrees())),
    })
}
