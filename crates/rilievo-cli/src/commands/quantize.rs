//! `rilievo quantize`: normal maps to index maps with a small table of normals.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use rilievo::quantize::{self, Band, Options, Quantized, RowSource, Visit, fejes_toth_rms_rad};
use rilievo::{MaterialMap, Object, Space, Tangent};
use rilievo_io as io;
use rilievo_io::{NormalRows, SpaceKind};

use crate::args::{ConventionArg, DitherArg, EffortArg, MaterialsInArg, SpaceArg};
use crate::exit::{Outcome, remark, usage, warn};
use crate::progress::Bars;
use crate::report::Report;
use crate::{batch, inputs};

/// The most entries a palette holds.
const PALETTE_ENTRIES: u32 = 256;

const AFTER_HELP: &str = "\
Examples:
  rilievo quantize bricks_normal_gl.png -n 256        -> bricks_normal_gl_256.png, an indexed PNG
  rilievo quantize bunny.png --space object           -> bunny_2048.ktx2
  rilievo quantize bricks_normal_gl.png --max-rms 1   -> the smallest table that is within 1 degree RMS
  rilievo quantize vase.png --space object --materials vase_materials.png -n 1024 -o vase.ktx2 --json
  rilievo quantize bunny.png --space object -n 256 --dither diffusion    -> smooth curves instead of facets

An indexed PNG (K up to 256) shows its normals in any viewer and is relit by rewriting its palette. KTX2 holds any K,
with all mip levels; --no-mips leaves them out.

A PNG of more than 16 million texels (8 or 16 bits of RGB or RGBA, not interlaced) is read twice, some rows at a time, and
takes 2 to 3 bytes of memory per texel; other formats, --max-rms and --materials-in need all of it in memory,
some 40 bytes per texel.

--dither is for small tables: above some 2048 entries facets are hardly seen, and it hardly pays. Files grow (1.5 times at
K = 2048, 3 times at 256). Only full-size texels are dithered; smaller mip levels take their nearest entries. rms_deg is
that of the texels as written, each by itself: more than without, as dithering is right on average only.

bound_rms_deg is the least RMS error any table of K entries reaches on a uniform sphere (Fejes Toth): a map whose
normals crowd together does better, and 1.0 x the bound is perfect only for a sphere. zador_rms_deg is what the best
table of K entries tends to for the density of this very map (Zador): an estimate, good for large K and smooth
densities, and no bound. level_mean_deg are the mean errors of the smaller mip levels, against the averaged normals.";

/// Quantise normal maps to an index map and a table of K normals.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Normal maps: PNG, JPEG, TIFF, EXR or NPY; - is stdin.
    #[arg(required = true, value_name = "NORMALS")]
    inputs: Vec<PathBuf>,
    /// The output: a file (.png for K up to 256, .ktx2 for any), or a folder for several inputs.
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Entries of the table, 2 to 65536.
    #[arg(short = 'n', long, value_name = "K", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(2..=65536))]
    entries: u32,
    /// Find the smallest table with at most this RMS error, in degrees, instead of a given K.
    #[arg(long, value_name = "DEG", conflicts_with = "entries")]
    max_rms: Option<f64>,
    /// The space of the normals.
    #[arg(long, value_enum, default_value_t = SpaceArg::Tangent)]
    space: SpaceArg,
    /// Which way green points in the input; the output keeps it.
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl)]
    convention: ConventionArg,
    /// A map of material numbers (gray values or palette indices): no texel changes its material.
    #[arg(long, value_name = "MAP")]
    materials: Option<PathBuf>,
    /// The materials stand in the normal map's own colours: in alpha, or in four sub-cubes of the colour cube.
    #[arg(long, value_enum, value_name = "WHERE", conflicts_with_all = ["materials", "repair"])]
    materials_in: Option<MaterialsInArg>,
    /// Give texels that are zero or not a number their nearest neighbour's normal, instead of refusing the map.
    #[arg(long)]
    repair: bool,
    /// Write the full size only: a KTX2 has all mip levels otherwise.
    #[arg(long)]
    no_mips: bool,
    /// How hard to try.
    #[arg(long, value_enum, default_value_t = EffortArg::Normal)]
    effort: EffortArg,
    /// Trade facets for fine noise: single texels err more (the report says how much), what an eye averages less.
    #[arg(long, value_enum, default_value_t = DitherArg::None)]
    dither: DitherArg,
    /// Print the report as JSON, one object per input.
    #[arg(long)]
    json: bool,
}

/// The two kinds of files a quantised map is written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FileKind {
    Png,
    Ktx2,
}

impl FileKind {
    fn of(output: &Path, entries: u32) -> Result<Self> {
        let extension = output.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("ktx2") => Ok(Self::Ktx2),
            Some("png") if entries <= PALETTE_ENTRIES => Ok(Self::Png),
            Some("png") => Err(usage(format!(
                "{}: an indexed PNG holds at most 256 entries, not {entries}; use -n 256 or a .ktx2 file",
                output.display()
            ))),
            _ => Ok(Self::default_for(entries)),
        }
    }

    fn default_for(entries: u32) -> Self {
        if entries <= PALETTE_ENTRIES { Self::Png } else { Self::Ktx2 }
    }

    fn most_entries(self) -> u32 {
        if self == Self::Png { PALETTE_ENTRIES } else { 65_536 }
    }

    fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Ktx2 => "ktx2",
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if args.max_rms.is_some_and(|m| !(m.is_finite() && m > 0.0)) {
        return Err(usage("--max-rms is an angle in degrees, more than 0"));
    }
    // How many entries will do is only known afterwards: KTX2 holds any number.
    let kind = if args.max_rms.is_some() { FileKind::Ktx2 } else { FileKind::default_for(args.entries) };
    let extension = kind.extension();
    let named = args.max_rms.map_or_else(|| args.entries.to_string(), |deg| format!("{deg}deg"));
    batch::run(
        &args.inputs,
        args.output.as_deref(),
        &["png", "ktx2"],
        &args.materials.as_deref().into_iter().collect::<Vec<_>>(),
        |input| format!("{}_{named}.{extension}", batch::stem(input)),
        |input, output| {
            let work = match args.space.into() {
                SpaceKind::Tangent => convert::<Tangent>,
                SpaceKind::Object => convert::<Object>,
            };
            work(args, input, output)
        },
    )
}

fn convert<S: Space>(args: &Args, input: &Path, output: &Path) -> Result<Outcome> {
    let kind = FileKind::of(output, if args.max_rms.is_some() { 1 } else { args.entries })?;
    let started = Instant::now();
    let progress = Bars::new(input.display().to_string());
    let quantized = match inputs::large_normals(input, args.convention.into())? {
        Some(rows) if args.max_rms.is_none() && args.materials_in.is_none() => {
            Some(by_rows::<S>(args, kind, rows, &progress)?)
        }
        _ => whole::<S>(args, kind, input, &progress)?,
    };
    let Some(quantized) = quantized else {
        let (most, degrees) = (kind.most_entries(), args.max_rms.unwrap_or_default());
        let reason = format!("no table of up to {most} entries reaches {degrees} degrees RMS; nothing is written");
        warn(&input.display().to_string(), &reason);
        return Ok(Outcome::Negative);
    };
    let entries = quantized.map.table().len();
    if args.max_rms.is_none() && entries < args.entries as usize {
        remark(format!("{}: only {entries} distinct normals, so the table has {entries} entries", input.display()));
    }
    let seconds = started.elapsed().as_secs_f64();
    let bytes = match kind {
        FileKind::Png => progress.step("packing", || io::encode_indexed_png(&quantized.map, args.convention.into()))?,
        FileKind::Ktx2 => progress.step("packing", || io::encode_ktx2(&quantized.map, args.convention.into()))?,
    };
    drop(progress);
    io::write_atomic(output, &bytes)?;
    if output.as_os_str() != "-" {
        report(&quantized, output, bytes.len(), seconds).print(args.json)?;
    }
    Ok(Outcome::Done)
}

/// What is asked for, without what comes from files.
fn options(args: &Args, kind: FileKind) -> Options<'static> {
    Options {
        entries: args.max_rms.map_or(args.entries, |_| kind.most_entries()),
        effort: args.effort.into(),
        materials: None,
        covered: None,
        mip_levels: kind == FileKind::Ktx2 && !args.no_mips,
        dither: args.dither.into(),
    }
}

/// Quantises a map in memory; `None` if no table is good enough.
fn whole<S: Space>(args: &Args, kind: FileKind, input: &Path, progress: &Bars) -> Result<Option<Quantized<S>>> {
    let (image, materials): (_, Option<MaterialMap>) = match args.materials_in {
        Some(place) => {
            let (image, materials) = inputs::normals_with_materials::<S>(input, args.convention.into(), place.into())?;
            (image, Some(materials))
        }
        None => {
            let image = inputs::normals::<S>(input, args.convention.into(), args.repair)?;
            (image, args.materials.as_deref().map(inputs::materials).transpose()?)
        }
    };
    let (materials, covered) = (materials.as_ref(), image.covered.as_ref());
    let options = Options { materials, covered, ..options(args, kind) };
    Ok(match args.max_rms {
        None => Some(quantize::quantize(image.texels(), &options, progress)?),
        Some(degrees) => quantize::quantize_within(image.texels(), degrees.to_radians(), &options, progress)?,
    })
}

/// Quantises a map that is read twice, a band of rows at a time.
fn by_rows<S: Space>(args: &Args, kind: FileKind, rows: NormalRows, progress: &Bars) -> Result<Quantized<S>> {
    let materials = args.materials.as_deref().map(inputs::materials).transpose()?;
    let mut source = LargeMap { rows, materials };
    let quantized = quantize::quantize_rows(&mut source, &options(args, kind), progress)?;
    inputs::tell_of(&source.rows);
    Ok(quantized)
}

/// A large normal map with its materials, which take a byte per texel.
struct LargeMap {
    rows: NormalRows,
    materials: Option<MaterialMap>,
}

impl<S: Space> RowSource<S> for LargeMap {
    type Error = anyhow::Error;

    fn size(&self) -> (u32, u32) {
        self.rows.size()
    }

    fn rows(&mut self, visit: &mut Visit<'_, S, anyhow::Error>) -> Result<()> {
        let Some(materials) = &self.materials else { return self.rows.read(visit) };
        let (expected, actual) = (self.rows.size(), materials.size());
        if expected != actual {
            return Err(rilievo::Error::SizeMismatch { what: "material map", expected, actual }.into());
        }
        let mut done = 0;
        self.rows.read(|band| {
            let part = done..done + band.texels.count();
            done = part.end;
            visit(Band { materials: Some(&materials.texels()[part]), ..band })
        })
    }
}

fn report<S: Space>(quantized: &Quantized<S>, output: &Path, bytes: usize, seconds: f64) -> Report {
    let entries = quantized.map.table().len();
    let mut report = Report::default();
    report
        .add("output", output.display().to_string())
        .add("entries", entries)
        .add_angles(&quantized.error)
        .add_f64("bound_rms_deg", fejes_toth_rms_rad(entries as u32).to_degrees())
        .add_f64("zador_rms_deg", quantized.zador_rms_rad.to_degrees())
        .add_f64s("level_mean_deg", quantized.level_errors.iter().map(|e| e.mean_rad.to_degrees()))
        .add("bytes", bytes)
        .add_f64("seconds", seconds);
    report
}
