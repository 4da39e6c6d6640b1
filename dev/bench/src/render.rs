//! The reference renderer: frames by table against frames by exact shading of every pixel.

use crate::harness::duel;
use crate::inputs;
use crate::report::{Case, Report, Unit};
use anyhow::Result;
use rilievo::color::Picture;
use rilievo::height::{Filter, HeightMap};
use rilievo::light::Material;
use rilievo::measure::picture_stats;
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::progress::Silent;
use rilievo::quantize::{Options, Quantized, quantize};
use rilievo::raster::{self, Detail, Method, Scene, Target, TextureFilter};
use rilievo::sample::vase;
use rilievo::surface::{Camera, Deflect, Deflected, Mesh, deflect_heights, shapes};
use rilievo::{Edges, LinearRgb, MaterialMap, Object};

/// Width and height of the pictures.
const SIDE: u32 = 512;
/// The paper's choice.
const ENTRIES: u32 = 2048;
const BACKGROUND: LinearRgb = LinearRgb::gray(0.5);

/// A mesh with its object-space normals, as they are and quantised.
struct Subject {
    name: &'static str,
    mesh: Mesh,
    levels: NormalLevels<Object>,
    materials: Vec<Material>,
    quantized: Quantized<Object>,
}

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    for subject in [vase()?, earth()?] {
        report.add(&measure(&subject, rounds)?)?;
    }
    Ok(())
}

fn vase() -> Result<Subject> {
    let maps = vase::maps(1024)?;
    let mesh = vase::mesh(vase::DEFAULT_SEGMENTS)?;
    Subject::new("vase", mesh, &maps.height, Some(maps.materials), vase::materials_colored().to_vec())
}

fn earth() -> Result<Subject> {
    let height = HeightMap::new(inputs::world(512)?, 0.02)?;
    Subject::new("earth", shapes::sphere(64, 32)?, &height, None, vec![Material::default()])
}

impl Subject {
    fn new(
        name: &'static str,
        mesh: Mesh,
        height: &HeightMap,
        material_of: Option<MaterialMap>,
        materials: Vec<Material>,
    ) -> Result<Self> {
        let deflect = Deflect::new(height.heights().size());
        let Deflected { normals, covered, .. } =
            deflect_heights(&mesh, height, None, Filter::Plane4, Edges::Wrap, &deflect, &Silent)?;
        let options = Options {
            entries: ENTRIES,
            materials: material_of.as_ref(),
            covered: Some(&covered),
            mip_levels: true,
            ..Options::default()
        };
        let quantized = quantize(&normals, &options, &Silent)?;
        let levels = normal_levels(normals, material_of, Some(&covered))?;
        Ok(Self { name, mesh, levels, materials, quantized })
    }

    fn scene<'a>(&'a self, detail: Detail<'a>) -> Result<Scene<'a>> {
        let object = raster::Object::new(&self.mesh, detail, &self.materials);
        let camera = Camera::orbit(self.mesh.bounding_sphere(), 0.0, 0.18, 1.02, 0.45, 1.0)?;
        Ok(Scene { objects: vec![object], lighting: inputs::lighting(), camera })
    }
}

/// A frame is the lighting of the tables, the clearing of the target, and the drawing.
fn measure(subject: &Subject, rounds: usize) -> Result<Case> {
    let by_table = subject.scene(Detail::Indexed(&subject.quantized.map))?;
    let levels = &subject.levels;
    let by_pixel = subject.scene(Detail::Object { normals: &levels.normals, materials: levels.materials.as_ref() })?;
    let (mut table, mut exact) = (Target::new(SIDE, SIDE)?, Target::new(SIDE, SIDE)?);
    let times =
        duel(rounds, || frame(&by_table, Method::Table, &mut table), || frame(&by_pixel, Method::Exact, &mut exact))?;
    let picture = |target: &Target| -> Result<Picture> { Ok(target.resolve(1, Some(BACKGROUND))?) };
    let psnr = picture_stats(&picture(&exact)?, &picture(&table)?)?.psnr_db;
    let covered = 100.0 * table.covered_pixels() as f64 / f64::from(SIDE * SIDE);
    let note = format!(
        "{SIDE}², {covered:.0} % covered, {:.2}° RMS; {:.1} frames/s by table of {ENTRIES}, {:.1} exact",
        subject.quantized.error.rms_rad.to_degrees(),
        1.0 / times.ours,
        1.0 / times.peer,
    );
    let name = format!("render/{}-table-{ENTRIES}", subject.name);
    Ok(Case { psnr_db: Some(psnr), note, ..Case::new(name, Unit::Seconds, times.ours, Some(times.peer)) })
}

fn frame(scene: &Scene<'_>, method: Method, target: &mut Target) -> Result<()> {
    target.clear();
    raster::draw(&raster::prepare(scene, method, TextureFilter::Trilinear)?, target);
    Ok(())
}
