//! `rilievo render`: pictures of surfaces.

use std::path::{Path, PathBuf};

use anyhow::Result;
use rilievo::raster::tile::Skipped;
use rilievo::{Pose, Progress};
use rilievo_io as io;
use serde_json::json;

use crate::args::{
    CameraArg, ColorArg, Given, LightArgs, MaterialArgs, MethodArg, MidpointsArg, OrderArg, PointLightArgs,
    SamplingArg, SizeArg, TableBitsArg, Turn, UnitArg,
};
use crate::batch::check_output;
use crate::exit::{Outcome, remark, usage};
use crate::progress::Bars;
use crate::relief::ReliefArgs;
use crate::report::Report;
use crate::scene::{self, ObjectSpec, PictureSpec, SceneSpec};
use crate::shoot::{Painter, Painting, Stage, check_size};
use crate::surface::SurfaceArg;

const AFTER_HELP: &str = "\
Examples:
  rilievo render vase                                               -> vase_table.png
  rilievo render sphere --height earth.png --depth 0.01 --color earth.jpg -n 2048
  rilievo render cube --height bricks.png --color bricks_color.png --camera 35,25
  rilievo render rock.obj --normals rock_n.png --method exact --size 1024 --supersample 2
  rilievo render plane --height dem.tif --edges clamp --depth 0.08 --light -60,25
  rilievo render vase --frames 36 -o turntable.png                  an animated PNG
  rilievo render torus:16x9 --method exact -o smooth.png            no map: the mesh's own normals
  rilievo render vase --model chrome
  rilievo render rock.obj --normals rock_n.png --model environment:0.2 --environment city.hdr
  rilievo render vase --model metallic-roughness:1,0.35 --environment city.hdr --material 1,d0a040
  rilievo render vase --method exact --point-light -60,20,1.3,ffc080*2
  rilievo render torus:16x9 --normals waves_gl.png --repeat 6,2 --method quadratic
  rilievo render sphere --normals waves_gl.png --method polar --unit published
  rilievo render scene.toml --size 1920x1080 --supersample 2        several objects; see docs/scenes.md

A scene file says what is drawn; of the flags, those of the picture are taken over it: -o, --method, --order, --midpoints,
--unit, --table-bits, --sampling, --size, --camera, --background, --supersample, --antialias, --frames, --turn, --delay.

table and static look up an object-space map; exact takes any; linear, normalized and quadratic interpolate light and half
vectors and take tangent-space maps, height maps (as flat normals: how a texture is stretched on the mesh is not seen), or the
mesh's own normals. polar draws with the integer model of a bump unit in hardware, from any map; its lights are directional where the
unit holds them in tables (kugler, e4d).

The report: seconds_per_frame is a frame with its tables, table_seconds the tables alone, map_seconds what the renderer takes once to
make the maps its own. Triangles that were left out are counted under skipped; --reference does not count them.

--camera and --light turn the same way: azimuth 0 is the front, 90 the right; elevation goes up.";

/// Render a mesh or a built-in shape with its maps, or a scene file.
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
    /// The degree of the quadratic method's polynomials.
    #[arg(long, value_enum, default_value_t = OrderArg::Auto)]
    order: OrderArg,
    /// Where the quadratic method's vectors in the middle of an edge come from.
    #[arg(long, value_enum, default_value_t = MidpointsArg::GramSchmidt)]
    midpoints: MidpointsArg,
    /// The polar method's unit: blinn, peercy, kugler, kim, published, exact-z, e1, e2, e3, e4 or e4d.
    #[arg(long, value_name = "UNIT", default_value = "e3")]
    unit: UnitArg,
    /// Address bits of its tables, 4 to 14.
    #[arg(long, value_name = "A", default_value = "8")]
    table_bits: TableBitsArg,
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
    points: PointLightArgs,
    #[command(flatten, next_help_heading = "Light")]
    material: MaterialArgs,
    /// Colour behind the object [default: transparent].
    #[arg(long, value_name = "COLOR")]
    background: Option<ColorArg>,
    /// Render at N x N the size and average, in linear light.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    supersample: u32,
    /// Look at four places of each pixel: smooth outlines, for little more time.
    ///
    /// Surfaces are still shaded once a pixel; --supersample smooths what is on them too, and takes N x N times as long.
    #[arg(long)]
    antialias: bool,
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
    /// Draw with the scalar reference renderer, slow and exact.
    #[arg(long)]
    reference: bool,
    /// Print the report as JSON.
    #[arg(long)]
    json: bool,
}

/// Flags that a scene file leaves to the command line, by their names in [`Given`].
const PICTURE_FLAGS: [&str; 18] = [
    "surface",
    "output",
    "method",
    "order",
    "midpoints",
    "unit",
    "table_bits",
    "sampling",
    "size",
    "camera",
    "background",
    "supersample",
    "antialias",
    "frames",
    "turn",
    "delay",
    "reference",
    "json",
];

/// The most bytes all frames of an animation may take, since they are kept until the file is written.
const MAX_ANIMATION_BYTES: u64 = 4 << 30;

impl Args {
    /// What the command line asks for.
    fn spec(&self, given: &Given) -> SceneSpec {
        let name = self.relief.surface.stem();
        let object = ObjectSpec {
            name: name.clone(),
            relief: self.relief.clone(),
            given: given.clone(),
            pose: Pose::IDENTITY,
            materials: self.material.spec(&self.light),
            blend: self.light.blend.into(),
            double_sided: self.double_sided,
        };
        SceneSpec {
            name,
            file: None,
            objects: vec![object],
            light: self.light.spec(Some(&self.points), given),
            camera: self.camera.0,
            picture: PictureSpec {
                output: self.output.clone(),
                method: self.method,
                order: self.order,
                midpoints: self.midpoints,
                unit: self.unit,
                table_bits: self.table_bits,
                sampling: self.sampling,
                size: self.size,
                background: self.background.map(|c| c.0),
                samples: self.supersample,
                antialias: self.antialias,
                frames: self.frames,
                turn: self.turn,
                delay: self.delay,
                reference: self.reference,
            },
        }
    }

    /// The scene of a file, its picture as the command line has it where it says something.
    fn scene(&self, path: &Path, given: &Given) -> Result<SceneSpec> {
        let (mut spec, mut keys) = scene::read(path)?;
        given.unused_but(&PICTURE_FLAGS, &format!("{} says what is drawn", path.display()));
        let SceneSpec { picture: own, camera, .. } = self.spec(given);
        let picture = &mut spec.picture;
        over(given.has("output"), own.output, &mut picture.output);
        over(given.has("method"), own.method, &mut picture.method);
        over(given.has("order"), own.order, &mut picture.order);
        over(given.has("midpoints"), own.midpoints, &mut picture.midpoints);
        over(given.has("unit"), own.unit, &mut picture.unit);
        over(given.has("table_bits"), own.table_bits, &mut picture.table_bits);
        over(given.has("sampling"), own.sampling, &mut picture.sampling);
        over(given.has("size"), own.size, &mut picture.size);
        over(given.has("background"), own.background, &mut picture.background);
        over(given.has("supersample"), own.samples, &mut picture.samples);
        picture.antialias |= own.antialias;
        over(given.has("frames"), own.frames, &mut picture.frames);
        over(given.has("turn"), own.turn, &mut picture.turn);
        over(given.has("delay"), own.delay, &mut picture.delay);
        over(given.has("camera"), camera, &mut spec.camera);
        spec.picture.reference = own.reference;
        if given.has("method") {
            // One file serves several methods: what is for another one is no mistake of the file's.
            spec.objects.iter_mut().for_each(|o| o.given.excuse(&["map_size", "gutter", "entries", "effort"]));
            keys.excuse(&["order", "midpoints", "unit", "table_bits"]);
        }
        spec.picture.warn_of_unused(&keys);
        Ok(spec)
    }
}

/// Takes what the command line says, if it was written, over what the scene file says.
fn over<T>(written: bool, mine: T, theirs: &mut T) {
    if written {
        *theirs = mine;
    }
}

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    let spec = match &args.relief.surface {
        SurfaceArg::File(path) if scene::is_scene(path) => args.scene(path, given)?,
        _ => args.spec(given),
    };
    let picture = &spec.picture;
    let method = picture.method.name();
    let output = picture.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}_{method}.png", spec.name)));
    check_output(&output, &["png"], &spec.files())?;
    picture.warn_of_unused(given);
    check_size(picture)?;
    check_animation(picture)?;

    let stage = Stage::load(&spec)?;
    let baked = stage.bake()?;
    let mut painter = Painter::new(picture)?;
    let progress = Bars::new(spec.name.as_str());
    progress.begin("rendering", picture.frames.into());
    let mut paintings = Vec::new();
    for frame in 0..picture.frames {
        paintings.push(painter.paint(&stage.scene(frame, &baked)?)?);
        progress.advance(1);
    }
    let report = report(&stage, picture, &output, &paintings, painter.map_seconds());
    let pictures: Vec<_> = paintings.into_iter().map(|p| p.picture).collect();
    let bytes = progress.step("packing", || match pictures.as_slice() {
        [only] => io::encode_picture_png(only),
        _ => io::encode_apng(&pictures, picture.delay),
    })?;
    drop(progress);
    io::write_atomic(&output, &bytes)?;
    remark(format!("{}: {} x {}", output.display(), picture.size.width, picture.size.height));
    if output.as_os_str() != "-" {
        report.print(args.json)?;
    }
    Ok(Outcome::Done)
}

fn check_animation(picture: &PictureSpec) -> Result<()> {
    let (frames, size) = (picture.frames, picture.size);
    let bytes = u64::from(frames) * u64::from(size.width) * u64::from(size.height) * 4;
    if frames > 1 && bytes > MAX_ANIMATION_BYTES {
        let gigabytes = bytes as f64 / 1e9;
        return Err(usage(format!("{frames} frames of this size take {gigabytes:.1} GB, and 4 GiB is the limit")));
    }
    Ok(())
}

/// Times are means over the frames, counts of pixels and triangles those of the last frame.
fn report(
    stage: &Stage<'_>,
    picture: &PictureSpec,
    output: &Path,
    paintings: &[Painting],
    map_seconds: Option<f64>,
) -> Report {
    let mean = |of: fn(&Painting) -> f64| paintings.iter().map(of).sum::<f64>() / paintings.len() as f64;
    let reliefs = || stage.props().iter().map(|p| &p.relief);
    let triangles = |of: fn(&rilievo::surface::Mesh) -> usize| reliefs().map(|r| of(&r.mesh)).sum::<usize>();
    let dropped = triangles(rilievo::surface::Mesh::dropped_triangles);
    let mut report = Report::default();
    report
        .add("output", output.display().to_string())
        .add("method", picture.method.name())
        .add("renderer", if picture.reference { "reference" } else { "tiles" })
        .add("frames", picture.frames)
        .add_f64("seconds_per_frame", mean(|p| p.seconds))
        .add_f64("table_seconds", mean(|p| p.table_seconds));
    if let Some(seconds) = map_seconds {
        report.add_f64("map_seconds", seconds);
    }
    if let Some(last) = paintings.last() {
        report.add("covered_pixels", last.covered_pixels);
        if let Some(skipped) = last.skipped {
            remark_skipped(&skipped);
            report.add(
                "skipped",
                json!({
                    "outside": skipped.outside,
                    "back_facing": skipped.back_facing,
                    "too_small": skipped.too_small,
                    "without_area": dropped,
                }),
            );
        }
    }
    report.add("objects", stage.props().len()).add("triangles", triangles(|m| m.triangles().len()));
    let made: Vec<_> = reliefs().filter_map(|r| r.quantized.as_ref()).collect();
    if !made.is_empty() {
        report.add("entries", made.iter().map(|m| m.entries).sum::<usize>());
    }
    match made.as_slice() {
        [] => {}
        [only] => _ = report.add_angles(&only.error),
        several => {
            report.add_f64s("object_rms_deg", several.iter().map(|m| m.error.rms_rad.to_degrees()));
        }
    }
    if !made.is_empty() {
        report.add_f64("quantize_seconds", made.iter().map(|m| m.seconds).sum());
    }
    report
}

/// Tells of triangles that are not in the picture. (Of a closed surface half are turned away: that is no news. Those
/// without an area were told of when the mesh was read.)
fn remark_skipped(skipped: &Skipped) {
    let counts = [
        (skipped.outside, "outside the view or behind the camera"),
        (skipped.too_small, "too small to cover the middle of a pixel"),
    ];
    let told: Vec<String> = counts.iter().filter(|(n, _)| *n > 0).map(|(n, why)| format!("{n} {why}")).collect();
    if !told.is_empty() {
        remark(format!("triangles left out: {}", told.join(", ")));
    }
}

/// What a command line of `render` asks for, its first word being the surface.
#[cfg(test)]
pub(crate) fn asked_for(words: &[&str]) -> SceneSpec {
    use clap::{Args as _, FromArgMatches};

    let program = clap::Command::new("rilievo").subcommand(Args::augment_args(clap::Command::new("render")));
    let matches = program.clone().get_matches_from([&["rilievo", "render"], words].concat());
    let render = matches.subcommand_matches("render").expect("that is the command");
    Args::from_arg_matches(render).expect("these are flags of it").spec(&Given::of(&program, &matches))
}
