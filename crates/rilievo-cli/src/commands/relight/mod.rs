//! `rilievo relight`: the flat map under new light.

mod page;

use std::path::{Path, PathBuf};

use anyhow::Result;
use glam::Vec3;
use rilievo::color::Picture;
use rilievo::light::{Lighting, Material, ShadeTable, relight};
use rilievo::{Normal, NormalTable, QuantizedMap, Rgba8, Space, World};
use rilievo_io::{self as io, AnyIndexed, AnyTable, ImportAs, PalettePng, Source};

use crate::args::{ConventionArg, Given, LightArgs, MaterialArgs, SpaceArg};
use crate::exit::{self, Outcome, remark, usage};
use crate::progress::Bars;
use crate::scene::{LightSpec, MaterialSpec, Surroundings};
use crate::{batch, inputs};

const AFTER_HELP: &str = "\
Examples:
  rilievo relight bricks_256.png --light -60,30
  rilievo relight bricks_256.png --light -60,30,ffddaa --light 80,20,8090ff*0.5 -o lit.png
  rilievo relight vase_2048.ktx2 --frames 36 -o turning_light.png
  rilievo relight palette_made_by_pngquant.png --convention dx
  rilievo relight coin_256.png --model metallic-roughness:1,0.3 --environment studio.hdr --material 0,d4af37
  rilievo relight coin_normal_gl.png --html          -> a page on which the mouse moves the light

An indexed PNG is relit by rewriting its palette: no pixel is decoded. The page of --html does the same in a browser, with the map
inside it and nothing fetched; a map of more than 256 normals, or one that is not indexed, is quantised for it.";

/// Show flat maps under new light.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// Index maps: indexed PNG or KTX2, with --html any normal map too; - is stdin.
    #[arg(required = true, value_name = "INDEXED")]
    inputs: Vec<PathBuf>,
    /// The output picture (PNG; animated with --frames), or a folder for several inputs.
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    #[command(flatten)]
    light: LightArgs,
    #[command(flatten)]
    material: MaterialArgs,
    /// A base colour picture of the map's size.
    #[arg(long, value_name = "PICTURE")]
    color: Option<PathBuf>,
    /// Write a page that relights the map while the mouse, a finger or the arrow keys move its first light.
    #[arg(long)]
    html: bool,
    /// Frames of an animation in which the lights go once round the vertical axis.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10000))]
    frames: u32,
    /// Milliseconds a frame is shown.
    #[arg(long, value_name = "MS", default_value_t = 50)]
    delay: u16,
    /// The space of a palette made by another tool.
    #[arg(long, value_enum)]
    space: Option<SpaceArg>,
    /// Which way green points in a palette made by another tool.
    #[arg(long, value_enum)]
    convention: Option<ConventionArg>,
}

impl Args {
    fn import(&self) -> ImportAs {
        ImportAs { space: self.space.map(Into::into), convention: self.convention.map(Into::into) }
    }
}

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    if args.frames == 1 {
        given.unused(&["delay"], "one frame is no animation; see --frames");
    }
    let (kind, extensions): (_, &[&str]) =
        if args.html { ("relight.html", &["html", "htm"]) } else { ("relit.png", &["png"]) };
    if args.html {
        for flag in ["color", "frames", "environment", "blend"] {
            if given.has(flag) {
                return Err(usage(format!(
                    "--{flag} goes without --html: the page rewrites a palette, and that is all"
                )));
            }
        }
    }
    let name = |input: &Path| format!("{}_{kind}", batch::stem(input));
    let read: Vec<&Path> = args.color.iter().chain(&args.light.environment).map(PathBuf::as_path).collect();
    let light = Light::new(args, given)?;
    batch::run(&args.inputs, args.output.as_deref(), extensions, &read, name, |input, output| {
        convert(args, &light, input, output)
    })
}

/// All light, and how surfaces answer it.
struct Light {
    spec: LightSpec,
    around: Surroundings,
    materials: MaterialSpec,
}

impl Light {
    fn new(args: &Args, given: &Given) -> Result<Self> {
        let (spec, materials) = (args.light.spec(None, given), args.material.spec(&args.light));
        Ok(Self { around: spec.surroundings(materials.mirrors())?, spec, materials })
    }

    fn turned(&self, turn_rad: f32) -> Lighting<World> {
        self.spec.lighting(&self.around, (Vec3::ZERO, 1.0), turn_rad)
    }

    /// Lights a table as seen straight from the front.
    fn table<S: Space>(&self, table: &NormalTable<S>, turn_rad: f32) -> Result<ShadeTable> {
        let materials = self.materials.resolve(materials_of(table), |_| Material::default());
        let shades = ShadeTable::new(table, &materials, &self.turned(turn_rad).facing(), Normal::Z, Vec3::ZERO);
        shades.map_err(|e| usage(e.to_string()))
    }
}

fn convert(args: &Args, light: &Light, input: &Path, output: &Path) -> Result<Outcome> {
    let source = inputs::open(input)?;
    if args.html {
        let page = page::page(&source, &args.import(), &light.spec, &light.materials)?;
        io::write_atomic(output, page.as_bytes())?;
        remark(format!("{}: {:.1} kB", output.display(), page.len() as f64 / 1e3));
        return Ok(Outcome::Done);
    }
    let bytes = if args.frames == 1 && args.color.is_none() && io::is_palette_png(&source) {
        relit_palette(args, light, &source)?
    } else {
        match inputs::indexed(&source, &args.import())?.map {
            AnyIndexed::Tangent(map) => relit_map(args, light, &map, input)?,
            AnyIndexed::Object(map) => relit_map(args, light, &map, input)?,
        }
    };
    io::write_atomic(output, &bytes)?;
    remark(format!("{}: relit", output.display()));
    Ok(Outcome::Done)
}

/// The table of an indexed PNG; what is odd about it is told.
fn table_of(png: &PalettePng<'_>, source: &Source, import: &ImportAs) -> Result<AnyTable> {
    let palette = png.table(import)?;
    for warning in &palette.warnings {
        exit::warn(source.name(), warning);
    }
    Ok(palette.table)
}

/// How many materials a table names.
fn materials_of<S: Space>(table: &NormalTable<S>) -> usize {
    table.spans().last().map_or(1, |span| usize::from(span.material) + 1)
}

/// Rewrites the palette and its checksum; every other byte stays.
fn relit_palette(args: &Args, light: &Light, source: &Source) -> Result<Vec<u8>> {
    let png = PalettePng::parse(source)?;
    let shades = match &table_of(&png, source, &args.import())? {
        AnyTable::Tangent(table) => light.table(table, 0.0)?,
        AnyTable::Object(table) => light.table(table, 0.0)?,
    };
    let colors: Vec<[u8; 3]> = shades.to_srgb(args.light.blend.into()).into_iter().map(Rgba8::rgb).collect();
    Ok(png.relit(&colors)?)
}

fn relit_map<S: Space>(args: &Args, light: &Light, map: &QuantizedMap<S>, input: &Path) -> Result<Vec<u8>> {
    let base: Option<Picture> = args.color.as_deref().map(inputs::picture).transpose()?;
    let progress = Bars::new(input.display().to_string());
    rilievo::Progress::begin(&progress, "relighting", args.frames.into());
    let mut frames = Vec::new();
    for frame in 0..args.frames {
        let turn = frame as f32 / args.frames as f32 * std::f32::consts::TAU;
        let shades = light.table(map.table(), turn)?;
        frames.push(relight(map, &shades, base.as_ref(), args.light.blend.into())?);
        rilievo::Progress::advance(&progress, 1);
    }
    Ok(progress.step("packing", || match frames.as_slice() {
        [only] => io::encode_picture_png(only),
        _ => io::encode_apng(&frames, args.delay),
    })?)
}
