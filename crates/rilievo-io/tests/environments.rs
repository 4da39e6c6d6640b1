//! Surroundings from files: made by hand, damaged, and real.

use glam::Vec3;
use rilievo::light::Projection;
use rilievo::{Convention, Grid, LinearRgb, Normal, Tangent};
use rilievo_io::*;
use testkit::{Random, shared_file};

/// A Radiance file of RGBE texels, not compressed.
fn radiance(header: &str, width: u32, height: u32, texels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = format!("{header}\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    bytes.extend(texels.as_flattened());
    bytes
}

fn decode(bytes: Vec<u8>) -> Result<EnvironmentImage> {
    decode_environment(&Source::from_bytes("sky", bytes), &Limits { max_texels: 1 << 20, ..Limits::default() })
}

#[test]
fn radiance_texels_are_mantissas_times_powers_of_two() {
    // 2^(e − 136) times the mantissa.
    let texels = [[128, 64, 0, 129], [255, 1, 10, 140], [0, 0, 0, 0], [200, 100, 50, 120]];
    let expected = [[1.0, 0.5, 0.0], [4080.0, 16.0, 160.0], [0.0; 3], [200.0, 100.0, 50.0].map(|v| v / 65_536.0)];
    for header in ["#?RADIANCE", "#?RGBE"] {
        let image = decode(radiance(header, 4, 1, &texels)).unwrap();
        let found: Vec<[f32; 3]> = image.picture.texels().iter().map(|c| [c.r, c.g, c.b]).collect();
        assert_eq!(found, expected);
        assert_eq!(image.projection(), None);
    }
    let exposed = decode(radiance("#?RADIANCE\nEXPOSURE=4", 4, 1, &texels)).unwrap();
    assert_eq!(exposed.picture.texels()[0], LinearRgb::new(0.25, 0.125, 0.0));
}

#[test]
fn runs_are_unpacked_for_each_component() {
    let mut bytes = radiance("#?RADIANCE", 8, 4, &[]);
    for row in 0..4u8 {
        bytes.extend([2, 2, 0, 8]);
        // Red a run of 8, green 8 values, blue two runs, one exponent.
        bytes.extend([128 + 8, 128]);
        bytes.extend([8, 0, 16, 32, 48, 64, 80, 96, 112]);
        bytes.extend([128 + 4, 10, 128 + 4, row]);
        bytes.extend([128 + 8, 129]);
    }
    let image = decode(bytes).unwrap();
    assert_eq!(image.projection(), Some(Projection::Equirectangular));
    let c = image.picture[(5, 3)];
    assert_eq!([c.r, c.g, c.b], [1.0, 80.0 / 128.0, 3.0 / 128.0]);
}

#[test]
fn cut_and_damaged_files_are_errors_or_sound() {
    let texels: Vec<[u8; 4]> = (0..32).map(|i| [i * 7, 255 - i, i, 120 + i % 16]).collect();
    let whole = radiance("#?RADIANCE", 8, 4, &texels);
    assert!(decode(whole.clone()).is_ok());
    for end in 0..whole.len() {
        assert!(decode(whole[..end].to_vec()).is_err(), "the first {end} bytes are read");
    }
    let mut random = Random::new(7);
    for _ in 0..3000 {
        let mut bytes = whole.clone();
        for _ in 0..3 {
            let at = (random.unit() * bytes.len() as f64) as usize;
            bytes[at] = (random.unit() * 256.0) as u8;
        }
        if let Ok(image) = decode(bytes) {
            let sound = |v: f32| v.is_finite() && v >= 0.0;
            assert!(image.picture.texels().iter().all(|c| sound(c.r) && sound(c.g) && sound(c.b)));
        }
    }
    for size in ["-Y 60000 +X 60000", "-Y 0 +X 4", "-Y 1 +X 70000", "-Y 99999999999 +X 2", "-Y 1024 +X 1024"] {
        let refused = decode(format!("#?RADIANCE\n\n{size}\nxxxxxxxx").into_bytes());
        assert!(refused.is_err(), "{size}");
    }
}

#[test]
fn pictures_are_srgb_and_floats_are_linear() {
    let gray = Grid::new(1, 1, vec![188u8]).unwrap();
    let image = decode(encode_gray_png8(&gray).unwrap()).unwrap();
    // 188 is half of the light.
    assert!((image.picture.texels()[0].g - 0.5).abs() < 0.005 && image.projection() == Some(Projection::Matcap));
    // An EXR keeps its numbers; a normal map's negative ones are no light.
    let normals = Grid::filled(2, 1, Normal::<Tangent>::new(Vec3::new(0.6, -0.8, 0.0)).unwrap()).unwrap();
    let image = decode(encode_normals_exr(&normals, Convention::Gl, None).unwrap()).unwrap();
    let c = image.picture.texels()[1];
    assert!((c.r - 0.6).abs() < 1e-6 && c.g == 0.0);
    assert!(image.warnings[0].contains("2 texels hold negative light"), "{:?}", image.warnings);
}

#[test]
fn shapes_decide_and_odd_ones_are_refused() {
    let read = |w, h| {
        let bytes = encode_gray_png8(&Grid::filled(w, h, 99u8).unwrap()).unwrap();
        read_environment(&Source::from_bytes("sky.png", bytes), &Limits::default())
    };
    assert_eq!(read(6, 3).unwrap().0.projection(), Projection::Equirectangular);
    assert_eq!(read(5, 5).unwrap().0.projection(), Projection::Matcap);
    let message = read(5, 3).unwrap_err().to_string();
    assert!(message.contains("sky.png") && message.contains("5 × 3") && message.contains("square"), "{message}");
}

#[test]
fn real_panoramas_have_the_sky_above() {
    for name in ["env/city_512x256.hdr", "env/sunset_512x256.hdr", "env/mx_table_mountain_irr.hdr"] {
        let Some(path) = shared_file(name) else { return };
        let source = Source::open(&path, &Limits::default()).unwrap();
        let (environment, warnings) = read_environment(&source, &Limits::default()).unwrap();
        assert!(warnings.is_empty() && environment.projection() == Projection::Equirectangular, "{warnings:?}");
        // A mirror that faces up is seen from above, one that faces down from below.
        let sum = |y: f32| {
            let c = environment.reflected(Vec3::Y * y, Vec3::Y * y, 1.0);
            c.r + c.g + c.b
        };
        assert!(sum(1.0) > sum(-1.0), "{name}: {} above, {} below", sum(1.0), sum(-1.0));
    }
}

#[test]
fn dwab_is_refused_with_a_remedy() {
    let Some(path) = shared_file("env/city_dwab.exr") else { return };
    let refused = read_environment(&Source::open(&path, &Limits::default()).unwrap(), &Limits::default());
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("DWAB") && message.contains("ZIP"), "{message}");
}
