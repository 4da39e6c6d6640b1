use crate::runner::Room;

#[test]
fn table_and_exact_agree_on_an_embossed_sphere() {
    let room = Room::new();
    room.bump("hill.png");
    let common = "render sphere --height hill.png --depth 0.05 --size 160 --background 808080 --map-size 256x128";
    let said = room.run(&format!("{common} -n 2048 --json -o table.png")).ok().json();
    assert_eq!((said["method"].as_str(), said["frames"].as_u64()), (Some("table"), Some(1)));
    for key in ["seconds_per_frame", "table_seconds", "covered_pixels", "rms_deg"] {
        assert!(said[key].is_number(), "{key} in {said}");
    }
    assert!((12_000..25_600).contains(&said["covered_pixels"].as_u64().unwrap()), "{said}");
    room.run(&format!("{common} --method exact -o exact.png")).ok();
    room.run("compare exact.png table.png --as picture --min-psnr 36").ok();
}

#[test]
fn indexed_files_are_drawn_where_they_may_be() {
    let room = Room::new();
    room.bump("hill.png");
    room.bump_normals("n.png");
    room.run("quantize n.png -n 128 -o flat.png").ok();
    // A flat map on a flat thing: what `relight` shows.
    room.run("render plane --indexed flat.png --size 64 -o plane.png").ok();
    room.run("render sphere --indexed flat.png --size 64").fails(2, &["flat surface"]);
    room.run("normal hill.png --onto torus:24x12 -o o.png").ok();
    room.run("quantize o.png --space object -n 512 -o o.ktx2").ok();
    room.run("render torus:24x12 --indexed o.ktx2 --size 64 -o torus.png").ok();
    // Without a map the mesh's own normals are looked up.
    room.run("render torus:24x12 --size 64 -o own.png").warns(&["own normals"]);
    room.run("render torus:24x12 --size 64 --method exact -o smooth.png").ok();
}

#[test]
fn turntables_are_animated() {
    let room = Room::new();
    room.run("render cube --method exact --size 40x30 --frames 5 -o turn.png --json").ok();
    assert_eq!(room.read("turn.png").windows(4).filter(|w| w == b"fcTL").count(), 5);
}

#[test]
fn a_material_map_of_another_size_names_both() {
    let room = Room::new();
    room.bump("hill.png");
    let small = rilievo::Grid::filled(3, 5, 0u8).unwrap();
    room.write("m.png", &rilievo_io::encode_gray_png8(&small).unwrap());
    let said = room.run("render sphere --height hill.png --materials m.png --size 32");
    assert_eq!(said.code, 2);
    assert!(said.stderr.contains("3 x 5") && said.stderr.contains("64 x 48"), "{}", said.stderr);
}

#[test]
fn flags_change_the_vase() {
    let room = Room::new();
    let shot = |name: &str, flags: &str| {
        room.run(&format!("render vase --method exact --size 48x64 -o {name} {flags}")).ok();
        room.read(name)
    };
    let plain = shot("plain.png", "");
    for (name, flags) in
        [("deep.png", "--depth 0.05"), ("plane8.png", "--filter plane8"), ("turned.png", "--camera 40,10")]
    {
        assert_ne!(shot(name, flags), plain, "{flags}");
    }
}

#[test]
fn covered_pixels_are_pixels_of_the_picture() {
    let room = Room::new();
    let count = |flags: &str| {
        let said = room.run(&format!("render sphere --method exact --size 64 --json -o s.png {flags}")).ok();
        said.json()["covered_pixels"].as_u64().unwrap()
    };
    assert!(count("").abs_diff(count("--supersample 4")) < 40);
}
