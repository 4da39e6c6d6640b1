//! The same scenes on the GPU and on the CPU. What the pictures may differ by stands here, and nowhere else.
#![expect(clippy::unwrap_used, reason = "tests fail loudly")]

use rilievo::color::Picture;
use rilievo::measure::{flip_mean, picture_stats};
use rilievo::polar::{UnitKind, Width};
use rilievo::raster::tile::{Options, Renderer as CpuRenderer, empty_picture};
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{self, Scene, TextureFilter};
use rilievo::{LinearRgb, Rgba8};
use rilievo_gpu::{Gpu, Method, Renderer, Target};
use testkit::stages::{self, Stage};

/// What pictures may differ by.
struct Tolerance {
    /// The share of the pixels in which a component may be off by more than [`CODES`]: texels whose border a pixel's centre lies
    /// on, steps of a model in steps.
    share_over: f64,
    /// The mean of FLIP, at 67 pixels a degree. A table's words alone are good for 0.006: half of all pixels are a code off.
    flip: f64,
    /// What exact pictures have at least.
    exact_db: f64,
}

/// Codes that a component may be off anywhere.
const CODES: u8 = 2;

/// For GPUs that place vertices on 1/256 of a pixel, as all do that one buys, and Mesa's lavapipe.
const FINE: Tolerance = Tolerance { share_over: 1e-3, flip: 8e-3, exact_db: 60.0 };
/// SwiftShader has sixteenths of a pixel, and outlines differ.
const COARSE: Tolerance = Tolerance { share_over: 1.5e-2, flip: 1.5e-2, exact_db: 35.0 };

impl Tolerance {
    fn of(gpu: &Gpu) -> &'static Self {
        if gpu.name().contains("SwiftShader") { &COARSE } else { &FINE }
    }
}

const FILTERS: [TextureFilter; 3] = [TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear];

/// A renderer on whatever GPU there is; without one the test is skipped, loudly.
fn renderer() -> Option<Renderer> {
    match pollster::block_on(Gpu::headless()) {
        Ok(gpu) => Some(Renderer::new(&gpu)),
        Err(error) => {
            testkit::skip(&error.to_string());
            None
        }
    }
}

fn on_gpu(renderer: &Renderer, scene: &Scene<'_>, method: Method, filter: TextureFilter, size: (u32, u32)) -> Picture {
    let mut loaded = renderer.load(scene, method, filter).unwrap();
    let target = Target::new(renderer.gpu(), size).unwrap();
    renderer.update(&mut loaded, scene, size).unwrap();
    renderer.draw(&loaded, &target, None);
    pollster::block_on(target.read()).unwrap()
}

fn on_cpu(scene: &Scene<'_>, method: raster::Method, filter: TextureFilter, size: (u32, u32)) -> Picture {
    let mut picture = empty_picture(size.0, size.1).unwrap();
    CpuRenderer::new().draw(scene, &Options { method, filter, ..Options::default() }, &mut picture).unwrap();
    picture
}

/// How two pictures differ.
#[derive(Debug)]
struct Difference {
    /// Share of the pixels with a component that is off by more than [`CODES`].
    over: f64,
    psnr_db: f64,
    flip: f64,
}

fn difference(a: &Picture, b: &Picture) -> Difference {
    let off = |(a, b): (&rilievo::Rgba8, &rilievo::Rgba8)| {
        let by = |(&a, b): (&u8, u8)| a.abs_diff(b);
        a.rgb().iter().zip(b.rgb()).map(by).max().unwrap() > CODES || a.a != b.a
    };
    let over = a.texels().iter().zip(b.texels()).filter(|&p| off(p)).count();
    Difference {
        over: over as f64 / a.texels().len() as f64,
        psnr_db: picture_stats(a, b).unwrap().psnr_db,
        flip: flip_mean(a, b, 67.0).unwrap(),
    }
}

/// Where pictures are kept to be looked at: expected, difference, found.
fn keep(expected: &Picture, found: &Picture, told: &str) {
    let Some(folder) = std::env::var_os("RILIEVO_KEEP_PICTURES") else { return };
    let name: String = told.chars().filter(|c| c.is_alphanumeric() || *c == '-').collect();
    let sheet = testkit::golden::side_by_side(Some(expected), found);
    let mut bytes = format!("P6 {} {} 255\n", sheet.width(), sheet.height()).into_bytes();
    bytes.extend(sheet.texels().iter().flat_map(|p| p.rgb()));
    std::fs::write(std::path::Path::new(&folder).join(format!("{name}.ppm")), bytes).unwrap();
}

/// Draws a stage on both, and says how the pictures differ; nothing if the method does not take its materials.
fn compare(renderer: &Renderer, stage: &Stage, method: Method, filter: TextureFilter) {
    if let Some(scene) = stage.scene(method.on_cpu()) {
        compare_scene(renderer, stage, &scene, method, filter);
    }
}

fn compare_scene(renderer: &Renderer, stage: &Stage, scene: &Scene<'_>, method: Method, filter: TextureFilter) {
    let found = on_gpu(renderer, scene, method, filter, stage.size);
    let expected = on_cpu(scene, method.on_cpu(), filter, stage.size);
    let told = format!("{}-{method:?}-{filter:?}", stage.name);
    keep(&expected, &found, &told);
    let difference = difference(&expected, &found);
    let tolerance = Tolerance::of(renderer.gpu());
    assert!(difference.over <= tolerance.share_over, "{told}: {difference:?}");
    assert!(difference.flip <= tolerance.flip, "{told}: {difference:?}");
    let is_exact = method == raster::Method::Exact.into();
    assert!(!is_exact || difference.psnr_db >= tolerance.exact_db, "{told}: {difference:?}");
}

fn all_stages() -> Vec<Stage> {
    let plain = [stages::torus(), stages::fine_sphere(), stages::checkered(), stages::crowd(), stages::inside()];
    plain.into_iter().chain(stages::models()).collect()
}

fn check(methods: &[raster::Method]) {
    let Some(renderer) = renderer() else { return };
    for stage in all_stages() {
        for &method in methods {
            for filter in FILTERS {
                compare(&renderer, &stage, method.into(), filter);
            }
        }
    }
}

#[test]
fn table() {
    check(&[raster::Method::Table]);
}

#[test]
fn exact() {
    check(&[raster::Method::Exact]);
}

#[test]
fn exact_from_index_maps() {
    let Some(renderer) = renderer() else { return };
    for stage in [stages::torus(), stages::checkered(), stages::crowd()] {
        for filter in FILTERS {
            compare_scene(&renderer, &stage, &stage.indexed_scene(), raster::Method::Exact.into(), filter);
        }
    }
}

#[test]
fn light_map() {
    check(&[raster::Method::Static]);
}

#[test]
fn interpolated_vectors() {
    let quadratic = |midpoints| raster::Method::Quadratic { midpoints, order: Order::Auto };
    check(&[raster::Method::Linear, raster::Method::Normalized]);
    check(&[Midpoints::NewFrames, Midpoints::AveragedVectors, Midpoints::GramSchmidt].map(quadratic));
}

#[test]
fn polar_units() {
    check(&[8, 5, 14].map(|bits| raster::Method::Polar { unit: UnitKind::E3, width: Width::new(bits).unwrap() }));
    check(&[raster::Method::Polar { unit: UnitKind::E2, width: Width::PAPER }]);
}

/// The light map has eight bits and ends at white: not where highlights shine, and not below a base colour.
#[test]
fn expanded_light_map() {
    let Some(renderer) = renderer() else { return };
    for stage in [stages::torus(), stages::fine_sphere(), stages::checkered()] {
        for filter in FILTERS {
            compare(&renderer, &stage, Method::Expanded, filter);
        }
    }
}

/// What a frame leaves behind must not show in the next.
#[test]
fn objects_stay_and_frames_follow_each_other() {
    let Some(renderer) = renderer() else { return };
    let stage = stages::crowd();
    let mut scene = stage.scene(raster::Method::Table).unwrap();
    let (method, filter) = (raster::Method::Table, TextureFilter::Trilinear);
    let mut loaded = renderer.load(&scene, method.into(), filter).unwrap();
    let target = Target::new(renderer.gpu(), stage.size).unwrap();
    let mut last = None;
    for turn in 0..3 {
        scene.lighting.lights.push(rilievo::light::Light::from_angles(turn as f32 * 2.0, 0.3, LinearRgb::gray(0.2)));
        scene.objects[0].pose = rilievo::Pose::turned(turn as f32 * 0.7);
        renderer.update(&mut loaded, &scene, stage.size).unwrap();
        renderer.draw(&loaded, &target, None);
        let found = pollster::block_on(target.read()).unwrap();
        let difference = difference(&on_cpu(&scene, method, filter, stage.size), &found);
        assert!(difference.over <= Tolerance::of(renderer.gpu()).share_over, "frame {turn}: {difference:?}");
        assert_ne!(last.as_ref(), Some(&found));
        last = Some(found);
    }
    assert!(renderer.draw_time(&loaded).is_none_or(|t| t.as_secs() < 60));
}

#[test]
fn background_shows_where_there_is_nothing() {
    let Some(renderer) = renderer() else { return };
    let stage = stages::torus();
    let scene = stage.scene(raster::Method::Exact).unwrap();
    let mut loaded = renderer.load(&scene, raster::Method::Exact.into(), TextureFilter::Nearest).unwrap();
    let target = Target::new(renderer.gpu(), stage.size).unwrap();
    renderer.update(&mut loaded, &scene, stage.size).unwrap();
    let background = Rgba8::new(12, 130, 255, 255);
    renderer.draw(&loaded, &target, Some(background));
    let picture = pollster::block_on(target.read()).unwrap();
    assert_eq!(picture[(0, 0)], background);
    assert!(picture.texels().iter().all(|p| p.a == 255));
}
