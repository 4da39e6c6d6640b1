//! Scene files (TOML): docs/scenes.md says what stands in them, a test holds the two together.
//!
//! Tables are read key by key from the parsed file, not by derived code: so every error has its line and key (derived
//! code loses them where tables of several kinds share a list), values are read by the same code as flags, and what plays no
//! part can be told by its place.

mod light;
mod material;
mod object;
mod section;
#[cfg(test)]
mod tests;

use std::path::Path;

use anyhow::{Context, Result};
use glam::Vec3;
use rilievo::polar::{UnitKind, Width};

use self::section::{Section, Text};
use super::{CameraSpec, PictureSpec, SceneSpec};
use crate::args::{
    ColorArg, Given, MethodArg, MidpointsArg, OrderArg, SamplingArg, SizeArg, TableBitsArg, Turn, UnitArg,
};
use crate::batch::stem;
use crate::exit::BadInput;

/// Larger files are not scenes.
const MAX_BYTES: u64 = 4 << 20;
/// Coordinates of the world.
const WORLD: std::ops::RangeInclusive<f32> = -1e6..=1e6;
/// Lengths in the world.
const LENGTH: std::ops::RangeInclusive<f32> = 1e-6..=1e6;
/// Angles in degrees.
const ANGLE: std::ops::RangeInclusive<f32> = -36_000.0..=36_000.0;
/// Angles above the horizon, in degrees.
const ELEVATION: std::ops::RangeInclusive<f32> = -90.0..=90.0;

/// Whether a path is that of a scene, and not of a mesh.
pub(crate) fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

/// Reads a scene file; beside the scene, which keys of its picture are written.
///
/// # Errors
/// Whatever is wrong in the file, with its line and key; files it names that are not there.
pub(crate) fn read(path: &Path) -> Result<(SceneSpec, Given)> {
    let named = || path.display().to_string();
    let bytes = std::fs::metadata(path).with_context(named)?.len();
    if bytes > MAX_BYTES {
        let limit = MAX_BYTES >> 20;
        return Err(BadInput(format!("{}: {bytes} bytes; a scene file has at most {limit} MiB", named())).into());
    }
    let content = std::fs::read(path).with_context(named)?;
    let content = String::from_utf8(content)
        .map_err(|e| BadInput(format!("{}: is not UTF-8 text: {}", named(), e.utf8_error())))?;
    scene(&Text::new(path, &content), path)
}

fn scene(text: &Text<'_>, path: &Path) -> Result<(SceneSpec, Given)> {
    let parsed = text.parse()?;
    let mut root = Section::root(text, parsed.get_ref());
    let materials = material::all(&mut root)?;
    let objects = root.sections("objects", "[[objects]]")?.unwrap_or_default();
    if objects.is_empty() {
        return Err(root.wrong("objects", "is missing: a scene has at least one [[objects]]"));
    }
    let objects = objects.into_iter().map(|section| object::read(section, &materials)).collect::<Result<_>>()?;
    let light = light::read(&mut root)?;
    let camera = root.section("camera", "[camera]")?.map(camera).transpose()?;
    let (picture, given) = match root.section("picture", "[picture]")? {
        Some(section) => picture(section)?,
        None => (default_picture(), Given::default()),
    };
    root.finish()?;
    let (name, file) = (stem(path), Some(path.to_owned()));
    let camera = camera.unwrap_or(DEFAULT_CAMERA);
    Ok((SceneSpec { name, file, objects, light, camera, picture }, given))
}

/// As the command line has it.
const DEFAULT_CAMERA: CameraSpec = CameraSpec::Orbit {
    azimuth_rad: 0.0,
    elevation_rad: 15f32.to_radians(),
    distance: 1.05,
    fov_y_rad: 30f32.to_radians(),
    target: None,
};

fn camera(mut section: Section<'_>) -> Result<CameraSpec> {
    let eye = section.numbers::<3>("eye", WORLD)?.map(Vec3::from_array);
    let target = section.numbers::<3>("target", WORLD)?.map(Vec3::from_array);
    let fov_y_rad = section.number("fov", 0.1..=170.0)?.unwrap_or(30.0).to_radians();
    let azimuth_rad = section.number("azimuth", ANGLE)?.unwrap_or(0.0).to_radians();
    let elevation_rad = section.number("elevation", ELEVATION)?.unwrap_or(15.0).to_radians();
    let distance = section.number("distance", 0.01..=10_000.0)?.unwrap_or(1.05);
    let up = section.numbers::<3>("up", -1.0..=1.0)?.map_or(Vec3::Y, Vec3::from_array);
    let (near, far) = (section.number("near", LENGTH)?, section.number("far", LENGTH)?);
    let (orbit, free) = (["azimuth", "elevation", "distance"], ["up", "near", "far"]);
    let misplaced = if eye.is_some() { orbit } else { free };
    if let Some(key) = misplaced.into_iter().find(|key| section.has(key)) {
        return Err(section.wrong(
            key,
            match eye {
                Some(_) => "is for a camera on an orbit; this one has an `eye`",
                None => "is for a camera with an `eye`; this one is on an orbit",
            },
        ));
    }
    if eye.is_some() && eye == target {
        return Err(section.wrong("eye", "is where the `target` is; there is nowhere to look"));
    }
    if near >= far && far.is_some() {
        return Err(section.wrong("near", "must be less than `far`"));
    }
    section.finish()?;
    Ok(match eye {
        Some(eye) => CameraSpec::Eye { eye, target, up, fov_y_rad, near, far },
        None => CameraSpec::Orbit { azimuth_rad, elevation_rad, distance, fov_y_rad, target },
    })
}

/// As the command line has it.
fn default_picture() -> PictureSpec {
    PictureSpec {
        output: None,
        method: MethodArg::Table,
        order: OrderArg::Auto,
        midpoints: MidpointsArg::GramSchmidt,
        unit: UnitArg(UnitKind::E3),
        table_bits: TableBitsArg(Width::PAPER),
        sampling: SamplingArg::Trilinear,
        size: SizeArg { width: 768, height: 768 },
        background: None,
        samples: 1,
        antialias: false,
        frames: 1,
        turn: Turn::Object,
        delay: 50,
        reference: false,
    }
}

fn picture(mut section: Section<'_>) -> Result<(PictureSpec, Given)> {
    let default = default_picture();
    let picture = PictureSpec {
        output: section.path("output")?,
        method: section.choice("method")?.unwrap_or(default.method),
        order: section.choice("order")?.unwrap_or(default.order),
        midpoints: section.choice("midpoints")?.unwrap_or(default.midpoints),
        unit: section.parsed("unit")?.unwrap_or(default.unit),
        table_bits: section
            .whole("table_bits", Width::RANGE)?
            .and_then(|bits| Width::new(bits).ok())
            .map_or(default.table_bits, TableBitsArg),
        sampling: section.choice("sampling")?.unwrap_or(default.sampling),
        size: section.size("size")?.unwrap_or(default.size),
        background: section.parsed::<ColorArg>("background")?.map(|c| c.0),
        samples: section.whole("samples", 1..=8)?.unwrap_or(default.samples),
        antialias: section.flag("antialias")?.unwrap_or(default.antialias),
        frames: section.whole("frames", 1..=10_000)?.unwrap_or(default.frames),
        turn: section.choice("turn")?.unwrap_or(default.turn),
        delay: section.whole("delay", 0..=65_535)?.map_or(default.delay, |ms| ms as u16),
        reference: false,
    };
    let given = section.given(&["order", "midpoints", "unit", "table_bits", "turn", "delay"].map(|key| (key, key)));
    section.finish()?;
    Ok((picture, given))
}
