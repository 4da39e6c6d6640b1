//! Figures 5 to 7 of Tarini et al., and the rest of their list of lighting models.

use std::f32::consts::FRAC_PI_2;
use std::hint::black_box;
use std::sync::Arc;

use anyhow::Result;
use glam::Vec3;
use rilievo::light::{Bands, Environment, Landscape, Layer, Light, Lighting, LightingModel, Material, ShadeTable};
use rilievo::quantize::Dither;
use rilievo::raster::{Detail, Method};
use rilievo::{LinearRgb, Normal, Object as ObjectSpace, Pose, Progress, QuantizedMap, World};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};
use crate::reproduce::subjects::{Cover, Vase, psnr_of_covered, shoot, surroundings};

const ENTRIES: u32 = 2048;
const COLOR: LinearRgb = LinearRgb::new(0.62, 0.36, 0.2);
const GLOSS: LinearRgb = LinearRgb::gray(0.5);

/// Which lights a model is shown under.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lamps {
    One,
    Two,
    Colored,
}

/// Seconds of lighting the table for each of the looks.
fn table_seconds(kit: &Kit<'_>, map: &QuantizedMap<ObjectSpace>, environment: &Arc<Environment>) -> Result<Vec<f64>> {
    let prepared = LOOKS.map(|look| {
        let lighting = Lighting { environment: Some(Arc::clone(environment)), ..lighting(look.lamps) };
        ([(look.material)()], lighting.to_object(&Pose::IDENTITY))
    });
    kit.clock.turns(prepared.len(), |side| {
        let (materials, lighting) = &prepared[side];
        black_box(ShadeTable::new(map.table(), materials, lighting, Normal::Z, Vec3::ZERO)?);
        Ok(())
    })
}

/// A look: its name on the page, its key, what there is to say of it, and how it is made.
#[derive(Clone, Copy)]
struct Look {
    name: &'static str,
    key: &'static str,
    note: &'static str,
    lamps: Lamps,
    material: fn() -> Material,
}

const fn look(
    name: &'static str,
    key: &'static str,
    note: &'static str,
    lamps: Lamps,
    material: fn() -> Material,
) -> Look {
    Look { name, key, note, lamps, material }
}

const LOOKS: [Look; 12] = [
    look("ambient and Lambert, one light", "lambert", "item 1 of the paper's list", Lamps::One, || {
        Material::matte(COLOR)
    }),
    look(
        "Lambert, three colours of light",
        "several_lights",
        "item 1, as many lights as wanted",
        Lamps::Colored,
        || Material::matte(LinearRgb::gray(0.7)),
    ),
    look("Phong", "phong", "item 2", Lamps::Two, || {
        Material::matte(COLOR).with(LightingModel::Phong { color: GLOSS, shininess: 12.0 })
    }),
    look("Blinn-Phong", "blinn_phong", "the half vector, four times the exponent", Lamps::Two, || {
        Material::blinn_phong(COLOR, GLOSS, 48.0)
    }),
    look("environment", "environment", "item 3, figure 5: a room with two windows", Lamps::One, || {
        Material::new([LightingModel::Environment { color: LinearRgb::gray(0.95), roughness: 0.0 }])
    }),
    look("cartoon", "cartoon", "item 4: three flat tones", Lamps::One, || {
        Material::new([LightingModel::Cartoon { bands: Bands::of(LinearRgb::new(0.85, 0.5, 0.25)) }])
    }),
    look("discretised Lambert", "steps", "four steps of light", Lamps::One, || {
        Material::new([LightingModel::Ambient { color: COLOR }, LightingModel::Steps { color: COLOR, steps: 4 }])
    }),
    look("doubled angle", "doubled_angle", "item 5, figure 6: not of this world", Lamps::Two, || {
        Material::matte(COLOR).with(LightingModel::DoubledAngle { color: GLOSS, shininess: 12.0 })
    }),
    look("chrome", "chrome", "item 6, figure 7: blue sky over brown earth", Lamps::One, || {
        Material::new([LightingModel::Chrome { landscape: Landscape::BROWN_AND_BLUE }])
    }),
    look("a third chrome, two thirds Lambert", "mix", "item 7: any combination", Lamps::One, || {
        let chrome = LightingModel::Chrome { landscape: Landscape::BROWN_AND_BLUE };
        Material::new([Layer { weight: 0.33, model: chrome }])
            .with(Layer { weight: 0.67, model: LightingModel::Lambert { color: COLOR } })
    }),
    look(
        "metal, roughness 0.35",
        "rough_metal",
        "later than the paper: glTF's material in the same room",
        Lamps::Two,
        || {
            Material::new([LightingModel::MetallicRoughness {
                base_color: LinearRgb::new(0.9, 0.6, 0.2),
                metallic: 1.0,
                roughness: 0.35,
            }])
        },
    ),
    look("glazed, roughness 0.25", "glazed", "the same model without metal", Lamps::Two, || {
        Material::new([LightingModel::MetallicRoughness {
            base_color: LinearRgb::new(0.08, 0.2, 0.3),
            metallic: 0.0,
            roughness: 0.25,
        }])
    }),
];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let vase = kit.vase()?;
    kit.bars.begin("lighting models", LOOKS.len() as u64 + 1);
    let quantized = vase.quantized(ENTRIES, Dither::None)?;
    kit.bars.advance(1);
    let environment = surroundings()?;
    let size = Vase::picture_size(kit.size);
    let mut found = Findings::default();
    found.paper(
        "The colour of an entry may be any function of its normal, as only a few thousand are evaluated. The paper lists ambient and Lambert \
         light, highlights, environment maps (figure 5), cartoons, a highlight whose angle is doubled (figure 6), chrome under a \
         landscape (figure 7), and all their sums.",
    );
    found.here(format!(
        "The vase of 1200 faces with one table of {ENTRIES} normals ({:.2}° RMS), which is the same in all pictures: only the lit table differs. The figures are \
         PSNR against the same model evaluated in every pixel with its own view direction and the normals as they are.",
        quantized.error.rms_rad.to_degrees()
    ));
    let mut shots = Shots::new(4);
    let mut table = Table::new(
        "PSNR in dB against shading by the pixel, over the pixels the vase covers, and the time to light the table.",
        vec![
            Column::here("model"),
            Column::here(format!("{ENTRIES} entries")),
            Column::here("one for each texel"),
            Column::here("lighting the table, µs"),
        ],
    );
    let seconds = table_seconds(kit, &quantized.map, &environment)?;
    let (mut worst, mut best) = ((f64::INFINITY, ""), (f64::NEG_INFINITY, ""));
    for (i, look) in LOOKS.iter().enumerate() {
        let Look { name, key, note, lamps, material } = *look;
        let materials = [material()];
        let lighting = Lighting { environment: Some(Arc::clone(&environment)), ..lighting(lamps) };
        let take = |detail: Detail<'_>, method| {
            shoot(&vase.scene(detail, &materials, Cover::None, lighting.clone(), 0.75)?, method, size)
        };
        let shown = take(Detail::Indexed(&quantized.map), Method::Table)?;
        let exact = take(vase.exact(), Method::Exact)?;
        let psnr = psnr_of_covered(&exact, &shown)?;
        worst = if psnr < worst.0 { (psnr, name) } else { worst };
        best = if psnr > best.0 { (psnr, name) } else { best };
        let limit = psnr_of_covered(&exact, &vase.shoot_unquantized(&materials, &lighting, size)?)?;
        found.figure(format!("{key}_psnr_db"), psnr);
        found.figure(format!("{key}_unquantised_psnr_db"), limit);
        found.figure(format!("{key}_table_us"), seconds[i] * 1e6);
        table.row(vec![
            name.to_owned(),
            format!("{psnr:.1}"),
            format!("{limit:.1}"),
            format!("{:.1}", seconds[i] * 1e6),
        ]);
        shots.add(Shot::new(&shown.picture, name, format!("{note}; {psnr:.1} dB"))?);
        kit.bars.advance(1);
    }
    found.show(shots);
    found.show(table);
    found.remark(format!(
        "Every model of the paper is there. Soft light comes nearest to shading by the pixel ({:.1} dB: {}); what changes fast with the normal, as \
         mirrors and flat tones do, is farthest ({:.1} dB: {}). Where an entry for each texel would not come nearer either, it is not the table's size that is wanting: \
         the view direction is one for the whole vase, and colours are filtered instead of normals. The paper says of detailed environments that they may want a larger \
         table; here the eye stands so near that its one direction costs more.",
        best.0, best.1, worst.0, worst.1
    ));
    Ok(found)
}

fn lighting(lamps: Lamps) -> Lighting<World> {
    let from = |azimuth: f32, color| Light::from_angles(azimuth * FRAC_PI_2, 0.35, color);
    match lamps {
        Lamps::One => Vase::one_light(),
        Lamps::Two => Vase::lights(),
        Lamps::Colored => Lighting::new(
            LinearRgb::gray(0.03),
            vec![
                from(-0.9, LinearRgb::new(1.1, 0.25, 0.12)),
                from(0.0, LinearRgb::new(0.12, 0.55, 0.2)),
                from(0.9, LinearRgb::new(0.15, 0.3, 1.2)),
            ],
        ),
    }
}
