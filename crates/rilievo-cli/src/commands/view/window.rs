//! The viewer, as part of the program.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use clap::ValueEnum;
use rilievo_viewer::look::Way;
use rilievo_viewer::subject::{File, Recipe, Sample, Surface};
use rilievo_viewer::{Start, run as open};

use crate::args::{ConventionArg, EffortArg};
use crate::exit::{Outcome, usage};

const AFTER_HELP: &str = "\
Examples:
  rilievo view                                      the built-in vase
  rilievo view bricks.png --depth 0.04              a height map, on a plane
  rilievo view scan.obj scan_normals_256.png        a mesh and its index map
  rilievo view earth.png --on sphere --compare exact

Drag to turn, drag with the right button (or Shift) to move the light, wheel to zoom; 1 to 9 choose the
method, S splits the picture, Space lets the light go round. Files can be dropped on the window.";

/// Look at a surface: turn it, light it, compare methods.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// A map (heights, normals, indexed PNG or KTX2), a mesh (OBJ, PLY, GLB), or one of each.
    #[arg(value_name = "FILE", num_args = 0..=2)]
    files: Vec<PathBuf>,
    /// What there is to see without a file.
    #[arg(long, value_enum, default_value_t = SampleArg::Vase, conflicts_with = "files")]
    sample: SampleArg,
    /// What a map is laid on, if there is no mesh.
    #[arg(long, value_enum, default_value_t = OnArg::Plane)]
    on: OnArg,
    /// Entries of the table of normals.
    #[arg(short = 'n', long, value_name = "K", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(2..=65536))]
    entries: u32,
    /// How hard the quantiser tries.
    #[arg(long, value_enum, default_value_t = EffortArg::Fast)]
    effort: EffortArg,
    /// Height of full white as a fraction of the map's width.
    #[arg(long, value_name = "D", default_value_t = 0.05, value_parser = depth)]
    depth: f32,
    /// Which way green points in a normal map.
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl)]
    convention: ConventionArg,
    /// How normals become colours at first.
    #[arg(long, value_enum, default_value_t = WayArg::Table)]
    method: WayArg,
    /// Split the picture, and draw the right part by this method.
    #[arg(long, value_enum, value_name = "METHOD")]
    compare: Option<WayArg>,
    /// Draw by CPU though there is a GPU.
    #[arg(long)]
    cpu: bool,
}

/// A sample by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum SampleArg {
    /// A Greek vase.
    Vase,
    /// A wall.
    Bricks,
    /// A floor.
    Planks,
    /// A world.
    Globe,
}

/// A shape by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum OnArg {
    /// A flat sheet.
    Plane,
    /// A sphere.
    Sphere,
    /// A torus.
    Torus,
}

/// A method by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum WayArg {
    /// Look-up in a lit table of normals.
    Table,
    /// Every pixel by itself.
    Exact,
    /// A light map, baked once.
    Static,
    /// The table expanded by the CPU for each frame.
    Expanded,
    /// Interpolated vectors.
    Linear,
    /// Interpolated vectors, normalised.
    Normalized,
    /// Interpolated vectors, quadratic.
    Quadratic,
    /// A polar bump unit.
    PolarE2,
    /// Another polar bump unit.
    PolarE3,
}

impl From<WayArg> for Way {
    fn from(arg: WayArg) -> Self {
        match arg {
            WayArg::Table => Self::Table,
            WayArg::Exact => Self::Exact,
            WayArg::Static => Self::Static,
            WayArg::Expanded => Self::Expanded,
            WayArg::Linear => Self::Linear,
            WayArg::Normalized => Self::Normalized,
            WayArg::Quadratic => Self::Quadratic,
            WayArg::PolarE2 => Self::PolarE2,
            WayArg::PolarE3 => Self::PolarE3,
        }
    }
}

fn depth(text: &str) -> Result<f32, String> {
    let depth: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if depth.is_finite() && depth > 0.0 { Ok(depth) } else { Err("a number above 0".to_owned()) }
}

pub(crate) fn run(args: Args) -> Result<Outcome> {
    let mut start =
        Start { way: args.method.into(), other: args.compare.map(Into::into), by_cpu: args.cpu, ..Start::default() };
    for path in &args.files {
        let file = File::read(path)?;
        if start.files.iter().any(|f| f.is_mesh() == file.is_mesh()) {
            return Err(usage(format!("{}: one mesh and one map at most", path.display())));
        }
        start.files.push(file);
    }
    let sample = match args.sample {
        SampleArg::Vase => Sample::Vase,
        SampleArg::Bricks => Sample::Bricks,
        SampleArg::Planks => Sample::Planks,
        SampleArg::Globe => Sample::Globe,
    };
    start.recipe = Recipe {
        sample: args.files.is_empty().then_some(sample),
        surface: match args.on {
            OnArg::Plane => Surface::Plane,
            OnArg::Sphere => Surface::Sphere,
            OnArg::Torus => Surface::Torus,
        },
        entries: args.entries,
        effort: args.effort.into(),
        depth: args.depth,
        convention: args.convention.into(),
        ..Recipe::default()
    };
    open(start)
        .map_err(|why| anyhow!("no window can be opened: {why}; `rilievo render` makes pictures without one"))?;
    Ok(Outcome::Done)
}
