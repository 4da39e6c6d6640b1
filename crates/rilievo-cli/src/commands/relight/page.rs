//! A page that relights a map by itself: the indexed PNG inside, its palette rewritten by a script while the light moves.

use std::path::Path;

use anyhow::Result;
use rilievo::light::{LightingModel, Material};
use rilievo::progress::Silent;
use rilievo::quantize::{Dither, Options, quantize};
use rilievo::{LinearRgb, QuantizedMap, Space, Tangent};
use rilievo_io::{self as io, AnyIndexed, AnyTable, ImportAs, PalettePng, Source};
use serde_json::{Value, json};

use super::{materials_of, table_of};
use crate::exit::{remark, usage};
use crate::scene::{Lamp, LightSpec, MaterialSpec, Side};
use crate::{base64, batch, inputs};

/// The page without a map. It has a size: a museum puts it on its own page.
const PAGE: &str = include_str!("page.html");
const SETUP: &str = "<script type=\"application/json\" id=\"setup\">{}</script>";
const MAP: &str = "<script type=\"text/plain\" id=\"map\"></script>";
/// What a palette holds.
const MOST: usize = 256;

/// The page for a map: one that is indexed already as it is if its table fits a palette, any other quantised anew.
pub(super) fn page(source: &Source, import: &ImportAs, light: &LightSpec, materials: &MaterialSpec) -> Result<String> {
    let (png, count) = palette_png(source, import)?;
    let materials = materials.resolve(count, |_| Material::default());
    let materials = materials.iter().map(finish).collect::<Result<Vec<Value>>>()?;
    let setup = setup(&batch::stem(Path::new(source.name())), light, materials);
    // Nothing in a string of JSON may end the script that it stands in.
    let setup = setup.to_string().replace('<', "\\u003c");
    let page = PAGE.replacen(SETUP, &SETUP.replace("{}", &setup), 1);
    Ok(page.replacen(MAP, &MAP.replacen("></", &format!(">{}</", base64::encode(&png)), 1), 1))
}

/// The map as an indexed PNG, and how many materials it names.
fn palette_png(source: &Source, import: &ImportAs) -> Result<(Vec<u8>, usize)> {
    if io::is_palette_png(source) {
        let png = PalettePng::parse(source)?;
        let count = match &table_of(&png, source, import)? {
            AnyTable::Tangent(table) => materials_of(table),
            AnyTable::Object(table) => materials_of(table),
        };
        return Ok((source.bytes().to_vec(), count));
    }
    if io::is_indexed(source) {
        return match inputs::indexed(source, import)?.map {
            AnyIndexed::Tangent(map) => fitted(&map, source),
            AnyIndexed::Object(map) => fitted(&map, source),
        };
    }
    let convention = import.convention.unwrap_or_default();
    let image = inputs::any_normals::<Tangent>(source, convention)?;
    let options = Options { entries: MOST as u32, covered: image.covered.as_ref(), ..shaped() };
    let made = quantize(&image.normals, &options, &Silent)?;
    tell(source, made.error.rms_rad);
    Ok((io::encode_indexed_png(&made.map, convention)?, 1))
}

/// A map whose table may be larger than a palette.
fn fitted<S: Space>(map: &QuantizedMap<S>, source: &Source) -> Result<(Vec<u8>, usize)> {
    let (count, convention) = (materials_of(map.table()), Default::default());
    if map.table().len() <= MOST {
        return Ok((io::encode_indexed_png(map, convention)?, count));
    }
    let materials = map.expand_materials();
    let options = Options { entries: MOST as u32, materials: Some(&materials), ..shaped() };
    let made = quantize(&map.expand(), &options, &Silent)?;
    tell(source, made.error.rms_rad);
    Ok((io::encode_indexed_png(&made.map, convention)?, count))
}

/// Few entries over a smooth surface show as steps: noise hides them.
fn shaped<'a>() -> Options<'a> {
    Options { dither: Dither::Diffusion, ..Options::default() }
}

fn tell(source: &Source, rms_rad: f64) {
    remark(format!("{}: {MOST} normals for the page, {:.3} degrees RMS", source.name(), rms_rad.to_degrees()));
}

/// What the page's script knows of a material.
fn finish(material: &Material) -> Result<Value> {
    let [mut ambient, mut diffuse, mut specular] = [LinearRgb::BLACK; 3];
    let (mut shininess, mut highlights) = (1.0, 0);
    for layer in material.layers() {
        match layer.model {
            LightingModel::Ambient { color } => ambient += color * layer.weight,
            LightingModel::Lambert { color } => diffuse += color * layer.weight,
            LightingModel::BlinnPhong { color, shininess: sharp } => {
                (specular, shininess) = (color * layer.weight, sharp);
                highlights += 1;
            }
            _ => highlights = usize::MAX,
        }
    }
    if highlights > 1 || ambient != diffuse {
        return Err(usage(
            "--html: the page's script lights by Blinn-Phong; for other models make pictures, or an animation with --frames",
        ));
    }
    Ok(json!({ "diffuse": rgb(diffuse), "specular": rgb(specular), "shininess": shininess }))
}

fn setup(title: &str, light: &LightSpec, materials: Vec<Value>) -> Value {
    let sides: Vec<&Side> = light
        .lamps
        .iter()
        .filter_map(|lamp| match lamp {
            Lamp::Side(side) => Some(side),
            // Flags of flat maps name none.
            Lamp::About { .. } | Lamp::At { .. } => None,
        })
        .collect();
    let angles = |side: &Side| [side.azimuth_rad, side.elevation_rad].map(|a| f64::from(a.to_degrees()));
    let others: Vec<Value> =
        sides.iter().skip(1).map(|side| json!({ "light": angles(side), "color": rgb(side.color) })).collect();
    let mut setup = json!({ "title": title, "ambient": rgb(light.ambient), "others": others, "materials": materials });
    if let (Some(first), Some(object)) = (sides.first(), setup.as_object_mut()) {
        object.insert("light".to_owned(), json!(angles(first)));
        object.insert("color".to_owned(), json!(rgb(first.color)));
    }
    setup
}

fn rgb(color: LinearRgb) -> [f32; 3] {
    [color.r, color.g, color.b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_small_has_its_places_and_asks_for_nothing() {
        assert!(PAGE.len() < 15_000, "{}", PAGE.len());
        assert_eq!((PAGE.matches(SETUP).count(), PAGE.matches(MAP).count()), (1, 1));
        for outside in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!PAGE.contains(outside), "{outside}");
        }
    }

    #[test]
    fn only_what_the_script_can_do_is_promised() {
        assert!(finish(&Material::default()).is_ok());
        assert!(finish(&Material::matte(LinearRgb::WHITE)).is_ok());
        let chrome = Material::new([LightingModel::Chrome { landscape: rilievo::light::Landscape::default() }]);
        assert!(finish(&chrome).is_err());
    }
}
