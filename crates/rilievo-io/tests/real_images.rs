//! Real maps of the collection, against what is known of them.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use rilievo::{Convention, Tangent};
use rilievo_io::*;
use testkit::shared_file;

fn source(name: &str) -> Option<Source> {
    Some(Source::open(&shared_file(name)?, &Limits::default()).unwrap())
}

#[test]
fn analytic_heights_agree_in_8_and_16_bits() {
    let (Some(eight), Some(sixteen)) =
        (source("analytic/waves_4_4_height8.png"), source("analytic/waves_4_4_height16.png"))
    else {
        return;
    };
    let limits = Limits::default();
    let (eight, sixteen) = (decode_height(&eight, &limits).unwrap(), decode_height(&sixteen, &limits).unwrap());
    assert_eq!((eight.depth, sixteen.depth), (Depth::U8, Depth::U16));
    let pairs = eight.heights.texels().iter().zip(sixteen.heights.texels());
    let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Rounding to 8 bits, plus rounding to 16.
    assert!(worst <= 0.5 / 255.0 + 1.0 / 65_535.0, "{worst}");
}

#[test]
fn analytic_normals_of_half_floats_are_units() {
    let Some(source) = source("analytic/hemispheres_6_normal_f16.npy") else { return };
    let map = decode_normals::<Tangent>(&source, Convention::Gl, &Limits::default()).unwrap();
    assert_eq!((map.depth, map.normals.size(), map.warnings.len()), (Depth::F32, (512, 512), 0));
}

#[test]
fn normal_maps_are_not_heights_and_heights_are_not_normals() {
    let limits = Limits::default();
    for name in ["normal/Bricks076C_normal.png", "normal/WoodFloor043_1K_NormalGL.jpg", "normal/bevy_cube_normal.png"] {
        let Some(source) = source(name) else { return };
        let map = decode_normals::<Tangent>(&source, Convention::Gl, &limits).unwrap();
        let up = map.normals.texels().iter().filter(|n| n.vec().z > 0.0).count();
        assert!(up as f64 > 0.99 * map.normals.texels().len() as f64, "{name}");
        let message = decode_height(&source, &limits).unwrap_err().to_string();
        assert!(message.contains("normal map"), "{message}");
    }
    for name in ["height/earth-topology.png", "height/bevy_cube_depth.png", "height/jacksboro_dem_16.png"] {
        let Some(source) = source(name) else { return };
        decode_height(&source, &limits).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn dwab_exr_is_refused_with_a_remedy() {
    let Some(source) = source("env/city_dwab.exr") else { return };
    let error = decode_normals::<Tangent>(&source, Convention::Gl, &Limits::default()).unwrap_err();
    assert!(
        matches!(&error, Error::Unsupported { what, remedy, .. } if what.contains("DWAB") && remedy.contains("ZIP"))
    );
}
