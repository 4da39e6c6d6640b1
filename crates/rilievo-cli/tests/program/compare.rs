use crate::runner::Room;
use rilievo::{Grid, Rgba8};

#[test]
fn equal_pictures_are_equal_and_thresholds_set_the_exit_code() {
    let room = Room::new();
    let a = Grid::from_fn(20, 10, |x, y| Rgba8::new(x as u8 * 5, y as u8 * 20, 77, 255)).unwrap();
    let b = a.map(|p| Rgba8 { g: p.g + 3, ..*p });
    room.write("a.png", &rilievo_io::encode_picture_png(&a).unwrap());
    room.write("b.png", &rilievo_io::encode_picture_png(&b).unwrap());
    let same = room.run("compare a.png a.png --min-psnr 99 --max-flip 0 --json").ok().json();
    assert_eq!((same["max_abs"].as_u64(), same["flip_mean"].as_f64()), (Some(0), Some(0.0)));
    assert!(same["psnr_db"].is_null(), "infinite has no number in JSON: {same}");
    let said = room.run("compare a.png b.png --json").ok().json();
    // Three steps in one channel of three: 10 log10(255² · 3 / 9).
    assert!((said["psnr_db"].as_f64().unwrap() - 43.359).abs() < 0.01, "{said}");
    assert_eq!(said["max_abs"], 3);
    for key in ["nmse", "rnmse", "pmse", "rpmse"] {
        let values = said[key].as_array().unwrap();
        assert!(values.len() == 3 && values[0] == 0.0 && values[1].as_f64().unwrap() > 0.0, "{key} in {said}");
    }
    assert_eq!(room.run("compare a.png b.png --min-psnr 45").code, 1);
    assert_eq!(room.run("compare a.png b.png --max-abs 2").code, 1);
    assert_eq!(room.run("compare a.png b.png --max-abs 3").code, 0);
}

#[test]
fn normal_maps_are_found_out_and_measured_in_degrees() {
    let room = Room::new();
    room.bump_normals("n.png");
    let said = room.run("compare n.png n.png --json").ok().json();
    assert_eq!((said["kind"].as_str(), said["max_deg"].as_f64()), (Some("normals"), Some(0.0)));
    room.run("quantize n.png -n 16 -o q.png").ok();
    assert_eq!(room.run("compare n.png q.png --max-rms 0.001").code, 1);
    room.run("compare n.png q.png --min-psnr 30").fails(2, &["--min-psnr"]);
}

#[test]
fn sizes_must_agree() {
    let room = Room::new();
    for (name, w) in [("a.png", 4), ("b.png", 5)] {
        let picture = Grid::filled(w, 3, Rgba8::new(9, 9, 9, 255)).unwrap();
        room.write(name, &rilievo_io::encode_picture_png(&picture).unwrap());
    }
    room.run("compare a.png b.png").fails(4, &["4 × 3", "5 × 3"]);
}

#[test]
fn only_texels_covered_in_both_count_whichever_comes_first() {
    let room = Room::new();
    let normals = |z: f32| {
        Grid::filled(4, 2, rilievo::Normal::<rilievo::Tangent>::new(glam::Vec3::new(0.2, 0.0, z)).unwrap()).unwrap()
    };
    let half = Grid::from_fn(4, 2, |x, _| x < 2).unwrap();
    let gl = rilievo::Convention::Gl;
    room.write("half.png", &rilievo_io::encode_normals_png16(&normals(1.0), gl, Some(&half)).unwrap());
    room.write("full.png", &rilievo_io::encode_normals_png16(&normals(0.9), gl, None).unwrap());
    for args in ["compare half.png full.png --as normals --json", "compare full.png half.png --as normals --json"] {
        assert_eq!(room.run(args).ok().json()["texels"], 4, "{args}");
    }
}
