//! Figures 8 to 10 of Tarini et al.: several materials in one index map.

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::light::{Bands, Blend, Landscape, Lighting, LightingModel, Material};
use rilievo::measure::picture_stats;
use rilievo::quantize::{Dither, Quantized};
use rilievo::raster::{Detail, Method, Object, Scene};
use rilievo::sample::vase::{self, CLAY, GLAZE};
use rilievo::surface::Mesh;
use rilievo::{Grid, LinearRgb, MaterialMap, Object as ObjectSpace, Progress};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};
use crate::reproduce::subjects::{Cover, Vase, flat_shaded, shoot, surroundings};

/// What the paper's vase has.
const ENTRIES: u32 = 8192;
/// What its wooden bunny has.
const FEW: u32 = 2048;
/// How much higher the relief of thick paint is.
const THICKER: f32 = 2.5;

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let vase = kit.vase()?;
    kit.bars.begin("tables of normals and materials", 5);
    let step = |made: Result<Quantized<ObjectSpace>>| {
        kit.bars.advance(1);
        made
    };
    let painted = step(vase.quantized_with(ENTRIES, &vase.maps().materials))?;
    let few = step(vase.quantized_with(FEW, &vase.maps().materials))?;
    let alone = step(vase.quantized(ENTRIES, Dither::None))?;
    let halves = step(vase.quantized_with(FEW, &upper_half(&vase.maps().materials)?))?;
    let thick = step(vase.quantized_relief(ENTRIES, THICKER))?;

    let mut found = Findings::default();
    found.paper(
        "Normals and materials are quantised together; the table is sorted by material and keeps the intervals alone. Figure 8 has a bunny half metal, \
         half plastic, figure 9 one of wood whose upper half is varnished, with the grain in a colour texture and 2048 normals in two materials, figure 10 a Greek vase \
         whose colours, too, are in its table of 8192, in one pass, beside its bare geometry and with other reliefs.",
    );
    found.here(
        "The vase with its two materials, clay and glaze, or with an upper and a lower one. Each picture is one look-up in one table; the second row lays \
         the painted colours under the light, as figure 9 does with wood.",
    );
    let tables = [
        ("normals and materials, figure 10", "painted_8192", &painted),
        ("normals and materials, figure 9", "painted_2048", &few),
        ("normals alone", "normals_8192", &alone),
    ];
    let shares = spans(tables, &mut found);
    found.show(shares);
    found.show(colored(kit, vase, &painted, &thick)?);
    let (shots, equations) = mixed(kit, vase, &few, &halves)?;
    found.show(shots);
    found.figure("equation_2_against_1_psnr_db", equations);
    let [together, alone] = [&painted, &alone].map(|q| q.error.rms_rad.to_degrees());
    found.remark(format!(
        "The paper has pictures only; all of their kinds are here. That two materials share a table of {ENTRIES} costs {together:.2}° RMS against \
         {alone:.2}° for the normals alone. Equation (2), which the paper takes for an acceptable approximation, is {equations:.1} dB from \
         equation (1) on this dark paint; on white paint it would show no highlights at all."
    ));
    Ok(found)
}

/// Material 0 on the upper half of the map, 1 below.
fn upper_half(like: &MaterialMap) -> Result<MaterialMap> {
    let (width, height) = like.size();
    Ok(Grid::from_fn(width, height, |_, y| u8::from(y * 100 > height * 46))?)
}

/// How the entries are shared out, and what it costs in degrees.
fn spans(tables: [(&str, &str, &Quantized<ObjectSpace>); 3], found: &mut Findings) -> Table {
    let columns = ["table", "entries", "clay", "glaze", "RMS, °", "largest, °"].map(Column::here);
    let mut table = Table::new("Entries by material, and errors of the normals.", columns.to_vec());
    for (name, key, quantized) in tables {
        let spans = quantized.map.table().spans();
        let of = |material: u8| {
            let span = spans.iter().find(|s| s.material == material && spans.len() > 1);
            span.map_or(0, |s| s.entries.len())
        };
        let cell = |material| if spans.len() > 1 { of(material).to_string() } else { "–".to_owned() };
        let [rms, largest] = [quantized.error.rms_rad, quantized.error.max_rad].map(f64::to_degrees);
        found.figure(format!("{key}_rms_deg"), rms);
        found.figure(format!("{key}_entries"), quantized.map.table().len() as f64);
        if spans.len() > 1 {
            found.figure(format!("{key}_clay_entries"), of(CLAY) as f64);
            found.figure(format!("{key}_glaze_entries"), of(GLAZE) as f64);
        }
        table.row(vec![
            name.to_owned(),
            quantized.map.table().len().to_string(),
            cell(CLAY),
            cell(GLAZE),
            format!("{rms:.2}"),
            format!("{largest:.1}"),
        ]);
    }
    table
}

/// A picture of the vase by table.
fn by_table(
    kit: &Kit<'_>,
    vase: &Vase,
    map: &Quantized<ObjectSpace>,
    materials: &[Material],
    look: Look,
) -> Result<Picture> {
    let lighting = Lighting { environment: Some(surroundings()?), ..Vase::lights() };
    let mut scene: Scene<'_> = vase.scene(Detail::Indexed(&map.map), materials, look.cover, lighting, 0.75)?;
    scene.objects.iter_mut().for_each(|object| object.blend = look.blend);
    Ok(shoot(&scene, Method::Table, Vase::picture_size(kit.size))?.picture)
}

/// What lies on the vase, and how light meets it.
#[derive(Debug, Clone, Copy)]
struct Look {
    cover: Cover,
    blend: Blend,
}

/// The colour is in the table.
const TABLE_ONLY: Look = Look { cover: Cover::None, blend: Blend::Material };

/// Figure 10: the geometry, flat and smooth; colours as materials; other reliefs.
fn colored(
    kit: &Kit<'_>,
    vase: &Vase,
    painted: &Quantized<ObjectSpace>,
    thick: &Quantized<ObjectSpace>,
) -> Result<Shots> {
    let clay = [Material::blinn_phong(LinearRgb::gray(0.6), LinearRgb::gray(0.06), 20.0)];
    let bare = |mesh: &Mesh| -> Result<Picture> {
        let objects = vec![Object::new(mesh, Detail::Smooth, &clay)];
        let scene = Scene { objects, lighting: Vase::lights(), camera: vase.camera(0.75)? };
        Ok(shoot(&scene, Method::Exact, Vase::picture_size(kit.size))?.picture)
    };
    let mut shots = Shots::new(4);
    shots.add(Shot::new(
        &bare(&flat_shaded(vase.mesh())?)?,
        "bare geometry, flat",
        "figure 10, first column: 1200 faces",
    )?);
    shots.add(Shot::new(
        &bare(vase.mesh())?,
        "bare geometry, smooth",
        "figure 10, first column: normals of the vertices",
    )?);
    let own = vase::materials_colored();
    let shot =
        |map, title: &str, caption: String| Shot::new(&by_table(kit, vase, map, &own, TABLE_ONLY)?, title, caption);
    shots.add(shot(
        painted,
        "8192 normals and colours",
        "figure 10, second column: one pass, no colour texture".to_owned(),
    )?);
    shots.add(shot(
        thick,
        "thicker paint, deeper lines",
        format!("figure 10, last column: the relief {THICKER} times as high"),
    )?);
    Ok(shots)
}

/// Figures 8 and 9: a highlight, a metal, a model of its own for each material; and blending with a texture. Also the PSNR of
/// equation (2) against equation (1), in dB over the whole picture.
fn mixed(
    kit: &Kit<'_>,
    vase: &Vase,
    few: &Quantized<ObjectSpace>,
    halves: &Quantized<ObjectSpace>,
) -> Result<(Shots, f64)> {
    let gray = LinearRgb::new(0.5, 0.47, 0.45);
    let metal =
        LightingModel::MetallicRoughness { base_color: LinearRgb::new(0.9, 0.75, 0.5), metallic: 1.0, roughness: 0.3 };
    let shiny = Material::blinn_phong(gray, LinearRgb::gray(0.9), 24.0);
    let plastic = [shiny, Material::matte(gray)];
    let inlay = [Material::matte(LinearRgb::new(0.12, 0.1, 0.1)), Material::new([metal])];
    let cartoon = LightingModel::Cartoon { bands: Bands::of(LinearRgb::new(0.9, 0.55, 0.3)) };
    let chrome = LightingModel::Chrome { landscape: Landscape::BROWN_AND_BLUE };
    let models = [Material::new([cartoon]), Material::new([chrome])];
    let varnish =
        [Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(0.9), 24.0), Material::matte(LinearRgb::WHITE)];
    let textured = |blend| Look { cover: Cover::Painted, blend };
    let mut shots = Shots::new(4);
    let mut add = |map, materials: &[Material], look, title: &str, caption: &str| -> Result<Picture> {
        let picture = by_table(kit, vase, map, materials, look)?;
        shots.add(Shot::new(&picture, title, caption)?);
        Ok(picture)
    };
    add(halves, &plastic, TABLE_ONLY, "shiny above, matte below", "figure 8: the highlight is the only difference")?;
    add(few, &inlay, TABLE_ONLY, "gold inlay", "figure 8: metal and matte paint, 2048 entries for both")?;
    add(few, &models, TABLE_ONLY, "cartoon clay, chrome glaze", "section 6: a lighting model for each material")?;
    add(halves, &varnish, textured(Blend::Add), "varnished above", "figure 9, light added up: c = c₀·α + s")?;
    let exact = add(halves, &varnish, textured(Blend::Exact), "equation (1)", "exact: c = c₀·α + (1 − c₀·α)·s")?;
    let approximate =
        add(halves, &varnish, textured(Blend::Approximate), "equation (2)", "one pass: c = c₀·α + (1 − c₀)·s")?;
    let own = vase::materials_over_color();
    add(
        few,
        &own,
        textured(Blend::Add),
        "clay and glaze over their colours",
        "two materials of 2048 entries under a texture",
    )?;
    let copper = LightingModel::MetallicRoughness {
        base_color: LinearRgb::new(0.85, 0.4, 0.25),
        metallic: 1.0,
        roughness: 0.25,
    };
    let both = [Material::matte(LinearRgb::new(0.3, 0.42, 0.5)), Material::new([copper])];
    add(few, &both, textured(Blend::Material), "copper glaze, blue clay", "section 7.3: a base colour plays no part")?;
    let equations = picture_stats(&exact, &approximate)?.psnr_db;
    Ok((shots, equations))
}
