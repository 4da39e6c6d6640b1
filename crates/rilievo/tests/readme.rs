//! The README's library examples: they run, and they are what the README shows.

use glam::Vec3;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Light, Lighting, Material, ShadeTable};
use rilievo::progress::Silent;
use rilievo::quantize;
use rilievo::raster::{Detail, Method, Object, Scene, Target, TextureFilter, draw, prepare};
use rilievo::surface::{Camera, Deflect, deflect_heights, shapes};
use rilievo::{Edges, Grid, LinearRgb, Normal, Pose};

#[rustfmt::skip]
#[expect(clippy::print_stdout, reason = "as the README shows it")]
fn pipeline() -> rilievo::Result<()> {
    let materials = [Material::default()];

    let heights = Grid::from_fn(256, 256, |x, y| ((x as f32 * 0.2).sin() * (y as f32 * 0.1).cos()) * 0.5 + 0.5)?;
    let relief = HeightMap::new(heights, 0.02)?; // full white is 2 % of the width high
    let normals = to_normals(&relief, Filter::Plane4, Edges::Wrap);
    assert_eq!(normals.size(), (256, 256));

    let mesh = shapes::torus(48, 24, 1.0, 0.4)?;
    let options = Deflect { repeat: [6.0, 2.0], ..Deflect::new((768, 256)) };
    let bent = deflect_heights(&mesh, &relief, None, Filter::Plane4, Edges::Wrap, &options, &Silent)?;

    let options = quantize::Options { entries: 1024, covered: Some(&bent.covered), mip_levels: true, ..Default::default() };
    let quantized = quantize::quantize(&bent.normals, &options, &Silent)?;
    println!("{:.2}° RMS", quantized.error.rms_rad.to_degrees());

    let sun = Light::from_angles((-45f32).to_radians(), 35f32.to_radians(), LinearRgb::WHITE);
    let lighting = Lighting::new(LinearRgb::gray(0.05), vec![sun]);
    let in_object = lighting.to_object(&Pose::IDENTITY);
    let shades = ShadeTable::new(quantized.map.table(), &[Material::default()], &in_object, Normal::Z, Vec3::ZERO)?;

    let camera = Camera::orbit(mesh.bounding_sphere(), 0.4, 0.5, 1.05, 0.6, 1.0)?;
    let object = Object::new(&mesh, Detail::Indexed(&quantized.map), &materials);
    let scene = Scene { objects: vec![object], lighting, camera };
    let mut target = Target::new(256, 256)?;
    draw(&prepare(&scene, Method::Table, TextureFilter::Trilinear)?, &mut target);
    let picture = target.resolve(1, None)?;

    assert_eq!(shades.entries().len(), 1024);
    assert!(quantized.error.rms_rad.to_degrees() < 3.0);
    assert!(picture.texels().iter().filter(|p| p.a == 255).count() > 10_000);
    Ok(())
}

#[test]
fn the_examples_run() {
    pipeline().unwrap();
}

#[test]
fn the_readme_shows_them() {
    let readme = include_str!("../../../README.md");
    let here = include_str!("readme.rs");
    let blocks: Vec<&str> = readme.split("```rust\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(blocks.len(), 5);
    for line in blocks.iter().flat_map(|b| b.lines()) {
        assert!(here.lines().any(|l| l.trim() == line.trim()), "not in the test: {line}");
    }
}
