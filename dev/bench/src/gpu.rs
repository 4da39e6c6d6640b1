//! What moving the light costs before the GPU draws: table and upload, against expanding the whole map. In time of the thread
//! that does it, as a software GPU has threads of its own.

use std::sync::Arc;

use anyhow::Result;
use rilievo::light::{Environment, Landscape, Lighting, LightingModel, Material, Projection};
use rilievo::raster::{self, Detail, Object, Scene, TextureFilter};
use rilievo::surface::{Camera, shapes};
use rilievo::{Grid, LinearRgb, MipChain, NormalTable, Object as ObjectSpace, QuantizedMap};
use rilievo_gpu::{Gpu, Method, Renderer, Uploaded};
use testkit::{Random, uniform_sphere};

use crate::clock::thread_seconds;
use crate::harness::turns;
use crate::inputs;
use crate::report::{Case, Report, Unit};

const ENTRIES: usize = 2048;
const SIDE: u32 = 1024;
/// Moves of the light in a sample.
const REPEATS: u32 = 50;
/// Seconds that a moved light may cost.
const BOUND: f64 = 1e-4;
/// Bytes that it may send.
const MOST_BYTES: f64 = 16.0 * 1024.0;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let gpu = match pollster::block_on(Gpu::headless()) {
        Ok(gpu) => gpu,
        Err(error) => {
            report.remark(&format!("gpu: {error}"));
            return Ok(());
        }
    };
    let renderer = Renderer::new(&gpu);
    let mut random = Random::new(1);
    let base = Grid::from_fn(SIDE, SIDE, |_, _| (random.unit() * ENTRIES as f64) as u16)?;
    let table: NormalTable<ObjectSpace> = NormalTable::new(uniform_sphere(ENTRIES, 1))?;
    let map = QuantizedMap::new(table, MipChain::build(base, |block| *block[0]))?;
    let mesh = shapes::sphere(64, 32)?;
    let sky = Grid::from_fn(512, 256, |x, y| LinearRgb::new(x as f32 / 512.0, y as f32 / 256.0, 0.5))?;
    let environment = Environment::new(Projection::Equirectangular, &sky)?;
    let lighting = Lighting { environment: Some(Arc::new(environment)), ..inputs::lighting() };
    let color = LinearRgb::gray(0.7);
    let facet = LightingModel::MetallicRoughness { base_color: color, metallic: 1.0, roughness: 0.4 };
    let materials = [
        ("lambert", Material::matte(color)),
        ("blinn-phong", Material::blinn_phong(color, LinearRgb::gray(0.2), 37.5)),
        ("chrome", Material::new([LightingModel::Chrome { landscape: Landscape::default() }])),
        ("environment", Material::new([LightingModel::Environment { color, roughness: 0.0 }])),
        ("metallic-roughness", Material::new([facet])),
    ];
    for (name, material) in materials {
        let materials = [material];
        let object = Object::new(&mesh, Detail::Indexed(&map), &materials);
        let camera = Camera::orbit(mesh.bounding_sphere(), 0.4, 0.3, 1.0, 0.7, 1.0)?;
        let scene = Scene { objects: vec![object], lighting: lighting.clone(), camera };
        let mut sent = [0; 2];
        let [by_table, expanded] = &mut sent;
        let side = |method: Method| -> Result<_> {
            let mut loaded = renderer.load(&scene, method, TextureFilter::Trilinear)?;
            renderer.update(&mut loaded, &scene, (64, 64))?;
            Ok(loaded)
        };
        let (mut table, mut all) = (side(raster::Method::Table.into())?, side(Method::Expanded)?);
        let update = |loaded: &mut _, bytes: &mut u64| -> Result<()> {
            let Uploaded { bytes: sent, .. } = renderer.update(loaded, &scene, (64, 64))?;
            *bytes = sent;
            // Nothing is sent before it is handed in.
            gpu.queue().submit([]);
            Ok(())
        };
        let mut update = |side: usize| -> Result<f64> {
            let start = thread_seconds();
            for _ in 0..REPEATS {
                match side {
                    0 => update(&mut table, by_table)?,
                    _ => update(&mut all, expanded)?,
                }
            }
            let seconds = (thread_seconds() - start) / f64::from(REPEATS);
            gpu.wait()?;
            Ok(seconds)
        };
        let found = turns(rounds, 2, &mut update)?;
        let (ours, peer) = (found[0], found[1]);
        let note = format!("{ENTRIES} entries, two lights, on {}; peer is the bound", gpu.name());
        let case = Case::new(format!("gpu/light/{name}"), Unit::Seconds, ours, Some(BOUND));
        report.add(&Case { target: Some(1.0), note, ..case })?;
        let note = format!("peer looks up and sends {SIDE} × {SIDE} texels and their levels");
        report.add(&Case { note, ..Case::new(format!("gpu/expanded/{name}"), Unit::Seconds, ours, Some(peer)) })?;
        if name == "lambert" {
            let [table, expanded] = sent.map(|bytes| bytes as f64);
            let case = Case::new("gpu/bytes", Unit::Bytes, table, Some(MOST_BYTES));
            let note = format!("a moved light; the expanded map sends {expanded:.0} bytes");
            report.add(&Case { target: Some(1.0), note, ..case })?;
        }
    }
    Ok(())
}
