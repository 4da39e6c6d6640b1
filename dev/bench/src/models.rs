//! What lighting a table costs, model by model: of a frame, and against lighting every pixel.

use std::sync::Arc;

use anyhow::Result;
use glam::Vec3;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::indexed::QuantizedMap;
use rilievo::light::{
    Bands, Blend, Environment, Landscape, Lighting, LightingModel, Material, Projection, ShadeTable, relight,
};
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, quantize};
use rilievo::raster::tile::{self, Renderer, empty_picture};
use rilievo::raster::{Detail, Method, Object as Drawn, Scene, TextureFilter};
use rilievo::surface::{Camera, Deflect, deflect_normals, shapes};
use rilievo::{Edges, Grid, LinearRgb, Normal, NormalTable, Object, Rgba8, Space};

use crate::harness::duel;
use crate::inputs;
use crate::report::{Case, Report, Unit};

/// Entries of the table: the paper's choice.
const ENTRIES: u32 = 2048;
/// Width and height of the map and of the pictures.
const SIDE: u32 = 1024;
/// Least ratio of a frame's time to its table's: the table takes less than a hundredth.
const OVERHEAD: f64 = 100.0;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let height = HeightMap::new(inputs::rough(SIDE)?, 0.04)?;
    let mesh = shapes::torus(12, 12, 1.0, 0.45)?.with_tangents()?;
    let tangent = to_normals(&height, Filter::Plane4, Edges::Wrap);
    let deflect = Deflect { repeat: [4.0, 2.0], ..Deflect::new((SIDE, SIDE)) };
    let object = deflect_normals(&mesh, &tangent, None, &deflect, &Silent)?;
    let options =
        Options { entries: ENTRIES, effort: Effort::Fast, covered: Some(&object.covered), ..Options::default() };
    let map = quantize(&object.normals, &options, &Silent)?.map;
    let camera = Camera::orbit((Vec3::ZERO, 1.45), 0.4, 0.7, 1.0, 0.9, 1.0)?;
    for (name, material, target) in materials() {
        let materials = std::slice::from_ref(&material);
        let lighting = lighting()?;
        let scene = Scene {
            objects: vec![Drawn::new(&mesh, Detail::Indexed(&map), materials)],
            lighting: lighting.clone(),
            camera,
        };
        let mut renderer = Renderer::new();
        let mut picture = empty_picture(SIDE, SIDE)?;
        let frame = tile::Options { method: Method::Table, filter: TextureFilter::Nearest, ..tile::Options::default() };
        let in_object = lighting.to_object(&rilievo::Pose::IDENTITY);
        let view = Normal::new_or(camera.eye(), Normal::Z);
        let light = |table: &NormalTable<Object>| -> Result<Vec<Rgba8>> {
            Ok(ShadeTable::new(table, materials, &in_object, view, Vec3::ZERO)?.to_srgb(Blend::Add))
        };
        let found = duel(rounds, || light(map.table()), || Ok(renderer.draw(&scene, &frame, &mut picture)?))?;
        let note = format!("lighting and encoding {ENTRIES} entries; peer is a whole frame by table, the torus of 288");
        let case = Case::new(format!("models/{name}/overhead"), Unit::Seconds, found.ours, Some(found.peer));
        report.add(&Case { note, target: Some(OVERHEAD), ..case })?;

        let pixels = pixel_tables(&object.normals)?;
        let by_table = || look_up(&map, &ShadeTable::new(map.table(), materials, &in_object, view, Vec3::ZERO)?);
        let by_pixel = || pixels.iter().map(&light).collect::<Result<Vec<_>>>().map(|lit| lit.concat());
        let found = duel(rounds, by_table, by_pixel)?;
        let note = format!("the table and {SIDE} × {SIDE} look-ups; peer lights and encodes each, by the same lanes");
        let case = Case::new(format!("models/{name}/pixels"), Unit::Seconds, found.ours, Some(found.peer));
        report.add(&Case { note, target, ..case })?;
    }
    Ok(())
}

fn look_up(map: &QuantizedMap<Object>, shades: &ShadeTable) -> Result<Grid<Rgba8>> {
    Ok(relight(map, shades, None, Blend::Add)?)
}

/// The normals of a map as tables of as many entries as the table has: enough for lanes, and few enough for the nearest cache.
fn pixel_tables(normals: &Grid<Normal<Object>>) -> Result<Vec<NormalTable<Object>>> {
    let tables = normals.texels().chunks(ENTRIES as usize).map(|chunk| NormalTable::new(chunk.to_vec()));
    Ok(tables.collect::<rilievo::Result<_>>()?)
}

fn lighting<S: Space>() -> Result<Lighting<S>> {
    let sky = Grid::from_fn(512, 256, |x, y| LinearRgb::new(x as f32 / 512.0, y as f32 / 256.0, 0.5))?;
    let environment = Environment::new(Projection::Equirectangular, &sky)?;
    Ok(Lighting { environment: Some(Arc::new(environment)), ..inputs::lighting() })
}

/// Every model, and how many times faster the table should be than the pixels.
fn materials() -> Vec<(&'static str, Material, Option<f64>)> {
    let (color, gloss, shininess) = (LinearRgb::gray(0.7), LinearRgb::gray(0.2), 37.5);
    let of = |model: LightingModel| Material::new([model]);
    vec![
        ("ambient", of(LightingModel::Ambient { color }), None),
        ("lambert", Material::matte(color), None),
        ("steps", of(LightingModel::Steps { color, steps: 4 }), None),
        ("cartoon", of(LightingModel::Cartoon { bands: Bands::of(color) }), None),
        ("phong", Material::matte(color).with(LightingModel::Phong { color: gloss, shininess }), None),
        ("blinn-phong", Material::blinn_phong(color, gloss, shininess), Some(2.0)),
        ("doubled-angle", Material::matte(color).with(LightingModel::DoubledAngle { color: gloss, shininess }), None),
        ("chrome", of(LightingModel::Chrome { landscape: Landscape::default() }), None),
        ("environment", of(LightingModel::Environment { color, roughness: 0.0 }), Some(3.5)),
        (
            "metallic-roughness",
            of(LightingModel::MetallicRoughness { base_color: color, metallic: 1.0, roughness: 0.4 }),
            None,
        ),
    ]
}
