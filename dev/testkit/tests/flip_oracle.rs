//! ꟻLIP of the crate against its authors' own C++ program.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic and tell its figures")]

use rilievo::color::Picture;
use rilievo::measure::{DEFAULT_PIXELS_PER_DEGREE, flip_map, flip_mean};
use rilievo::{Grid, Rgba8};
use testkit::Random;

fn authors_map(a: &Picture, b: &Picture, pixels_per_degree: f32) -> Vec<f32> {
    let image = |p: &Picture| {
        let bytes: Vec<u8> = p.texels().iter().flat_map(|p| p.rgb()).collect();
        nv_flip::FlipImageRgb8::with_data(p.width(), p.height(), &bytes)
    };
    nv_flip::flip(image(a), image(b), pixels_per_degree).to_vec()
}

fn picture(width: u32, height: u32, mut f: impl FnMut(f64, f64) -> [f64; 3]) -> Picture {
    Grid::from_fn(width, height, |x, y| {
        let [r, g, b] = f(f64::from(x), f64::from(y)).map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
        Rgba8::new(r, g, b, 255)
    })
    .unwrap()
}

/// A lit bump pattern, as the renderer makes them; `light` moves the light.
fn relief(width: u32, height: u32, light: f64) -> Picture {
    picture(width, height, |x, y| {
        let (dx, dy) = ((x * 0.21).sin() * 0.6, (y * 0.17 + x * 0.03).cos() * 0.6);
        let n = (dx * dx + dy * dy + 1.0).sqrt();
        let lambert = ((light.cos() * dx + light.sin() * dy + 0.8) / n / 1.3).max(0.0);
        [lambert, lambert * 0.8, lambert * 0.6 + 0.1]
    })
}

fn noise(width: u32, height: u32, seed: u64) -> Picture {
    let mut random = Random::new(seed);
    picture(width, height, |_, _| [random.unit(), random.unit(), random.unit()])
}

/// Fine lines and single points on grey: work for the feature detectors.
fn lines(width: u32, height: u32, shift: f64) -> Picture {
    picture(width, height, |x, y| {
        let on = (x + shift) % 9.0 < 1.0 || (y + 2.0 * shift) % 13.0 < 1.0;
        if on { [0.9, 0.9, 0.2] } else { [0.3, 0.3, 0.4] }
    })
}

#[test]
fn maps_and_means_agree_with_the_authors_program() {
    let cases = [
        ("relief, light moved", relief(160, 121, 0.3), relief(160, 121, 0.5)),
        ("relief, light opposite", relief(160, 121, 0.3), relief(160, 121, 3.4)),
        ("noise", noise(97, 64, 1), noise(97, 64, 2)),
        ("lines, shifted", lines(128, 128, 0.0), lines(128, 128, 1.0)),
        ("relief against lines", relief(90, 90, 0.3), lines(90, 90, 0.0)),
        (
            "noise of 1 / 255",
            picture(64, 64, |_, _| [0.5; 3]),
            picture(64, 64, |x, y| [0.5 + (x + y) % 2.0 / 255.0; 3]),
        ),
        ("smaller than the filters", relief(5, 3, 0.3), relief(5, 3, 1.3)),
    ];
    for (name, a, b) in &cases {
        for ppd in [DEFAULT_PIXELS_PER_DEGREE, 20.0, 120.0] {
            let (ours, theirs) = (flip_map(a, b, ppd).unwrap(), authors_map(a, b, ppd));
            let difference = |(x, y): (&f32, &f32)| f64::from((x - y).abs());
            let worst = ours.texels().iter().zip(&theirs).map(difference).fold(0.0, f64::max);
            let mean = theirs.iter().map(|&e| f64::from(e)).sum::<f64>() / theirs.len() as f64;
            let apart = (flip_mean(a, b, ppd).unwrap() - mean).abs();
            println!("{name}, {ppd} pixels per degree: mean {mean:.5}, apart {apart:.1e}, worst pixel {worst:.1e}");
            assert!(apart <= 1e-5, "{name}: means differ by {apart}");
            assert!(worst <= 1e-4, "{name}: a pixel differs by {worst}");
        }
    }
}
