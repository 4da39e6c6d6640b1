//! Lengths of the vectors, and pictures against exact ones.

use super::{SIDE, quadratic, scene, torus};
use crate::inputs;
use crate::report::Report;
use anyhow::Result;
use glam::Vec2;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::Material;
use rilievo::measure::picture_stats;
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::raster::vectors::{Interpolation, Midpoints, Order};
use rilievo::raster::{self, Detail, Method, Object, Scene, Target, TextureFilter};
use rilievo::{Edges, LinearRgb, Tangent};
use serde_json::json;
use testkit::length_stats;

/// Elevation and azimuth of the eye, in radians.
const VIEWS: [[f32; 2]; 3] = [[0.85, 0.4], [0.35, 1.3], [1.25, -0.7]];
/// Tori of 288, 512 and 800 triangles.
const TORI: [u32; 3] = [12, 16, 20];

/// The methods, with what the table calls them.
const METHODS: [(&str, Interpolation); 5] = [
    ("linear", Interpolation::Linear),
    ("normalised", Interpolation::Normalized),
    ("quadratic, new frames", quadratic(Midpoints::NewFrames)),
    ("quadratic, averaged", quadratic(Midpoints::AveragedVectors)),
    ("quadratic, Gram-Schmidt", quadratic(Midpoints::GramSchmidt)),
];

pub(super) fn run(report: &Report) -> Result<()> {
    let bumps = bumps()?;
    let materials = [Material::blinn_phong(LinearRgb::new(0.75, 0.45, 0.3), LinearRgb::gray(0.5), 32.0)];
    for n in TORI {
        let mesh = torus(n)?;
        let detail = Detail::Tangent { normals: &bumps.normals, repeat: Vec2::new(4.0, 2.0), materials: None };
        let scenes = VIEWS
            .iter()
            .map(|&[elevation, azimuth]| scene(Object::new(&mesh, detail, &materials), elevation, azimuth))
            .collect::<Result<Vec<_>>>()?;
        let exact = scenes.iter().map(|s| picture(s, Method::Exact)).collect::<Result<Vec<_>>>()?;
        for (name, how) in METHODS {
            let (mut psnr, mut mean, mut max) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for (view, scene) in scenes.iter().enumerate() {
                psnr[view] = psnr_db(&exact[view], &picture(scene, method(how))?)?;
                let lights = scene.lighting.to_object(&scene.objects[0].pose).lights;
                let lengths = length_stats(&mesh, &scene.camera, lights[0], how, SIDE);
                (mean[view], max[view]) = (100.0 * lengths.mean, 100.0 * lengths.max);
            }
            let triangles = mesh.triangles().len();
            let case = format!("vectors/{triangles}, {name}");
            let all = |v: [f64; 3], digits: usize| v.map(|v| format!("{v:.digits$}")).join(" / ");
            let text = format!(
                "{case:<38} PSNR {} dB; off unit length by {} % on average, {} % at most",
                all(psnr, 1),
                all(mean, 2),
                all(max, 1)
            );
            let value =
                json!({ "case": case, "psnr_db": psnr, "length_mean_percent": mean, "length_max_percent": max });
            report.row(&value, &text)?;
        }
    }
    Ok(())
}

/// The method that a way of interpolating is.
const fn method(how: Interpolation) -> Method {
    match how {
        Interpolation::Linear => Method::Linear,
        Interpolation::Normalized => Method::Normalized,
        Interpolation::Quadratic { midpoints, .. } => Method::Quadratic { midpoints, order: Order::Quadratic },
    }
}

fn bumps() -> Result<NormalLevels<Tangent>> {
    let map = HeightMap::new(inputs::rough(512)?, 0.1)?;
    Ok(normal_levels(to_normals(&map, Filter::Plane4, Edges::Wrap), None, None)?)
}

fn picture(scene: &Scene<'_>, method: Method) -> Result<Target> {
    let mut target = Target::new(SIDE, SIDE)?;
    raster::draw(&raster::prepare(scene, method, TextureFilter::Trilinear)?, &mut target);
    Ok(target)
}

/// Over the pixels that are covered, in 8-bit sRGB codes.
fn psnr_db(exact: &Target, other: &Target) -> Result<f64> {
    let share = exact.covered_pixels() as f64 / f64::from(SIDE * SIDE);
    // Pixels that show nothing are equal in both pictures and count for nothing.
    let stats = picture_stats(&exact.resolve(1, None)?, &other.resolve(1, None)?)?;
    Ok(stats.psnr_db + 10.0 * share.log10())
}
