//! `[[lights]]` and `[environment]`.

use anyhow::Result;
use glam::Vec3;
use rilievo::LinearRgb;

use super::section::Section;
use super::{ANGLE, ELEVATION, WORLD};
use crate::args::{ColorArg, Given};
use crate::scene::{Lamp, LightSpec, Side};

/// As the command line has it.
const DEFAULT_SIDE: Side =
    Side { azimuth_rad: (-45f32).to_radians(), elevation_rad: 40f32.to_radians(), color: LinearRgb::WHITE };
/// Light from everywhere, as the command line has it.
const DEFAULT_AMBIENT: LinearRgb = LinearRgb::gray(0.1);

/// All light of a scene.
pub(super) fn read(root: &mut Section<'_>) -> Result<LightSpec> {
    let lamps = match root.sections("lights", "[[lights]]")? {
        Some(sections) => sections.into_iter().map(lamp).collect::<Result<_>>()?,
        None => vec![Lamp::Side(DEFAULT_SIDE)],
    };
    let mut light = LightSpec {
        ambient: DEFAULT_AMBIENT,
        lamps,
        environment: None,
        environment_turn_rad: 0.0,
        given: Given::default(),
    };
    if let Some(mut section) = root.section("environment", "[environment]")? {
        light.ambient = section.parsed::<ColorArg>("ambient")?.map_or(DEFAULT_AMBIENT, |c| c.0);
        light.environment = section.file("file")?;
        light.environment_turn_rad = section.number("turn", ANGLE)?.unwrap_or(0.0).to_radians();
        light.given = section.given(&[("file", "environment"), ("turn", "turn_environment")]);
        section.finish()?;
    }
    Ok(light)
}

fn lamp(mut section: Section<'_>) -> Result<Lamp> {
    let position = section.numbers::<3>("position", WORLD)?.map(Vec3::from_array);
    let reference_distance = section.number("reference_distance", 0.0..=1e6)?;
    let color = section.parsed::<ColorArg>("color")?.map_or(LinearRgb::WHITE, |c| c.0);
    let azimuth = section.number("azimuth", ANGLE)?;
    let elevation = section.number("elevation", ELEVATION)?;
    if position.is_some()
        && let Some(key) = ["azimuth", "elevation"].into_iter().find(|key| section.has(key))
    {
        return Err(section.wrong(key, "is for a light from a side; this one has a `position`"));
    }
    if position.is_none() && reference_distance.is_some() {
        return Err(section.wrong("reference_distance", "is for a light with a `position`"));
    }
    section.finish()?;
    Ok(match position {
        Some(position) => Lamp::At { position, color, reference_distance },
        None => Lamp::Side(Side {
            azimuth_rad: azimuth.map_or(DEFAULT_SIDE.azimuth_rad, f32::to_radians),
            elevation_rad: elevation.map_or(DEFAULT_SIDE.elevation_rad, f32::to_radians),
            color,
        }),
    })
}
