//! `rilievo normal`: height maps to normal maps.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::ValueEnum;
use rilievo::height;
use rilievo::normal::{DitherU8, NormalMap, encode_map_u8};
use rilievo::surface::{deflect_heights, deflect_normals};
use rilievo::{Grid, Object, Space, Tangent};
use rilievo_io as io;

use crate::args::{Bits, ConventionArg, Given, HeightArgs, OntoArgs};
use crate::exit::{Outcome, remark, usage};
use crate::progress::Bars;
use crate::surface::SurfaceArg;
use crate::{batch, inputs};

const AFTER_HELP: &str = "\
Examples:
  rilievo normal bricks.png --depth 0.04             -> bricks_normal_gl.png, 16 bits
  rilievo normal dem.tif --edges clamp --depth 0.03 -o dem_normal.exr
  rilievo normal *.png --convention dx --bits 8 --dither diffusion
  rilievo normal earth.png --onto sphere --depth 0.01 -o earth_object.png
  rilievo normal rock_n.png --from normal --onto rock.obj
  cat h.png | rilievo normal - -o - > n.png

Heights: white is up. --depth is the height of full white as a fraction of the map's width.";

/// Make normal maps of height maps, flat or bent onto a mesh.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Height maps: PNG, JPEG, TIFF, EXR or NPY; - is stdin.
    #[arg(required = true, value_name = "HEIGHT")]
    inputs: Vec<PathBuf>,
    /// The output: a file, or a folder for several inputs. The extension chooses PNG or EXR (32-bit float).
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// What the inputs are: height maps, or tangent-space normal maps to be bent onto a mesh.
    #[arg(long, value_enum, default_value_t = InputKind::Height)]
    from: InputKind,
    /// Make an object-space map for this mesh or shape (see `rilievo render --help` for the shapes).
    #[arg(long, value_name = "MESH")]
    onto: Option<SurfaceArg>,
    /// Which way green points in written tangent-space maps, and in normal maps read.
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl)]
    convention: ConventionArg,
    /// Bits per component of PNG output.
    #[arg(long, value_enum, default_value = "16")]
    bits: Bits,
    /// Dithering to 8 bits, done on normals.
    #[arg(long, value_enum, default_value_t = Dither::None)]
    dither: Dither,
    #[command(flatten)]
    height: HeightArgs,
    #[command(flatten)]
    deflect: OntoArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum InputKind {
    Height,
    Normal,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Dither {
    None,
    /// By a mask: the same at every frame, no worms.
    BlueNoise,
    /// Error diffusion: the least error over an area.
    Diffusion,
}

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    if args.from == InputKind::Normal && args.onto.is_none() {
        return Err(usage("--from normal needs --onto MESH: a tangent-space map is bent onto a mesh"));
    }
    if args.dither != Dither::None && args.bits != Bits::Eight {
        return Err(usage("--dither needs --bits 8: 16 bits have nothing to dither"));
    }
    if args.onto.is_none() {
        given.unused(&["repeat", "map_size", "gutter"], "they are for --onto");
    } else {
        let read = args.from == InputKind::Normal;
        given.unused(if read { &[] } else { &["convention"] }, "object-space maps have no up the picture");
    }
    if args.from == InputKind::Normal {
        given.unused(&["depth", "filter", "edges"], "they are for height maps");
    }
    if args.output.as_deref().is_some_and(is_exr) {
        given.unused(&["bits", "dither"], "an EXR holds 32-bit floats");
    }
    let space = if args.onto.is_some() { "object" } else { args.convention.suffix() };
    batch::run(
        &args.inputs,
        args.output.as_deref(),
        &["png", "exr"],
        &args.onto.iter().filter_map(SurfaceArg::path).collect::<Vec<_>>(),
        |input| format!("{}_normal_{space}.png", batch::stem(input)),
        |input, output| convert(args, input, output),
    )
}

fn convert(args: &Args, input: &Path, output: &Path) -> Result<Outcome> {
    let progress = Bars::new(input.display().to_string());
    let (filter, edges) = (args.height.filter(), args.height.edges());
    if let Some(onto) = &args.onto {
        let deflected = if args.from == InputKind::Normal {
            let image = inputs::normals::<Tangent>(input, args.convention.into(), false)?;
            let options = args.deflect.options(onto, image.normals.size())?;
            let mesh = onto.load(image.normals.size())?;
            deflect_normals(&mesh.with_tangents()?, &image.normals, image.covered.as_ref(), &options, &progress)?
        } else {
            let (map, covered) = inputs::height_map(input, args.height.depth)?;
            let options = args.deflect.options(onto, map.heights().size())?;
            let mesh = onto.load(map.heights().size())?;
            deflect_heights(&mesh, &map, covered.as_ref(), filter, edges, &options, &progress)?
        };
        crate::relief::remark_overlaps(&deflected);
        write::<Object>(args, &deflected.normals, Some(&deflected.covered), output, progress)?;
    } else {
        let (map, covered) = inputs::height_map(input, args.height.depth)?;
        let normals = progress.step("height to normal", || height::to_normals(&map, filter, edges));
        write::<Tangent>(args, &normals, covered.as_ref(), output, progress)?;
    }
    Ok(Outcome::Done)
}

fn is_exr(output: &Path) -> bool {
    output.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"))
}

fn write<S: Space>(
    args: &Args,
    normals: &NormalMap<S>,
    covered: Option<&Grid<bool>>,
    output: &Path,
    progress: Bars,
) -> Result<()> {
    let bytes = progress.step("packing", || encode(args, normals, covered, output))?;
    // Before anything else is said on stderr.
    drop(progress);
    io::write_atomic(output, &bytes)?;
    remark(format!("{}: {} x {} {}-space normals", output.display(), normals.width(), normals.height(), S::NAME));
    Ok(())
}

fn encode<S: Space>(
    args: &Args,
    normals: &NormalMap<S>,
    covered: Option<&Grid<bool>>,
    output: &Path,
) -> io::Result<Vec<u8>> {
    // Object space has no "up the picture": its maps are always +Y.
    let convention = if S::NAME == Object::NAME { ConventionArg::Gl } else { args.convention };
    if is_exr(output) {
        io::encode_normals_exr(normals, convention.into(), covered)
    } else if args.bits == Bits::Sixteen {
        io::encode_normals_png16(normals, convention.into(), covered)
    } else {
        let dither = match args.dither {
            Dither::None => DitherU8::None,
            Dither::BlueNoise => DitherU8::BlueNoise,
            Dither::Diffusion => DitherU8::Diffusion,
        };
        let turned = normals.map(|&n| rilievo::Convention::from(convention).apply(n));
        io::encode_normals_png8(&encode_map_u8(&turned, dither), covered)
    }
}
