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
    let (bumps, materials) = (bumps(), materials());
    for n in [12, 16, 20] {
        let mesh = torus(n);
        for view in VIEWS {
            let scene = scene(object(&mesh, &bumps, &materials), view);
            let exact = picture(&scene, Method::Exact);
            let against = |method| psnr_db(&exact, &picture(&scene, method));
            let [linear, normalized] = [Method::Linear, Method::Normalized].map(against);
            let [new, averaged, gram_schmidt] =
                [Midpoints::NewFrames, Midpoints::AveragedVectors, Midpoints::GramSchmidt].map(|m| against(quadratic(m)));
            eprintln!(
                "{} triangles, view {view:?}: linear {linear:.1} dB, normalised {normalized:.1}, quadratic {new:.1} \
                 with new frames, {averaged:.1} with averaged vectors, {gram_schmidt:.1} by Gram-Schmidt",
                2 * n * n
            );
        }
    }
}
