//! `[[objects]]`.

use anyhow::Result;
use glam::{Quat, Vec3};
use rilievo::Pose;
use rilievo::light::Blend;

use super::material::{Named, of_item};
use super::section::Section;
use super::{ANGLE, LENGTH, WORLD};
use crate::args::{
    BlendArg, ConventionArg, DEFAULT_DEPTH, DEFAULT_GUTTER, EdgesArg, EffortArg, FilterArg, HeightArgs, ModelArg,
    OntoArgs, SpaceArg,
};
use crate::relief::{DEFAULT_ENTRIES, ENTRIES, ReliefArgs};
use crate::scene::{MaterialSpec, ObjectSpec};
use crate::surface::SurfaceArg;

/// Keys that may play no part, and the flags they are.
const RELIEF_KEYS: [(&str, &str); 10] = [
    ("material_map", "materials"),
    ("space", "space"),
    ("convention", "convention"),
    ("depth", "depth"),
    ("filter", "filter"),
    ("repeat", "repeat"),
    ("map_size", "map_size"),
    ("gutter", "gutter"),
    ("entries", "entries"),
    ("effort", "effort"),
];

/// One object.
pub(super) fn read(mut section: Section<'_>, named: &Named<'_>) -> Result<ObjectSpec> {
    let s = &mut section;
    let surface = surface(s)?;
    let relief = ReliefArgs {
        surface,
        height: s.file("height")?,
        normals: s.file("normals")?,
        indexed: s.file("indexed")?,
        color: s.file("color")?,
        materials: s.file("material_map")?,
        space: s.choice("space")?.unwrap_or(SpaceArg::Tangent),
        convention: s.choice("convention")?.unwrap_or(ConventionArg::Gl),
        heights: HeightArgs {
            depth: s.number("depth", -1000.0..=1000.0)?.unwrap_or(DEFAULT_DEPTH),
            filter: s.choice("filter")?.unwrap_or(FilterArg::Plane4),
            edges: s.choice("edges")?.unwrap_or(EdgesArg::Wrap),
        },
        onto: OntoArgs {
            repeat: s.numbers::<2>("repeat", 1e-3..=65_536.0)?,
            map_size: s.size("map_size")?,
            gutter: s.whole("gutter", 0..=1024)?.unwrap_or(DEFAULT_GUTTER),
        },
        entries: s.whole("entries", ENTRIES)?.unwrap_or(DEFAULT_ENTRIES),
        effort: s.choice("effort")?.unwrap_or(EffortArg::Normal),
    };
    let maps: Vec<&str> = ["height", "normals", "indexed"].into_iter().filter(|key| s.has(key)).collect();
    if let [first, second, ..] = maps[..] {
        return Err(s.wrong(second, format_args!("and `{first}` cannot both be the relief; give one of them")));
    }
    let given = s.given(&RELIEF_KEYS);
    let pose = pose(s)?;
    let materials = materials(s, named)?;
    let blend: Blend = s.choice::<BlendArg>("blend")?.unwrap_or(BlendArg::Add).into();
    let double_sided = s.flag("double_sided")?.unwrap_or(false);
    let called = s.text("name")?.map_or_else(|| relief.surface.stem(), str::to_owned);
    let name = format!("{}: {called}", section.place());
    section.finish()?;
    Ok(ObjectSpec { name, relief, given, pose, materials, blend, double_sided })
}

fn surface(section: &mut Section<'_>) -> Result<SurfaceArg> {
    let shape = section.parsed::<SurfaceArg>("shape")?;
    let mesh = section.file("mesh")?;
    match (shape, mesh) {
        (Some(_), Some(_)) => Err(section.wrong("mesh", "and `shape` cannot both be the surface; give one of them")),
        (None, Some(path)) => Ok(SurfaceArg::File(path)),
        (Some(SurfaceArg::File(path)), None) => {
            let path = path.display();
            Err(section
                .wrong("shape", format_args!("is '{path}', which is no built-in shape; files are given by `mesh`")))
        }
        (shape, None) => Ok(shape.unwrap_or(SurfaceArg::DEFAULT)),
    }
}

fn pose(section: &mut Section<'_>) -> Result<Pose> {
    let [x, y, z] = section.numbers::<3>("rotation", ANGLE)?.unwrap_or_default().map(f32::to_radians);
    Ok(Pose {
        // About x first, then y, then z, all of them the world's.
        rotation: Quat::from_rotation_z(z) * Quat::from_rotation_y(y) * Quat::from_rotation_x(x),
        scale: section.number("scale", LENGTH)?.unwrap_or(1.0),
        translation: section.numbers::<3>("position", WORLD)?.map_or(Vec3::ZERO, Vec3::from_array),
    })
}

fn materials(section: &mut Section<'_>, named: &Named<'_>) -> Result<MaterialSpec> {
    let items = section.items("materials")?.unwrap_or_default();
    if items.len() > 256 {
        return Err(section.wrong("materials", "are numbered from 0 to 255; there are more"));
    }
    let given = items.iter().zip(0..=u8::MAX).map(|(item, number)| Ok((number, of_item(item, named)?)));
    Ok(MaterialSpec {
        given: given.collect::<Result<_>>()?,
        models: vec![ModelArg::DEFAULT],
        called: section.called("materials"),
    })
}
