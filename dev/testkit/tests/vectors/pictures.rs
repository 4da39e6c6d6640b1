//! Pictures against exact ones.

use rilievo::measure::picture_stats;
use rilievo::raster::scanline::draw_scan_lines;
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{Method, Scene, Target, TextureFilter, draw, prepare};

use crate::scene::{VIEWS, bumps, materials, object, scene, torus};

const SIDE: u32 = 512;

const fn quadratic(midpoints: Midpoints) -> Method {
    Method::Quadratic { midpoints, order: Order::Quadratic }
}

fn picture(scene: &Scene<'_>, method: Method) -> Target {
    let mut target = Target::new(SIDE, SIDE).unwrap();
    draw(&prepare(scene, method, TextureFilter::Trilinear).unwrap(), &mut target);
    target
}

/// Over the pixels that are covered, in 8-bit sRGB codes.
fn psnr_db(exact: &Target, other: &Target) -> f64 {
    assert_eq!(exact.covered_pixels(), other.covered_pixels());
    let [exact_picture, other] = [exact, other].map(|t| t.resolve(1, None).unwrap());
    let share = exact.covered_pixels() as f64 / f64::from(SIDE * SIDE);
    // Pixels that show nothing are equal.
    picture_stats(&exact_picture, &other).unwrap().psnr_db + 10.0 * share.log10()
}

#[test]
fn quadratic_is_nearer_to_exact_than_normalised_on_a_coarse_mesh() {
    let (bumps, materials, mesh) = (bumps(), materials(), torus(12));
    for view in VIEWS {
        let scene = scene(object(&mesh, &bumps, &materials), view);
        let exact = picture(&scene, Method::Exact);
        let against = |method| psnr_db(&exact, &picture(&scene, method));
        let [linear, normalized] = [Method::Linear, Method::Normalized].map(against);
        let [new, averaged, gram_schmidt] =
            [Midpoints::NewFrames, Midpoints::AveragedVectors, Midpoints::GramSchmidt].map(|m| against(quadratic(m)));
        eprintln!(
            "288 triangles, view {view:?}: linear {linear:.1} dB, normalised {normalized:.1}, quadratic {new:.1} with \
             new frames, {averaged:.1} with averaged vectors, {gram_schmidt:.1} by Gram-Schmidt"
        );
        assert!(gram_schmidt >= normalized + 3.5, "{gram_schmidt} and {normalized}");
        assert!(gram_schmidt >= new && new >= averaged, "{gram_schmidt}, {new} and {averaged}");
        // The means are right in length and wrong in direction, as normalised vectors are.
        assert!((averaged - normalized).abs() < 1.0, "{averaged} and {normalized}");
        assert!(linear < normalized - 6.0 && gram_schmidt > 43.0, "{linear} and {gram_schmidt}");
    }
}

#[test]
fn scan_lines_draw_the_picture_of_direct_evaluation() {
    let (bumps, materials, mesh) = (bumps(), materials(), torus(12));
    let scene = scene(object(&mesh, &bumps, &materials), VIEWS[0]);
    for method in [Method::Linear, Method::Normalized, quadratic(Midpoints::GramSchmidt)] {
        let direct = picture(&scene, method);
        let mut by_lines = Target::new(SIDE, SIDE).unwrap();
        draw_scan_lines(&prepare(&scene, method, TextureFilter::Trilinear).unwrap(), &mut by_lines).unwrap();
        let mut worst = 0.0f32;
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            match (direct.depth(x, y), by_lines.depth(x, y)) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-6, "{method:?} at {x}, {y}"),
                (a, b) => assert_eq!(a, b, "{method:?} covers other pixels at {x}, {y}"),
            }
            let (a, b) = (direct.color(x, y), by_lines.color(x, y));
            worst = worst.max((a.r - b.r).abs()).max((a.g - b.g).abs()).max((a.b - b.b).abs());
        }
        eprintln!("{method:?}: {worst:.1e} between scan lines and direct evaluation");
        // A quarter of a step of an 8-bit picture in linear light; the highlight multiplies errors by its exponent.
        assert!(worst < 1e-3, "{method:?}: {worst}");
    }
}

#[test]
fn automatic_order_is_linear_on_tiny_triangles_and_nobody_sees_it() {
    let (bumps, materials) = (bumps(), materials());
    let automatic = Method::Quadratic { midpoints: Midpoints::GramSchmidt, order: Order::Auto };
    for (n, is_linear) in [(12, false), (40, false), (240, true)] {
        let mesh = torus(n);
        let scene = scene(object(&mesh, &bumps, &materials), VIEWS[0]);
        let chosen = picture(&scene, automatic);
        let quadratic = picture(&scene, quadratic(Midpoints::GramSchmidt));
        let [a, b] = [&chosen, &quadratic].map(|t| t.resolve(1, None).unwrap());
        let stats = picture_stats(&b, &a).unwrap();
        let linear = picture(&scene, Method::Linear);
        let same = (0..SIDE * SIDE).filter(|i| chosen.color(i % SIDE, i / SIDE) == linear.color(i % SIDE, i / SIDE));
        let covered = linear.covered_pixels() as f64;
        let share = 1.0 - (f64::from(SIDE * SIDE) - same.count() as f64) / covered;
        eprintln!("{} triangles: off by {} codes, {:.0} % as linear", 2 * n * n, stats.max_abs, share * 100.0);
        assert!(stats.max_abs <= 1, "{} triangles: {}", 2 * n * n, stats.max_abs);
        assert_eq!(share > 0.9, is_linear, "{} triangles: {share}", 2 * n * n);
    }
}
