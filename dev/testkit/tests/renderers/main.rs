//! The tile renderer against the reference: every method, filter and instruction set, on scenes that are hard in their own
//! ways. Coverage must be the same to the pixel; colours may be off by what is stated here, and nowhere else.
#![expect(clippy::unwrap_used, reason = "scenes fail loudly")]

mod antialias;

use fearless_simd::Level;
use rilievo::LinearRgb;
use rilievo::color::Picture;
use rilievo::raster::tile::{Options, Renderer, empty_picture};
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{Method, Scene, Target, TextureFilter, draw, prepare};
use testkit::stages::{self, Stage};

/// Codes that a component may be off anywhere.
const CODES: u8 = 2;
/// The share of pixels that may be off by more: those whose centre lies on the border of two texels, at a step of a model in
/// steps, or on a line where two surfaces meet.
const SHARE_OVER: f64 = 2e-3;
/// No filtered pixel may be off by more: neighbouring texels mix, so there is no border to fall on either side of.
const FILTERED_CAP: u8 = 12;

const FILTERS: [TextureFilter; 3] = [TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear];
const METHODS: [Method; 7] = [
    Method::Table,
    Method::Exact,
    Method::Static,
    Method::Linear,
    Method::Normalized,
    Method::Quadratic { midpoints: Midpoints::GramSchmidt, order: Order::Auto },
    Method::Quadratic { midpoints: Midpoints::AveragedVectors, order: Order::Quadratic },
];

/// Every instruction set of this machine, the plainest first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut found = vec![Level::baseline()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        found.extend(best.as_sse4_2().map(Level::Sse4_2));
        found.extend(best.as_avx2().map(Level::Avx2));
        found.extend(best.as_avx512().map(Level::Avx512));
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    found.push(best);
    found
}

fn reference(scene: &Scene<'_>, options: &Options, (width, height): (u32, u32)) -> (Picture, u64) {
    let mut target = Target::new(width, height).unwrap();
    draw(&prepare(scene, options.method, options.filter).unwrap(), &mut target);
    (target.resolve(1, options.background).unwrap(), target.covered_pixels())
}

/// Compares one picture of a stage by all instruction sets with the reference.
fn compare(stage: &Stage, method: Method, filter: TextureFilter, background: Option<LinearRgb>) {
    let Some(scene) = stage.scene(method) else { return };
    let options = Options { method, filter, background, ..Options::default() };
    let (expected, covered) = reference(&scene, &options, stage.size);
    assert!(covered > 200, "{}: there is something to see", stage.name);
    for level in levels() {
        let mut renderer = Renderer::with_level(level);
        let mut picture = empty_picture(stage.size.0, stage.size.1).unwrap();
        // Twice: what is kept between frames must not show.
        for _ in 0..2 {
            let drawn = renderer.draw(&scene, &options, &mut picture).unwrap();
            let told = format!("{} by {method:?}, {filter:?}, {level:?}", stage.name);
            assert_eq!(drawn.covered_pixels, covered, "{told}");
            let (mut over, mut most) = (0u32, 0u8);
            for (a, b) in picture.texels().iter().zip(expected.texels()) {
                assert_eq!(a.a, b.a, "{told}: coverage");
                let off = a.rgb().iter().zip(b.rgb()).map(|(&a, b)| a.abs_diff(b)).max().unwrap();
                over += u32::from(off > CODES);
                most = most.max(off);
            }
            assert!(f64::from(over) <= SHARE_OVER * covered as f64, "{told}: {over} of {covered} pixels");
            assert!(filter == TextureFilter::Nearest || stage.has_steps || most <= FILTERED_CAP, "{told}: {most}");
        }
    }
}

fn compare_all(stage: &Stage) {
    for filter in FILTERS {
        for method in METHODS {
            compare(stage, method, filter, None);
        }
    }
}

#[test]
fn coarse_torus() {
    compare_all(&stages::torus());
}

#[test]
fn sphere_of_tiny_triangles() {
    compare_all(&stages::fine_sphere());
}

#[test]
fn from_inside_where_the_near_plane_cuts() {
    compare_all(&stages::inside());
}

#[test]
fn materials_colours_and_odd_maps() {
    compare_all(&stages::checkered());
}

#[test]
fn several_objects_and_back_faces() {
    compare_all(&stages::crowd());
}

#[test]
fn every_lighting_model() {
    for stage in stages::models() {
        compare(&stage, Method::Exact, TextureFilter::Bilinear, Some(LinearRgb::gray(0.1)));
        compare(&stage, Method::Table, TextureFilter::Bilinear, Some(LinearRgb::gray(0.1)));
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let stage = stages::crowd();
    let options = Options { method: Method::Exact, filter: TextureFilter::Trilinear, ..Options::default() };
    let scene = stage.scene(options.method).unwrap();
    let make = || {
        let mut picture = empty_picture(stage.size.0, stage.size.1).unwrap();
        Renderer::new().draw(&scene, &options, &mut picture).unwrap();
        picture
    };
    let expected = make();
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(make), expected, "{threads} threads");
    }
}

#[test]
fn what_cannot_be_seen_is_counted() {
    let stage = stages::inside();
    let scene = stage.scene(Method::Exact).unwrap();
    let options = Options { method: Method::Exact, ..Options::default() };
    let mut picture = empty_picture(stage.size.0, stage.size.1).unwrap();
    let drawn = Renderer::new().draw(&scene, &options, &mut picture).unwrap();
    let triangles = scene.objects.iter().map(|o| o.mesh.triangles().len() as u64).sum::<u64>();
    assert!(drawn.skipped.outside > 100 && drawn.skipped.outside < triangles, "{drawn:?}");
    // A picture wider than the renderer can address is refused before anything is made.
    let mut wide = empty_picture(20_000, 1).unwrap();
    let message = Renderer::new().draw(&scene, &options, &mut wide).unwrap_err().to_string();
    assert!(message.contains("20000") && message.contains("16384"), "{message}");
}

/// Sizes that are no multiple of a tile or a block, down to one pixel.
#[test]
fn odd_sizes() {
    let mut stage = stages::torus();
    for size in [(1, 1), (3, 200), (65, 63), (130, 7), (64, 64)] {
        stage.size = size;
        let scene = stage.scene(Method::Exact).unwrap();
        let options = Options { method: Method::Exact, filter: TextureFilter::Bilinear, ..Options::default() };
        let (expected, covered) = reference(&scene, &options, size);
        let mut picture = empty_picture(size.0, size.1).unwrap();
        let drawn = Renderer::new().draw(&scene, &options, &mut picture).unwrap();
        assert_eq!(drawn.covered_pixels, covered, "{size:?}");
        for (a, b) in picture.texels().iter().zip(expected.texels()) {
            assert!(a.a == b.a && a.r.abs_diff(b.r) <= FILTERED_CAP, "{size:?}");
        }
    }
}
