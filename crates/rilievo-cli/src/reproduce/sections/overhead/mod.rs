//! Table 1 of Tarini et al.: what lighting the table costs a frame, beside a light map and a dense mesh.

mod report;
mod timing;

use anyhow::Result;
use rilievo::Object as ObjectSpace;
use rilievo::Progress;
use rilievo::indexed::NormalTable;
use rilievo::light::{Landscape, LightingModel, Material};
use rilievo::quantize::Dither;
use rilievo::{LinearRgb, Normal};

use crate::reproduce::Kit;
use crate::reproduce::findings::Findings;

/// Sizes of the table in the paper (which prints 16 348 for the largest).
const ENTRIES: [u32; 3] = [256, 2048, 16_384];

/// A lighting model with the paper's milliseconds and frames a second for the three sizes.
struct Model {
    name: &'static str,
    key: &'static str,
    paper_ms: [f64; 3],
    paper_fps: [f64; 3],
    layers: fn() -> Material,
}

const COLOR: LinearRgb = LinearRgb::new(0.72, 0.5, 0.36);

/// The four columns of the table.
const MODELS: [Model; 4] = [
    Model {
        name: "Lambert",
        key: "lambert",
        paper_ms: [0.0, 0.3, 3.9],
        paper_fps: [16.0, 16.0, 13.0],
        layers: || Material::matte(COLOR),
    },
    Model {
        name: "Lambert and specular",
        key: "specular",
        paper_ms: [0.1, 1.2, 12.5],
        paper_fps: [16.0, 15.5, 11.0],
        layers: || Material::matte(COLOR).with(LightingModel::Phong { color: LinearRgb::gray(0.4), shininess: 20.0 }),
    },
    Model {
        name: "chrome",
        key: "chrome",
        paper_ms: [0.0, 0.7, 8.6],
        paper_fps: [16.0, 16.0, 12.0],
        layers: || Material::new([LightingModel::Chrome { landscape: Landscape::BROWN_AND_BLUE }]),
    },
    Model {
        name: "environment",
        key: "environment",
        paper_ms: [0.1, 1.7, 18.3],
        paper_fps: [16.0, 15.5, 9.5],
        layers: || Material::new([LightingModel::Environment { color: LinearRgb::WHITE, roughness: 0.0 }]),
    },
];

/// The model of the comparisons with other methods.
const SPECULAR: usize = 1;

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let vase = kit.vase()?;
    kit.bars.begin("tables of normals", ENTRIES.len() as u64);
    let mut maps = Vec::with_capacity(ENTRIES.len());
    for entries in ENTRIES {
        maps.push(vase.quantized(entries, Dither::None)?.map);
        kit.bars.advance(1);
    }
    kit.bars.begin("timing tables and frames", 4);
    let subject = timing::Subject::new(kit, vase, &maps)?;
    let table = subject.table(kit)?;
    kit.bars.advance(1);
    let growth = subject.growth(kit)?;
    kit.bars.advance(1);
    let rivals = subject.rivals(kit)?;
    kit.bars.advance(1);
    let scaling = subject.scaling(kit)?;
    kit.bars.advance(1);
    Ok(report::told(kit, &table, &growth, &rivals, &scaling))
}

/// A table of normals spread over the sphere (Fibonacci's spiral), for sizes that no map is made for: what lighting it costs
/// depends on their number alone.
fn spiral(entries: u32) -> Result<NormalTable<ObjectSpace>> {
    let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
    let normal = |i: u32| {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / entries as f32;
        let (sin, cos) = (golden * i as f32).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Normal::new_or(glam::Vec3::new(r * cos, r * sin, z), Normal::Z)
    };
    Ok(NormalTable::new((0..entries).map(normal).collect())?)
}
