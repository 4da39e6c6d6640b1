//! Lighting a table: sixteen normals at a time against one at a time, by the same definition.

use std::sync::Arc;

use glam::Vec3;
use rilievo::light::{Environment, Landscape, Lighting, LightingModel, Material, Projection, Shade, ShadeTable, shade};
use rilievo::{Grid, LinearRgb, Normal, NormalTable, Object};
use testkit::uniform_sphere;

use crate::harness::duel;
use crate::inputs;
use crate::report::{Case, Report, Unit};
use anyhow::Result;

/// Entries of the table.
const ENTRIES: usize = 2048;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let table: NormalTable<Object> = NormalTable::new(uniform_sphere(ENTRIES, 1))?;
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
        let lanes = std::slice::from_ref(&material);
        let ours = || Ok(ShadeTable::new(&table, lanes, &lighting, Normal::Z, Vec3::ZERO)?);
        let each = |&n: &Normal<Object>| shade(&material, &lighting, n, Normal::Z, Vec3::ZERO);
        let peer = || Ok(table.normals().iter().map(each).collect::<Vec<Shade>>());
        let found = duel(rounds, ours, peer)?;
        let note = format!("{ENTRIES} entries, two lights; peer evaluates the scalar definition");
        let name = format!("light/{name}");
        report.add(&Case { note, ..Case::new(name, Unit::Seconds, found.ours, Some(found.peer)) })?;
    }
    Ok(())
}
