//! `rilievo render`: pictures of surfaces.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use clap::ValueEnum;
use rilievo::color::Picture;
use rilievo::raster::{self, Frame, Method, Object, Scene, Target};
use rilievo::{Pose, Progress};
use rilievo_io as io;

use crate::args::{CameraArg, ColorArg, Given, LightArgs, MaterialArgs, MethodArg, SamplingArg, SizeArg};
use crate::batch::{check_output, named};
use crate::exit::{Outcome, remark, usage};
use crate::progress::Bars;
use crate::relief::{Relief, ReliefArgs};
use crate::report::Report;

const AFTER_HELP: &str = "\
Examples:
  rilievo render vase                                               -> vase_table.png
  rilievo render sphere --height earth.png --depth 0.01 --color earth.jpg -n 2048
  rilievo render cube --height bricks.png --color bricks_color.png --camera 35,25
  rilievo render rock.obj --normals rock_n.png --method exact --size 1024 --supersample 2
  rilievo render plane --height dem.tif --edges clamp --depth 0.08 --light -60,25
  rilievo render vase --frames 36 -o turntable.png                  an animated PNG
  rilievo render torus:16x9 --method exact -o smooth.png            no map: the mesh's own normals

--camera and --light turn the same way: azimuth 0 is the front, 90 the right; elevation goes up.";

/// Render a mesh or a built-in shape with its maps.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    #[command(flatten)]
    relief: ReliefArgs,
    /// The output: a PNG, animated with --frames.
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// How normals become colours.
    #[arg(long, value_enum, default_value_t = MethodArg::Table)]
    method: MethodArg,
    /// How a pixel gathers texels.
    #[arg(long, value_enum, default_value_t = SamplingArg::Trilinear)]
    sampling: SamplingArg,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "768x768")]
    size: SizeArg,
    /// An orbit about the object in degrees; DISTANCE 1 just fits it into the picture.
    #[arg(long, value_name = "AZ,EL[,DISTANCE[,FOV]]", default_value = "0,15,1.05,30", allow_hyphen_values = true)]
    camera: CameraArg,
    #[command(flatten, next_help_heading = "Light")]
    light: LightArgs,
    #[command(flatten, next_help_heading = "Light")]
    material: MaterialArgs,
    /// Colour behind the object [default: transparent].
    #[arg(long, value_name = "COLOR")]
    background: Option<ColorArg>,
    /// Render at N x N the size and average, in linear light.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    supersample: u32,
    /// Draw back faces too.
    #[arg(long)]
    double_sided: bool,
    /// Frames of an animation, once round.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10000))]
    frames: u32,
    /// What goes round in an animation.
    #[arg(long, value_enum, default_value_t = Turn::Object)]
    turn: Turn,
    /// Milliseconds a frame is shown.
    #[arg(long, value_name = "MS", default_value_t = 50)]
    delay: u16,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Turn {
    Object,
    Light,
    Camera,
}

/// The most bytes all frames of an animation may take, since they are kept until the file is written.
const MAX_ANIMATION_BYTES: u64 = 4 << 30;

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    let method = Method::from(args.method);
    let name = args.method.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
    let default_output = || PathBuf::from(format!("{}_{name}.png", args.relief.surface.stem()));
    let output = args.output.clone().unwrap_or_else(default_output);
    check_output(&output, &["png"], &args.relief.files())?;
    if args.frames == 1 {
        given.unused(&["turn", "delay"], "one frame is no animation; see --frames");
    }
    let bytes = u64::from(args.frames) * u64::from(args.size.width) * u64::from(args.size.height) * 4;
    if args.frames > 1 && bytes > MAX_ANIMATION_BYTES {
        let message =
            format!("{} frames of this --size take {:.1} GB, and 4 GiB is the limit", args.frames, bytes as f64 / 1e9);
        return Err(usage(message));
    }
    let n = args.supersample;
    let target = Target::new(args.size.width.saturating_mul(n), args.size.height.saturating_mul(n))?;
    let relief = args.relief.load(method, given).map_err(|e| named(e, Path::new(&args.relief.surface.stem())))?;
    if let Some(made) = &relief.quantized {
        let (entries, rms) = (made.entries, made.error.rms_rad.to_degrees());
        remark(format!("{}: {entries} entries, {rms:.3} degrees RMS", args.relief.surface.stem()));
    }
    let mut shoot = Shoot::new(args, &relief, target);
    let progress = Bars::new(args.relief.surface.stem());
    progress.begin("rendering", args.frames.into());
    let mut pictures = Vec::new();
    for frame in 0..args.frames {
        pictures.push(shoot.frame(frame)?);
        progress.advance(1);
    }
    let bytes = progress.step("packing", || match pictures.as_slice() {
        [only] => io::encode_picture_png(only),
        _ => io::encode_apng(&pictures, args.delay),
    })?;
    drop(progress);
    io::write_atomic(&output, &bytes)?;
    remark(format!("{}: {} x {}", output.display(), args.size.width, args.size.height));
    if output.as_os_str() != "-" {
        shoot.report(&name, &output).print(args.json)?;
    }
    Ok(Outcome::Done)
}

/// The frames of one call, and what they took.
struct Shoot<'a> {
    args: &'a Args,
    relief: &'a Relief,
    target: Target,
    materials: Vec<rilievo::light::Material>,
    table_seconds: f64,
    draw_seconds: f64,
}

impl<'a> Shoot<'a> {
    fn new(args: &'a Args, relief: &'a Relief, target: Target) -> Self {
        let materials = args.material.resolve(relief.material_count(), |m| relief.default_materials.material(m));
        let materials = materials.into_iter().map(|m| args.light.apply(m)).collect();
        Self { args, relief, target, materials, table_seconds: 0.0, draw_seconds: 0.0 }
    }

    fn frame(&mut self, frame: u32) -> Result<Picture> {
        let args = self.args;
        let turn = frame as f32 / args.frames as f32 * std::f32::consts::TAU;
        let turn_of = |what: Turn| if args.turn == what { turn } else { 0.0 };
        let object = Object {
            // About the middle of the object, not about its origin.
            pose: Pose::turned_about(self.relief.mesh.bounding_sphere().0, turn_of(Turn::Object)),
            base_color: self.relief.base_color(),
            double_sided: args.double_sided,
            edges: args.relief.edges(),
            ..Object::new(&self.relief.mesh, self.relief.detail(), &self.materials)
        };
        let aspect = args.size.width as f32 / args.size.height as f32;
        let scene = Scene {
            objects: vec![object],
            lighting: args.light.lighting(turn_of(Turn::Light)),
            camera: args.camera.turned(turn_of(Turn::Camera)).resolve(&self.relief.mesh, aspect)?,
        };
        let started = Instant::now();
        let prepared: Frame<'_> = raster::prepare(&scene, args.method.into(), args.sampling.into())?;
        let lit = Instant::now();
        self.target.clear();
        raster::draw(&prepared, &mut self.target);
        self.table_seconds += (lit - started).as_secs_f64();
        self.draw_seconds += lit.elapsed().as_secs_f64();
        Ok(self.target.resolve(args.supersample, args.background.map(|c| c.0))?)
    }

    fn report(&self, method: &str, output: &std::path::Path) -> Report {
        let frames = f64::from(self.args.frames);
        let mut report = Report::default();
        report
            .add("output", output.display().to_string())
            .add("method", method)
            .add("frames", self.args.frames)
            .add_f64("seconds_per_frame", (self.table_seconds + self.draw_seconds) / frames)
            .add_f64("table_seconds", self.table_seconds / frames)
            .add("covered_pixels", self.target.covered_pixels() / u64::from(self.args.supersample).pow(2));
        if let Some(quantized) = &self.relief.quantized {
            report
                .add("entries", quantized.entries)
                .add_angles(&quantized.error)
                .add_f64("quantize_seconds", quantized.seconds);
        }
        report
    }
}
