//! Four samples a pixel, against the reference drawn four times as large: its pixels lie where the samples do.

use fearless_simd::Level;
use rilievo::LinearRgb;
use rilievo::color::Picture;
use rilievo::measure::picture_stats;
use rilievo::raster::tile::{Options, Renderer, Samples, empty_picture};
use rilievo::raster::{Method, Scene, Target, TextureFilter, draw, prepare};

use crate::levels;
use testkit::stages;

/// Column and row of the samples among the 4 × 4 parts of a pixel.
const PLACES: [[u32; 2]; 4] = [[1, 0], [3, 1], [0, 2], [2, 3]];
/// Pixels whose coverage may differ: vertices snap to a grid four times as fine in the large picture.
const SHARE_OFF: f64 = 1e-3;

fn by_tiles(level: Level, scene: &Scene<'_>, options: &Options, (width, height): (u32, u32)) -> (Picture, u64) {
    let mut picture = empty_picture(width, height).unwrap();
    let drawn = Renderer::with_level(level).draw(scene, options, &mut picture).unwrap();
    (picture, drawn.covered_pixels)
}

/// The reference, `times` as large.
fn large(scene: &Scene<'_>, options: &Options, (width, height): (u32, u32), times: u32) -> Target {
    let mut target = Target::new(width * times, height * times).unwrap();
    draw(&prepare(scene, options.method, options.filter).unwrap(), &mut target);
    target
}

#[test]
fn samples_lie_where_they_should_and_outlines_are_smooth() {
    for stage in [stages::torus(), stages::fine_sphere(), stages::inside(), stages::crowd()] {
        let (width, height) = stage.size;
        let one = Options { method: Method::Exact, filter: TextureFilter::Trilinear, ..Options::default() };
        let four = Options { samples: Samples::Four, ..one };
        let scene = stage.scene(one.method).unwrap();
        let fine = large(&scene, &one, stage.size, 4);
        let smooth = fine.resolve(4, None).unwrap();
        let count = |x, y| PLACES.iter().filter(|p| fine.depth(4 * x + p[0], 4 * y + p[1]).is_some()).count() as u32;
        for level in levels() {
            let told = format!("{}, {level:?}", stage.name);
            let (rough, _) = by_tiles(level, &scene, &one, stage.size);
            let (found, covered) = by_tiles(level, &scene, &four, stage.size);
            let (mut off, mut drawn, mut same) = (0u32, 0u64, 0u64);
            for y in 0..height {
                for x in 0..width {
                    let alpha = u32::from(found[(x, y)].a);
                    off += u32::from(alpha != (count(x, y) * 255 + 2) / 4);
                    drawn += u64::from(alpha > 0);
                    same += u64::from(alpha > 0 && found[(x, y)] == rough[(x, y)]);
                }
            }
            assert_eq!(covered, drawn, "{told}");
            assert!(f64::from(off) <= SHARE_OFF * f64::from(width * height), "{told}: {off} pixels");
            // Inside of surfaces nothing changes: each is shaded once, at the pixel's centre.
            assert!(same * 10 > drawn * 6, "{told}: {same} of {drawn}");
            let error = |picture: &Picture| picture_stats(&smooth, picture).unwrap().psnr_db;
            let (before, after) = (error(&rough), error(&found));
            assert!(after > before + 1.0, "{told}: {before:.1} dB, {after:.1} dB with four samples");
        }
    }
}

#[test]
fn outlines_blend_with_the_background_in_linear_light() {
    let mut stage = stages::torus();
    stage.size = (130, 67);
    let background = LinearRgb::new(0.9, 0.1, 0.2);
    let options = Options {
        method: Method::Table,
        filter: TextureFilter::Bilinear,
        samples: Samples::Four,
        background: Some(background),
    };
    let scene = stage.scene(options.method).unwrap();
    let clear = by_tiles(Level::new(), &scene, &Options { background: None, ..options }, stage.size).0;
    let filled = by_tiles(Level::new(), &scene, &options, stage.size).0;
    let mut blended = 0;
    for (&over, &bare) in filled.texels().iter().zip(clear.texels()) {
        assert_eq!(over.a, 255);
        let share = f32::from(bare.a) / 255.0;
        let light = LinearRgb::from_srgb(bare.rgb()) * share + background * (1.0 - share);
        let expected = light.to_srgb();
        let off = over.rgb().iter().zip(expected.rgb()).map(|(&a, b)| a.abs_diff(b)).max().unwrap();
        assert!(off <= 2, "{over:?} is not {expected:?}");
        blended += u32::from(bare.a > 0 && bare.a < 255);
    }
    assert!(blended > 100, "{blended} pixels of outlines");
}
