//! Models, environments, near lights and blending, as pictures show them.

use crate::runner::Room;
use rilievo::color::Picture;
use rilievo::{Grid, Rgba8};
use rilievo_io::{Limits, Source, decode_picture, encode_picture_png};

fn picture(room: &Room, name: &str) -> Picture {
    decode_picture(&Source::open(&room.path(name), &Limits::default()).unwrap(), &Limits::default()).unwrap()
}

/// A smooth sphere of 64 × 64 pixels, seen straight from the front.
fn sphere(room: &Room, flags: &str) -> Picture {
    room.run(&format!("render sphere --method exact --camera 0,0,1.05 --size 64 -o s.png {flags}")).ok();
    picture(room, "s.png")
}

const MODELS: [&str; 11] = [
    "blinn-phong",
    "lambert",
    "phong",
    "doubled-angle",
    "highlight",
    "ambient",
    "steps:3",
    "cartoon",
    "chrome",
    "environment",
    "metallic-roughness:0.5,0.4",
];

#[test]
fn each_model_has_its_look_by_table_and_by_pixel() {
    let room = Room::new();
    room.bump("hill.png");
    let shot = "render sphere --height hill.png --depth 0.05 --map-size 64x32 -n 1024 --effort fast --size 48";
    let mut seen: Vec<Vec<u8>> = Vec::new();
    for model in MODELS {
        let render = |method: &str| {
            room.run(&format!("{shot} --method {method} -o {method}.png --model {model}")).ok();
            room.read(&format!("{method}.png"))
        };
        let (exact, table) = (render("exact"), render("table"));
        assert!(exact != table || ["ambient", "environment"].contains(&model), "{model}");
        // Mirrors without surroundings show an even sky, and ambient light is even too: no table errs there.
        room.run("compare exact.png table.png --as picture --min-psnr 22").ok();
        assert!(!seen.contains(&exact), "{model} looks like another");
        seen.push(exact);
    }
    room.run(&format!("{shot} --method exact -o d.png")).ok();
    assert_eq!(room.read("d.png"), seen[0]);
}

#[test]
fn chrome_is_blue_above_and_brown_below() {
    let room = Room::new();
    let lit = sphere(&room, "--model chrome");
    let (above, below) = (lit[(32, 14)], lit[(32, 50)]);
    assert!(above.b > above.r && below.r > below.b, "{above:?} {below:?}");
}

#[test]
fn panoramas_are_mirrored_where_they_are() {
    let room = Room::new();
    // Red on the right half, blue on the left; the middle is behind the object.
    let half = |x: u32, _| if x < 32 { Rgba8::new(0, 0, 255, 255) } else { Rgba8::new(255, 0, 0, 255) };
    let picture: Picture = Grid::from_fn(64, 32, half).unwrap();
    room.write("sky.png", &encode_picture_png(&picture).unwrap());
    let lit = sphere(&room, "--model environment --environment sky.png");
    assert_eq!((lit[(48, 32)].rgb(), lit[(16, 32)].rgb()), ([255, 0, 0], [0, 0, 255]));
    // Half a turn: left and right change places.
    let lit = sphere(&room, "--model environment --environment sky.png --turn-environment 180");
    assert_eq!((lit[(48, 32)].rgb(), lit[(16, 32)].rgb()), ([0, 0, 255], [255, 0, 0]));
    room.run("render sphere --method exact --size 32 -o n.png --environment sky.png")
        .warns(&["--environment", "not used"]);
    room.run("render sphere --method exact --size 32 -o n.png --environment sky.png --model lambert")
        .warns(&["--environment", "not used"]);
    room.run("render sphere --method exact --size 32 -o sky.png --environment sky.png --model environment")
        .fails(2, &["sky.png"]);
    let odd = encode_picture_png(&Grid::filled(5, 3, Rgba8::default()).unwrap()).unwrap();
    room.write("odd.png", &odd);
    room.run("render sphere --method exact --size 32 -o n.png --environment odd.png --model environment")
        .fails(5, &["odd.png", "square"]);
}

#[test]
fn matcaps_are_seen_as_they_are() {
    let room = Room::new();
    let lit_sphere = |x: u32, y: u32| Rgba8::new(255 - 3 * x as u8, 255 - 3 * y as u8, 40, 255);
    room.write("matcap.png", &encode_picture_png(&Grid::from_fn(64, 64, lit_sphere).unwrap()).unwrap());
    let seen = sphere(&room, "--model environment --environment matcap.png");
    for (x, y) in [(32, 32), (20, 32), (44, 30), (32, 16), (30, 48)] {
        let (found, painted) = (seen[(x, y)], lit_sphere(x, y));
        assert!(found.r.abs_diff(painted.r) < 14 && found.g.abs_diff(painted.g) < 14, "{x} {y}: {found:?} {painted:?}");
    }
}

#[test]
fn near_lights_light_their_side_and_fall_off() {
    let room = Room::new();
    let dark = "--light 0,0,000000 --ambient 000000 --model lambert";
    let near = sphere(&room, &format!("{dark} --point-light -90,0,3"));
    let far = sphere(&room, &format!("{dark} --point-light -90,0,100"));
    // The left is lit; a near light covers less of the sphere, and its near side more brightly.
    assert!(near[(8, 32)].g > 150 && near[(58, 32)].g == 0, "{:?}", near[(8, 32)]);
    let lit = |p: &Picture| p.texels().iter().filter(|c| c.g > 0).count();
    assert!(lit(&near) * 10 < lit(&far) * 9, "{} {}", lit(&near), lit(&far));
    assert!(near[(5, 32)].g > far[(5, 32)].g);
}

#[test]
fn blends_differ_where_highlights_meet_colour() {
    let room = Room::new();
    let dim = |blend: &str| {
        let flags = format!("--blend {blend} --light 0,0,808080 --ambient 000000 --material 0,ffffff,ffffff,20");
        sphere(&room, &flags)[(32, 32)].g
    };
    // Light of 0.216: sum 0.432, eq. (1) 0.385, eq. (2) 0.216.
    for (blend, expected) in [("add", 175u8), ("material", 175), ("exact", 166), ("approximate", 128)] {
        assert!(dim(blend).abs_diff(expected) < 3, "{blend}: {} for {expected}", dim(blend));
    }
}

#[test]
fn sums_are_sums() {
    let room = Room::new();
    let dark = "--light 0,0 --ambient 000000";
    let half = sphere(&room, &format!("{dark} --model lambert*0.5"));
    let twice = sphere(&room, &format!("{dark} --model lambert*0.25 --model lambert*0.25"));
    assert_eq!(half, twice);
    room.run("render sphere --method exact --model shiny").fails(2, &["shiny", "metallic-roughness"]);
}

#[test]
fn flat_maps_are_relit_with_models_and_mirrors() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 256 -o q.png").ok();
    room.run("quantize n.png -n 256 -o q.ktx2").ok();
    room.run("relight q.png -o lit.png --model chrome").ok();
    let lit = picture(&room, "lit.png");
    // The slope that faces up mirrors the sky.
    assert!(lit[(20, 12)].b > lit[(20, 12)].r && lit[(20, 28)].r > lit[(20, 28)].b);
    for flags in ["--model cartoon", "--model doubled-angle --blend exact", "--model metallic-roughness:1"] {
        room.run(&format!("relight q.png -o a.png {flags}")).ok();
        room.run(&format!("relight q.ktx2 -o b.png {flags}")).ok();
        assert_eq!(picture(&room, "a.png"), picture(&room, "b.png"), "{flags}");
    }
}
