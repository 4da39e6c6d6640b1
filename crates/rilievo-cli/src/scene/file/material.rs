//! `[materials.NAME]`: sums of lighting models.

use std::collections::BTreeMap;

use anyhow::Result;
use rilievo::LinearRgb;
use rilievo::light::{Bands, Landscape, Layer, LightingModel, Material};

use super::section::{Item, Section};
use crate::args::{ColorArg, Finish, ModelArg};

/// Exponents of highlights.
const SHININESS: std::ops::RangeInclusive<f32> = 0.0..=100_000.0;
/// The names of the models.
pub(super) const MODELS: [&str; 10] = [
    "ambient",
    "lambert",
    "steps",
    "cartoon",
    "phong",
    "blinn-phong",
    "doubled-angle",
    "chrome",
    "environment",
    "metallic-roughness",
];

/// Materials by their names.
pub(super) type Named<'t> = BTreeMap<&'t str, Material>;

/// All materials with a name.
pub(super) fn all<'t>(root: &mut Section<'t>) -> Result<Named<'t>> {
    let sections = root.named("materials", "[materials.NAME]")?;
    sections.into_iter().map(|(name, section)| Ok((name, material(section)?))).collect()
}

/// A material of an object: a name, or a table of its own.
pub(super) fn of_item(item: &Item<'_>, named: &Named<'_>) -> Result<Material> {
    if let Some(section) = item.section("[materials.NAME]") {
        return material(section);
    }
    let name = item.text().ok_or_else(|| item.wrong("a material is a name in quotes, or a table"))?;
    named.get(name).cloned().ok_or_else(|| {
        let there: Vec<&str> = named.keys().copied().collect();
        let there = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
        item.wrong(format_args!("there is no [materials.{name}]; the file has {there}"))
    })
}

fn material(mut section: Section<'_>) -> Result<Material> {
    let finish = Finish::default();
    let finish = Finish {
        diffuse: color(&mut section, "diffuse", finish.diffuse)?,
        specular: color(&mut section, "specular", finish.specular)?,
        shininess: section.number("shininess", SHININESS)?.unwrap_or(finish.shininess),
    };
    let layers = section.sections("layers", "layers")?;
    if layers.is_some()
        && let Some(key) = ["diffuse", "specular", "shininess"].into_iter().find(|key| section.has(key))
    {
        return Err(section.wrong(key, "says the same as layers do; give it in a layer"));
    }
    section.finish()?;
    match layers {
        Some(layers) => Ok(Material::new(layers.into_iter().map(layer).collect::<Result<Vec<_>>>()?)),
        None => Ok(finish.with(&[ModelArg::DEFAULT])),
    }
}

fn color(section: &mut Section<'_>, key: &'static str, default: LinearRgb) -> Result<LinearRgb> {
    Ok(section.parsed::<ColorArg>(key)?.map_or(default, |c| c.0))
}

fn layer(mut section: Section<'_>) -> Result<Layer> {
    let Some(name) = section.text("model")? else {
        return Err(section.wrong("model", format_args!("is missing; it is one of {}", MODELS.join(", "))));
    };
    let weight = section.number("weight", 0.0..=1000.0)?.unwrap_or(1.0);
    let Finish { diffuse, specular, shininess } = Finish::default();
    let s = &mut section;
    let model = match name {
        "ambient" => LightingModel::Ambient { color: color(s, "color", diffuse)? },
        "lambert" => LightingModel::Lambert { color: color(s, "color", diffuse)? },
        "steps" => {
            let steps = s.whole("steps", 1..=65_535)?.unwrap_or(4) as u16;
            LightingModel::Steps { color: color(s, "color", diffuse)?, steps }
        }
        "cartoon" => {
            let color = color(s, "color", diffuse)?;
            LightingModel::Cartoon { bands: bands(s)?.unwrap_or_else(|| Bands::of(color)) }
        }
        "phong" | "blinn-phong" | "doubled-angle" => {
            let color = color(s, "color", specular)?;
            let shininess = s.number("shininess", SHININESS)?.unwrap_or(shininess);
            match name {
                "phong" => LightingModel::Phong { color, shininess },
                "blinn-phong" => LightingModel::BlinnPhong { color, shininess },
                _ => LightingModel::DoubledAngle { color, shininess },
            }
        }
        "chrome" => {
            let land = Landscape::default();
            let landscape = Landscape {
                zenith: color(s, "zenith", land.zenith)?,
                sky: color(s, "sky", land.sky)?,
                ground: color(s, "ground", land.ground)?,
                nadir: color(s, "nadir", land.nadir)?,
            };
            LightingModel::Chrome { landscape }
        }
        "environment" => {
            let roughness = s.number("roughness", 0.0..=1.0)?.unwrap_or(0.0);
            LightingModel::Environment { color: color(s, "color", LinearRgb::WHITE)?, roughness }
        }
        "metallic-roughness" => LightingModel::MetallicRoughness {
            base_color: color(s, "color", diffuse)?,
            metallic: s.number("metallic", 0.0..=1.0)?.unwrap_or(0.0),
            roughness: s.number("roughness", 0.0..=1.0)?.unwrap_or(0.5),
        },
        _ => {
            let what = format!("is '{name}'; it must be one of {}", MODELS.join(", "));
            return Err(section.wrong("model", what));
        }
    };
    section.finish()?;
    Ok(Layer { weight, model })
}

/// Pairs of a threshold and a colour.
fn bands(section: &mut Section<'_>) -> Result<Option<Bands>> {
    let Some(items) = section.items("bands")? else { return Ok(None) };
    if section.has("color") {
        return Err(section.wrong("bands", "have colours of their own; leave `color` out"));
    }
    let band = |item: &Item<'_>| {
        let form = || item.wrong("a band is a pair of a threshold and a colour, as in [0.3, \"c08060\"]");
        let pair = item.list().ok_or_else(form)?;
        let [threshold, color] = pair.as_slice() else { return Err(form()) };
        let threshold = threshold.number().ok_or_else(form)?;
        let text = color.text().ok_or_else(form)?;
        Ok((threshold, text.parse::<ColorArg>().map_err(|e| color.wrong(e))?.0))
    };
    let bands: Vec<(f32, LinearRgb)> = items.iter().map(band).collect::<Result<_>>()?;
    Bands::new(&bands).map(Some).map_err(|e| section.wrong("bands", format_args!("are wrong: {e}")))
}
