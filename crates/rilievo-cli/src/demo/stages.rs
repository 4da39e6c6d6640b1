//! What the demonstration does, stage by stage.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use glam::{Vec2, Vec3};
use rilievo::color::Picture;
use rilievo::height::{Filter, to_normals};
use rilievo::light::{Blend, Light, Lighting, Material, ShadeTable};
use rilievo::measure::{DEFAULT_PIXELS_PER_DEGREE, flip_mean, picture_stats};
use rilievo::normal::normal_levels;
use rilievo::quantize::{Effort, Options, Quantized, fejes_toth_rms_rad, quantize};
use rilievo::raster::tile::{self, Renderer, empty_picture};
use rilievo::raster::{BaseColor, Detail, Method, Object, Scene, TextureFilter, average_samples};
use rilievo::sample::vase;
use rilievo::surface::{Camera, Deflect, Deflected, Mesh, deflect_heights};
use rilievo::{
    Convention, Edges, LinearRgb, MipChain, Normal, NormalMap, Object as ObjectSpace, Pose, Progress, Rgba8, Space,
    Tangent, World,
};
use rilievo_io::{self as io, PalettePng, Source};

use super::{Entry, Section};
use crate::progress::Bars;

/// Frames of the turntable.
const TURNTABLE_FRAMES: u32 = 36;
/// Milliseconds each is shown.
const TURNTABLE_DELAY: u16 = 60;
/// Pictures are rendered at this multiple of their size and averaged.
const SUPERSAMPLE: u32 = 2;
const STILL: (u32, u32) = (480, 640);
const TURNTABLE: (u32, u32) = (300, 400);
const BACKGROUND: [u8; 3] = [236, 230, 220];

/// The vase, its maps, and where files go.
pub(crate) struct Demo<'a> {
    folder: &'a Path,
    mesh: Mesh,
    maps: vase::VaseMaps,
    color: MipChain<LinearRgb>,
    materials: Vec<Material>,
    maps_seconds: f64,
}

impl<'a> Demo<'a> {
    /// Makes the vase.
    pub(crate) fn new(folder: &'a Path, width: u32) -> Result<Self> {
        let started = Instant::now();
        let maps = vase::maps(width)?;
        let maps_seconds = started.elapsed().as_secs_f64();
        let mesh = vase::mesh(vase::DEFAULT_SEGMENTS)?;
        let color = MipChain::from_picture(&maps.color);
        let materials = vase::materials_over_color().to_vec();
        Ok(Self { folder, mesh, maps, color, materials, maps_seconds })
    }

    /// All stages, in the order of the pipeline.
    pub(crate) fn run(&self) -> Result<Vec<Section>> {
        let bars = Bars::new("demo");
        let flat = self.flat_normals()?;
        let bent = self.bend(&bars)?;
        let tables = self.quantise(&bent.0, &bars)?;
        let relit = self.relight(&flat.0, &bars)?;
        let pictures = self.pictures(&bent.0, &tables.0, &bars)?;
        let turntable = self.turntable(&tables.0[1], &bars)?;
        Ok(vec![self.sample()?, flat.1, relit, bent.1, tables.1, pictures, turntable])
    }

    fn write(&self, file: &str, bytes: &[u8], caption: impl Into<String>) -> Result<Entry> {
        io::write_atomic(&self.folder.join(file), bytes)?;
        let shown = !file.ends_with(".ktx2");
        Ok(Entry { file: file.to_owned(), bytes: bytes.len(), caption: caption.into(), shown })
    }

    fn sample(&self) -> Result<Section> {
        let (width, height) = self.maps.color.size();
        // Two materials as black and white: the same indices, easier to see than 0 and 1.
        let materials = self.maps.materials.map(|&m| if m == vase::GLAZE { 255 } else { 0 });
        Ok(Section {
            title: "The sample",
            text: format!(
                "A neck amphora of {} triangles. Its maps, {width} × {height} texels, are drawn by code in {:.2} s.",
                self.mesh.triangles().len(),
                self.maps_seconds
            ),
            entries: vec![
                self.write("height.png", &io::encode_gray_png16(self.maps.height.heights())?, "height map, 16 bits")?,
                self.write(
                    "materials.png",
                    &io::encode_gray_png8(&self.maps.materials)?,
                    "material map: 0 clay, 1 glaze",
                )?,
                self.write(
                    "materials_shown.png",
                    &io::encode_gray_png8(&materials)?,
                    "the same for the eye: white is glaze",
                )?,
                self.write("color.png", &io::encode_picture_png(&self.maps.color)?, "base colour")?,
            ],
        })
    }

    fn flat_normals(&self) -> Result<(NormalMap<Tangent>, Section)> {
        let started = Instant::now();
        let normals = to_normals(&self.maps.height, Filter::Plane4, Edges::Wrap);
        let seconds = started.elapsed().as_secs_f64();
        let file = self.write(
            "normal_gl.png",
            &io::encode_normals_png16(&normals, Convention::Gl, None)?,
            "tangent-space normal map, 16 bits, +Y up",
        )?;
        let text = format!("Each texel's normal from the least-squares plane through its neighbours: {seconds:.3} s.");
        Ok((normals, Section { title: "Height to normal", text, entries: vec![file] }))
    }

    /// The flat map as a palette picture, relit by rewriting its palette.
    fn relight(&self, normals: &NormalMap<Tangent>, bars: &Bars) -> Result<Section> {
        let options = Options {
            entries: 256,
            effort: Effort::Normal,
            materials: Some(&self.maps.materials),
            covered: None,
            mip_levels: false,
            ..Options::default()
        };
        let quantized = quantize(normals, &options, bars)?;
        let indexed = io::encode_indexed_png(&quantized.map, Convention::Gl)?;
        let mut entries =
            vec![self.write("flat_256.png", &indexed, format!("256 normals, {}", degrees(&quantized)))?];
        let source = Source::from_bytes("flat_256.png", indexed);
        let mut microseconds = Vec::new();
        for (side, azimuth) in [("left", -75.0f32), ("front", 0.0), ("right", 75.0)] {
            let lights = lights(azimuth, 25.0);
            let started = Instant::now();
            let png = PalettePng::parse(&source)?;
            let materials = vase::materials_colored();
            let table = quantized.map.table();
            let shades = ShadeTable::new(table, &materials, &lights.facing(), Normal::Z, Vec3::ZERO)?;
            let colors: Vec<[u8; 3]> = shades.to_srgb(Blend::Add).into_iter().map(Rgba8::rgb).collect();
            let relit = png.relit(&colors)?;
            microseconds.push(started.elapsed().as_secs_f64() * 1e6);
            entries.push(self.write(&format!("flat_lit_{side}.png"), &relit, format!("light from the {side}"))?);
        }
        microseconds.sort_by(f64::total_cmp);
        let text = format!(
            "The flat map as a palette picture. It is relit by rewriting the palette, {:.0} µs each; no pixel is decoded, and \
             the picture is copied as it is.",
            microseconds[1]
        );
        Ok(Section { title: "Relighting by palette", text, entries })
    }

    fn bend(&self, bars: &Bars) -> Result<(Deflected, Section)> {
        let started = Instant::now();
        let options = Deflect::new(self.maps.height.heights().size());
        let deflected =
            deflect_heights(&self.mesh, &self.maps.height, None, Filter::Plane4, Edges::Wrap, &options, bars)?;
        let seconds = started.elapsed().as_secs_f64();
        let bytes = io::encode_normals_png16(&deflected.normals, Convention::Gl, Some(&deflected.covered))?;
        let file = self.write("object.png", &bytes, "object-space normal map, 16 bits; the gutter is transparent")?;
        let text = format!(
            "The heights bent onto the mesh, so that every texel knows its normal in object space: {seconds:.2} s."
        );
        Ok((deflected, Section { title: "Onto the mesh", text, entries: vec![file] }))
    }

    fn quantise(&self, deflected: &Deflected, bars: &Bars) -> Result<(Vec<Quantized<ObjectSpace>>, Section)> {
        let mut entries = Vec::new();
        let mut tables = Vec::new();
        let mut text = String::from("One table for normals and materials together: the two share its entries. ");
        for k in [256, 2048] {
            let options = Options {
                entries: k,
                effort: Effort::Normal,
                materials: Some(&self.maps.materials),
                covered: Some(&deflected.covered),
                mip_levels: true,
                ..Options::default()
            };
            let started = Instant::now();
            let quantized = quantize(&deflected.normals, &options, bars)?;
            let seconds = started.elapsed().as_secs_f64();
            text += &format!(
                "K = {k}: {}, {seconds:.2} s (one material on a uniform sphere could not do better than {:.2}°). ",
                degrees(&quantized),
                fejes_toth_rms_rad(k).to_degrees()
            );
            if k == 256 {
                let png = io::encode_indexed_png(&quantized.map, Convention::Gl)?;
                entries.push(self.write(
                    "vase_256.png",
                    &png,
                    "256 entries: an indexed PNG whose palette is the table",
                )?);
            }
            let ktx2 = io::encode_ktx2(&quantized.map, Convention::Gl)?;
            entries.push(self.write(
                &format!("vase_{k}.ktx2"),
                &ktx2,
                format!("{k} entries with all mip levels: KTX2"),
            )?);
            tables.push(quantized);
        }
        Ok((tables, Section { title: "Quantisation", text, entries }))
    }

    fn pictures(&self, bent: &Deflected, tables: &[Quantized<ObjectSpace>], bars: &Bars) -> Result<Section> {
        let levels = normal_levels(bent.normals.clone(), Some(self.maps.materials.clone()), Some(&bent.covered))?;
        let exact_detail = Detail::Object { normals: &levels.normals, materials: levels.materials.as_ref() };
        let mut renderer = Renderer::new();
        let azimuths = [-80.0, -40.0, 0.0, 40.0, 80.0];
        bars.begin("stills", azimuths.len() as u64 + 2);
        let mut entries = Vec::new();
        let mut stills = Vec::new();
        for (i, azimuth) in azimuths.into_iter().enumerate() {
            let still =
                self.render(&mut renderer, Detail::Indexed(&tables[1].map), Method::Table, azimuth, 0.0, STILL)?;
            let file = format!("still_{}.png", i + 1);
            entries.push(self.write(&file, &io::encode_picture_png(&still)?, format!("light from {azimuth:+.0}°"))?);
            stills.push(still);
            bars.advance(1);
        }
        let exact = self.render(&mut renderer, exact_detail, Method::Exact, azimuths[1], 0.0, STILL)?;
        bars.advance(1);
        let small =
            self.render(&mut renderer, Detail::Indexed(&tables[0].map), Method::Table, azimuths[1], 0.0, STILL)?;
        bars.advance(1);
        let compare = |picture: &Picture| -> Result<String> {
            let psnr = picture_stats(&exact, picture)?.psnr_db;
            let flip = flip_mean(&exact, picture, DEFAULT_PIXELS_PER_DEGREE)?;
            Ok(format!("{psnr:.1} dB, FLIP {flip:.3}"))
        };
        entries.push(self.write("exact.png", &io::encode_picture_png(&exact)?, "per-pixel reference, unquantised")?);
        entries.push(self.write(
            "still_256.png",
            &io::encode_picture_png(&small)?,
            format!("table of 256: {} against the reference", compare(&small)?),
        )?);
        let text = format!(
            "Rendered on the CPU from the table of 2048 entries while the light moves; only the table is lit anew. Against the \
             per-pixel reference with unquantised normals: {}.",
            compare(&stills[1])?
        );
        Ok(Section { title: "Moving light", text, entries })
    }

    fn turntable(&self, table: &Quantized<ObjectSpace>, bars: &Bars) -> Result<Section> {
        bars.begin("turntable", TURNTABLE_FRAMES.into());
        let started = Instant::now();
        let mut renderer = Renderer::new();
        let mut frames = Vec::new();
        for frame in 0..TURNTABLE_FRAMES {
            let turn = frame as f32 / TURNTABLE_FRAMES as f32 * std::f32::consts::TAU;
            let detail = Detail::Indexed(&table.map);
            frames.push(self.render(&mut renderer, detail, Method::Table, -40.0, turn, TURNTABLE)?);
            bars.advance(1);
        }
        let seconds = started.elapsed().as_secs_f64() / f64::from(TURNTABLE_FRAMES);
        let apng = io::encode_apng(&frames, TURNTABLE_DELAY)?;
        let entries = vec![self.write("turntable.png", &apng, "an animated PNG")?];
        let text =
            format!("{TURNTABLE_FRAMES} frames, {seconds:.3} s each, {SUPERSAMPLE} × {SUPERSAMPLE} samples a pixel.");
        Ok(Section { title: "Turntable", text, entries })
    }

    /// A picture; `renderer` knows the maps from the pictures before.
    fn render<'s>(
        &'s self,
        renderer: &mut Renderer<'s>,
        detail: Detail<'s>,
        method: Method,
        light_deg: f32,
        turn_rad: f32,
        size: (u32, u32),
    ) -> Result<Picture> {
        let sphere = self.mesh.bounding_sphere();
        let object = Object {
            pose: Pose::turned_about(sphere.0, turn_rad),
            base_color: Some(BaseColor { levels: &self.color, repeat: Vec2::ONE }),
            ..Object::new(&self.mesh, detail, &self.materials)
        };
        let aspect = size.0 as f32 / size.1 as f32;
        // The vase is taller than wide: the sphere about it need not fit the width.
        let camera = Camera::orbit(sphere, 0.0, 0.18, 1.02, 0.45, aspect.max(1.0))?;
        let scene = Scene { objects: vec![object], lighting: lights(light_deg, 35.0), camera };
        let mut samples = empty_picture(size.0 * SUPERSAMPLE, size.1 * SUPERSAMPLE)?;
        let options = tile::Options { method, filter: TextureFilter::Trilinear, ..tile::Options::default() };
        renderer.draw(&scene, &options, &mut samples)?;
        Ok(average_samples(&samples, SUPERSAMPLE, Some(LinearRgb::from_srgb(BACKGROUND)))?)
    }
}

/// A warm key light that moves, and a weak cool one that does not.
fn lights(azimuth_deg: f32, elevation_deg: f32) -> Lighting<World> {
    let light =
        |azimuth: f32, elevation: f32, color| Light::from_angles(azimuth.to_radians(), elevation.to_radians(), color);
    let key = light(azimuth_deg, elevation_deg, LinearRgb::new(1.25, 1.18, 1.08));
    let fill = light(110.0, 10.0, LinearRgb::new(0.16, 0.19, 0.24));
    Lighting::new(LinearRgb::new(0.10, 0.10, 0.11), vec![key, fill])
}

fn degrees<S: Space>(quantized: &Quantized<S>) -> String {
    let error = &quantized.error;
    format!("{:.2}° RMS, {:.1}° at most", error.rms_rad.to_degrees(), error.max_rad.to_degrees())
}
