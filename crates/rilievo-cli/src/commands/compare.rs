//! `rilievo compare`: how far apart two maps or pictures are.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use rilievo::measure::{AngleStats, DEFAULT_PIXELS_PER_DEGREE, PictureStats, angle_stats, flip_mean, picture_stats};
use rilievo::{Grid, Object};
use rilievo_io::{self as io, Limits, Source};

use crate::args::{ConventionArg, Given, number};
use crate::exit::{Outcome, usage, warn};
use crate::inputs;
use crate::report::Report;

const AFTER_HELP: &str = "\
Examples:
  rilievo compare bricks_normal_gl.png bricks_256.png         degrees between normals
  rilievo compare reference.png other.png                     dB, FLIP and the MSE family between pictures
  rilievo compare a.png b.png --min-psnr 40 && echo alike     exit code 1 if not
  rilievo compare exact.npy out.png --as normals --max-deg 0.03 --json

A is the reference. Without --as, files are compared as normal maps if both hold unit vectors, else as pictures.";

/// Measure the error between two normal maps or two pictures.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The reference.
    a: PathBuf,
    /// What is compared with it.
    b: PathBuf,
    /// What the files hold [default: found out].
    #[arg(long = "as", value_enum)]
    kind: Option<Kind>,
    /// Which way green points in A (normal maps).
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl)]
    convention: ConventionArg,
    /// Which way green points in B [default: as in A].
    #[arg(long, value_enum)]
    convention_b: Option<ConventionArg>,
    /// Normal maps: the answer is no (exit code 1) over this RMS angle.
    #[arg(long, value_name = "DEG", value_parser = number)]
    max_rms: Option<f64>,
    /// Normal maps: the answer is no over this largest angle.
    #[arg(long, value_name = "DEG", value_parser = number)]
    max_deg: Option<f64>,
    /// Pictures: the answer is no under this PSNR.
    #[arg(long, value_name = "DB", value_parser = number)]
    min_psnr: Option<f64>,
    /// Pictures: the answer is no over this mean FLIP.
    #[arg(long, value_name = "FLIP", value_parser = number)]
    max_flip: Option<f64>,
    /// Pictures: the answer is no over this largest difference of a channel, 0 to 255.
    #[arg(long, value_name = "STEPS")]
    max_abs: Option<u8>,
    /// Pixels per degree of the eye for FLIP [default: a 4K screen 0.7 m wide at 0.7 m].
    #[arg(long, value_name = "PPD", default_value_t = DEFAULT_PIXELS_PER_DEGREE)]
    pixels_per_degree: f32,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    Normals,
    Picture,
}

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    if args.a.as_os_str() == "-" && args.b.as_os_str() == "-" {
        return Err(usage("only one of the two can be standard input"));
    }
    let (a, b) = (inputs::open(&args.a)?, inputs::open(&args.b)?);
    let kind = match args.kind {
        Some(kind) => kind,
        None if io::looks_like_normals(&a, &Limits::default()) && io::looks_like_normals(&b, &Limits::default()) => {
            Kind::Normals
        }
        None => Kind::Picture,
    };
    let (report, passed) = match kind {
        Kind::Normals => {
            given.unused(&["pixels_per_degree"], "these are normal maps");
            compare_normals(args, &a, &b)?
        }
        Kind::Picture => {
            given.unused(&["convention", "convention_b"], "these are pictures");
            compare_pictures(args, &a, &b)?
        }
    };
    report.print(args.json)?;
    Ok(if passed { Outcome::Done } else { Outcome::Negative })
}

fn compare_normals(args: &Args, a: &Source, b: &Source) -> Result<(Report, bool)> {
    if args.min_psnr.is_some() || args.max_flip.is_some() || args.max_abs.is_some() {
        return Err(usage(
            "these are normal maps, but --min-psnr, --max-flip and --max-abs are for pictures; see --as",
        ));
    }
    // The space does not matter for angles, only that it is the same.
    let a = inputs::any_normals::<Object>(a, args.convention.into())?;
    let b = inputs::any_normals::<Object>(b, args.convention_b.unwrap_or(args.convention).into())?;
    a.normals.expect_same_size("the second map", &b.normals)?;
    // Only texels that mean something in both.
    let both = match (a.covered, b.covered) {
        (Some(a), Some(b)) => {
            let both = a.texels().iter().zip(b.texels()).map(|(&a, &b)| a && b).collect();
            Some(Grid::new(a.width(), a.height(), both)?)
        }
        (one, other) => one.or(other),
    };
    let stats: AngleStats = angle_stats(&a.normals, &b.normals, both.as_ref())?;
    let mut report = Report::default();
    report.add("kind", "normals").add("texels", stats.count).add_angles(&stats);
    let within = |value: f64, limit: Option<f64>| limit.is_none_or(|l| value <= l);
    let passed = within(stats.rms_rad.to_degrees(), args.max_rms) && within(stats.max_rad.to_degrees(), args.max_deg);
    Ok((report, passed))
}

fn compare_pictures(args: &Args, a: &Source, b: &Source) -> Result<(Report, bool)> {
    if args.max_rms.is_some() || args.max_deg.is_some() {
        return Err(usage("these are pictures, but --max-rms and --max-deg are for normal maps; see --as"));
    }
    let read = |source: &Source| io::decode_picture(source, &Limits::default());
    for source in [a, b] {
        if io::sample_depth(source, &Limits::default())? != io::Depth::U8 {
            warn(source.name(), "has more than 8 bits; pictures are compared at 8");
        }
    }
    let (a, b) = (read(a)?, read(b)?);
    let stats: PictureStats = picture_stats(&a, &b)?;
    let flip = flip_mean(&a, &b, args.pixels_per_degree)?;
    let mut report = Report::default();
    report.add("kind", "picture").add_f64("psnr_db", stats.psnr_db).add("max_abs", stats.max_abs);
    for (key, values) in [("nmse", stats.nmse), ("rnmse", stats.rnmse), ("pmse", stats.pmse), ("rpmse", stats.rpmse)] {
        report.add(key, values.to_vec());
    }
    report.add_f64("flip_mean", flip);
    let passed = args.min_psnr.is_none_or(|l| stats.psnr_db >= l)
        && args.max_flip.is_none_or(|l| flip <= l)
        && args.max_abs.is_none_or(|l| stats.max_abs <= l);
    Ok((report, passed))
}
