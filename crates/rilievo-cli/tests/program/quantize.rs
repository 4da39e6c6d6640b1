use testkit::write_npy_f32;

use crate::runner::Room;

#[test]
fn reports_what_scripts_rely_on() {
    let room = Room::new();
    room.bump_normals("n.png");
    let said = room.run("quantize n.png -n 64 --json").ok().json();
    for key in ["entries", "rms_deg", "mean_deg", "p99_deg", "max_deg", "bound_rms_deg", "bytes", "seconds"] {
        assert!(said[key].is_number(), "{key} in {said}");
    }
    assert_eq!(said["entries"], 64);
    assert_eq!(said["bytes"].as_u64().unwrap(), room.read("n_64.png").len() as u64);
    // What the report says is what the file holds.
    let seen = room.run("compare n.png n_64.png --as normals --json").ok().json();
    let (a, b) = (said["rms_deg"].as_f64().unwrap(), seen["rms_deg"].as_f64().unwrap());
    assert!((a - b).abs() < 1e-4 && a > 0.0, "{a} {b}");
}

#[test]
fn more_entries_are_closer_and_files_are_the_same_for_any_thread_count() {
    let room = Room::new();
    room.bump_normals("n.png");
    let rms = |args: &str| room.run(&format!("quantize n.png --json {args}")).ok().json()["rms_deg"].as_f64().unwrap();
    let coarse = rms("-n 8 -o a.png");
    let fine = rms("-n 200 -o b.ktx2 --threads 1");
    assert!(coarse > 2.0 * fine, "{coarse} {fine}");
    rms("-n 200 -o c.ktx2 --threads 2");
    assert_eq!(room.read("b.ktx2"), room.read("c.ktx2"));
}

#[test]
fn few_distinct_normals_give_few_entries_and_say_so() {
    let room = Room::new();
    room.bump("flat.png");
    room.run("normal flat.png --depth 0 -o n.png").ok();
    let said = room.run("quantize n.png -n 256 --json").ok();
    assert_eq!(said.json()["entries"], 1);
    assert!(said.stderr.contains("distinct"), "{}", said.stderr);
}

#[test]
fn max_rms_finds_the_smallest_table() {
    let room = Room::new();
    room.bump_normals("n.png");
    let said = room.run("quantize n.png --max-rms 0.8 --json").ok().json();
    let entries = said["entries"].as_u64().unwrap();
    assert!(said["rms_deg"].as_f64().unwrap() <= 0.8 && entries > 2, "{said}");
    let less = room.run(&format!("quantize n.png -n {} --json -o less.ktx2", entries - 1)).ok().json();
    assert!(less["rms_deg"].as_f64().unwrap() > 0.8, "{less}");
    assert_eq!(room.files(), ["less.ktx2", "n.png", "n_0.8deg.ktx2"]);
    // Dithered texels err more, each by itself; the error that is asked for is that of the texels as written.
    let dithered = room.run("quantize n.png --max-rms 0.8 --dither diffusion -o d.ktx2 --json").ok().json();
    assert!(dithered["rms_deg"].as_f64().unwrap() <= 0.8 && dithered["entries"].as_u64().unwrap() > entries);
    room.run("quantize n.png --max-rms -1").fails(2, &[]);
    room.run("quantize n.png --max-rms 1 -n 16").fails(2, &["--max-rms"]);
}

#[test]
fn materials_stay_apart() {
    let room = Room::new();
    room.bump_normals("n.png");
    let materials = rilievo::Grid::from_fn(64, 48, |x, y| u8::from((x / 5 + y / 7) % 2 == 0) * 3).unwrap();
    room.write("m.png", &rilievo_io::encode_gray_png8(&materials).unwrap());
    room.run("quantize n.png --materials m.png -n 32 -o q.png").ok();
    let source = rilievo_io::Source::open(&room.path("q.png"), &Default::default()).unwrap();
    let file = rilievo_io::decode_indexed(&source, &Default::default(), &Default::default()).unwrap();
    let rilievo_io::AnyIndexed::Tangent(map) = file.map else { panic!("tangent space went in") };
    assert_eq!(map.expand_materials(), materials);
    let small = rilievo::Grid::filled(3, 3, 0u8).unwrap();
    room.write("small.png", &rilievo_io::encode_gray_png8(&small).unwrap());
    room.run("quantize n.png --materials small.png").fails(4, &["3 × 3", "64 × 48"]);
}

#[test]
fn impossible_outputs_are_refused_before_work() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 257 -o q.png").fails(2, &["256", "ktx2"]);
    room.run("quantize n.png -n 16 -o q.jpg").fails(2, &[".ktx2"]);
    room.run("quantize n.png -n 1").fails(2, &["65536"]);
    room.run("quantize n.png -n 16 -o nowhere/q.png").fails(3, &["nowhere"]);
    assert_eq!(room.files(), ["n.png"]);
}

#[test]
fn holes_are_refused_with_their_place_and_repaired_on_demand() {
    let room = Room::new();
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let row = [x, x, [0.0; 3], z, z, [f32::NAN, 0.0, 1.0]];
    room.write("holes.npy", &write_npy_f32(&[1, 6, 3], row.as_flattened()));
    room.run("quantize holes.npy --space object -n 4 -o q.png").fails(4, &["holes.npy", "2 texels", "--repair", "2"]);
    assert_eq!(room.files(), ["holes.npy"]);
    let said = room.run("quantize holes.npy --space object -n 4 --repair -o q.png").ok();
    assert!(said.stderr.contains("2 texels"), "{}", said.stderr);
    let source = rilievo_io::Source::open(&room.path("q.png"), &Default::default()).unwrap();
    let file = rilievo_io::decode_indexed(&source, &Default::default(), &Default::default()).unwrap();
    let rilievo_io::AnyIndexed::Object(map) = file.map else { panic!("object space went in") };
    let near_x: Vec<bool> = map.expand().texels().iter().map(|n| n.vec().x > 0.5).collect();
    // Left before right, and the map repeats: the last texel has a Z on its left and an X on its right.
    assert_eq!(near_x, [true, true, true, false, false, false]);
    room.write("nothing.npy", &write_npy_f32(&[1, 2, 3], &[0.0; 6]));
    room.run("quantize nothing.npy --repair -n 4 -o q.png").fails(4, &["nothing.npy", "not one"]);
}

#[test]
fn levels_are_reported_and_can_be_left_out() {
    let room = Room::new();
    room.bump_normals("n.png");
    let all = room.run("quantize n.png -n 32 -o a.ktx2 --json").ok().json();
    assert_eq!(all["level_mean_deg"].as_array().unwrap().len(), 6, "{all}");
    assert!(all["level_mean_deg"][0].as_f64().unwrap() > 0.0 && all["zador_rms_deg"].as_f64().unwrap() > 0.0);
    let one = room.run("quantize n.png -n 32 -o b.ktx2 --no-mips --json").ok().json();
    assert!(
        one["bytes"].as_u64().unwrap() < all["bytes"].as_u64().unwrap() && one["level_mean_deg"].is_null(),
        "{one}"
    );
    assert!(
        String::from_utf8_lossy(&room.run("quantize n.png -n 32 -o c.ktx2").ok().stdout).contains("level_mean_deg")
    );
}

#[test]
fn dithering_changes_pixels_and_not_the_table() {
    let room = Room::new();
    room.bump_normals("n.png");
    let run = |dither: &str, more: &str| {
        let said =
            room.run(&format!("quantize n.png -n 16 --json --dither {dither} -o {dither}.png {more}")).ok().json();
        let source = rilievo_io::Source::open(&room.path(&format!("{dither}.png")), &Default::default()).unwrap();
        let file = rilievo_io::decode_indexed(&source, &Default::default(), &Default::default()).unwrap();
        let rilievo_io::AnyIndexed::Tangent(map) = file.map else { panic!("tangent space went in") };
        (said["rms_deg"].as_f64().unwrap(), map)
    };
    let (least, plain) = run("none", "");
    room.run("quantize n.png -n 16 -o default.png").ok();
    assert_eq!(room.read("none.png"), room.read("default.png"));
    for dither in ["diffusion", "blue-noise"] {
        let (rms, map) = run(dither, "--threads 1");
        assert!(rms > least && map.table() == plain.table() && map.base() != plain.base(), "{dither}: {rms} {least}");
        // What the report says is what the file holds.
        let seen = room.run(&format!("compare n.png {dither}.png --as normals --json")).ok().json();
        assert!((seen["rms_deg"].as_f64().unwrap() - rms).abs() < 1e-4, "{dither}: {rms} {seen}");
        let bytes = room.read(&format!("{dither}.png"));
        run(dither, "--threads 2");
        assert_eq!(room.read(&format!("{dither}.png")), bytes);
    }
    room.run("quantize n.png --dither ordered").fails(2, &["ordered", "blue-noise", "diffusion"]);
}

#[test]
fn materials_can_come_from_the_colours() {
    let room = Room::new();
    // Two materials in the sub-cubes 000 and 110.
    let color = |x: u32, _: u32| if x < 3 { [64, 64, 127] } else { [192, 192, 127] };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 6, 2);
    encoder.set_color(png::ColorType::Rgb);
    let texels: Vec<u8> = (0..12u32).flat_map(|i| color(i % 6, i / 6)).collect();
    encoder.write_header().unwrap().write_image_data(&texels).unwrap();
    room.write("n.png", &bytes);
    room.run("quantize n.png --materials-in sub-cubes -n 8 -o q.png").ok();
    let source = rilievo_io::Source::open(&room.path("q.png"), &Default::default()).unwrap();
    let file = rilievo_io::decode_indexed(&source, &Default::default(), &Default::default()).unwrap();
    let rilievo_io::AnyIndexed::Tangent(map) = file.map else { panic!("tangent space went in") };
    assert_eq!(map.expand_materials().row(0), [0, 0, 0, 3, 3, 3]);
    assert!(map.expand().texels().iter().all(|n| n.vec().z > 0.99));
    room.run("quantize n.png --materials-in alpha -n 8 -o q.png").fails(4, &["n.png", "alpha"]);
}

/// More than 2²⁴ texels: read row by row, twice.
#[test]
fn large_maps_come_out_like_their_tiles() {
    let room = Room::new();
    let tile = rilievo::Grid::from_fn(256, 64, |x, y| [x as u8, 2 * y as u8 + 60, 230]).unwrap();
    let large = rilievo::Grid::from_fn(8192, 2050, |x, y| tile[(x % 256, y % 64)]).unwrap();
    // 2048 rows are 32 whole tiles; the last two rows are not covered.
    let covered = rilievo::Grid::from_fn(8192, 2050, |_, y| y < 2048).unwrap();
    let materials = rilievo::Grid::from_fn(8192, 2050, |x, _| (x / 128 % 2) as u8).unwrap();
    room.write("tile.png", &rilievo_io::encode_normals_png8(&tile, None).unwrap());
    room.write("large.png", &rilievo_io::encode_normals_png8(&large, Some(&covered)).unwrap());
    room.write("m.png", &rilievo_io::encode_gray_png8(&materials).unwrap());
    let small = room.run("quantize tile.png -n 32 --json").ok().json();
    let said = room.run("quantize large.png -n 32 --json").ok();
    assert!(said.stderr.contains("unit length"), "{}", said.stderr);
    let rms = |v: &serde_json::Value| v["rms_deg"].as_f64().unwrap();
    assert!((rms(&said.json()) / rms(&small) - 1.0).abs() < 1e-6, "{small} {}", said.json());
    room.run("quantize large.png --materials m.png -n 32 -o m32.png").ok();
    let file = rilievo_io::Source::open(&room.path("m32.png"), &Default::default()).unwrap();
    let file = rilievo_io::decode_indexed(&file, &Default::default(), &Default::default()).unwrap();
    let rilievo_io::AnyIndexed::Tangent(map) = file.map else { panic!("tangent space went in") };
    assert_eq!(map.expand_materials(), materials);
    room.run("quantize large.png --materials tile_32.png -n 32").fails(4, &["256 × 64", "8192 × 2050"]);
}
