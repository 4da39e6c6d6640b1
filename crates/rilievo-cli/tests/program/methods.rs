//! All methods, by both renderers.

use std::path::Path;

use crate::runner::Room;

const METHODS: [&str; 7] = ["table", "exact", "static", "linear", "normalized", "quadratic", "polar"];

/// A bumpy ring, coarse enough for interpolation to show.
const RING: &str = "render torus:16x9 --normals n.png --repeat 6,3 --size 240x180 --camera 20,35 --background 202428";

#[test]
fn each_method_resembles_the_exact_one() {
    let room = Room::new();
    room.bump_normals("n.png");
    for method in METHODS {
        let said = room.run(&format!("{RING} --method {method} -o {method}.png --json")).ok().json();
        assert_eq!((said["method"].as_str(), said["renderer"].as_str()), (Some(method), Some("tiles")));
    }
    let bars = [("table", 34), ("static", 36), ("linear", 32), ("normalized", 40), ("quadratic", 42), ("polar", 30)];
    for (method, psnr) in bars {
        room.run(&format!("compare exact.png {method}.png --as picture --min-psnr {psnr}")).ok();
        assert!(room.read("exact.png") != room.read(&format!("{method}.png")), "{method}");
    }
}

#[test]
fn both_renderers_agree() {
    let room = Room::new();
    room.bump_normals("n.png");
    for method in METHODS {
        let fast = room.run(&format!("{RING} --method {method} -o fast.png --json")).ok().json();
        let slow = room.run(&format!("{RING} --method {method} -o slow.png --json --reference")).ok().json();
        assert_eq!(slow["renderer"].as_str(), Some("reference"));
        assert_eq!(fast["covered_pixels"], slow["covered_pixels"], "{method}");
        room.run("compare slow.png fast.png --as picture --min-psnr 50").ok();
    }
}

#[test]
fn samples_are_averaged_alike_and_borders_stay_transparent() {
    let room = Room::new();
    for background in ["", "--background 804020"] {
        let shot = format!("render sphere --method exact --size 61x47 --supersample 3 {background}");
        let fast = room.run(&format!("{shot} -o fast.png --json")).ok().json();
        let slow = room.run(&format!("{shot} -o slow.png --json --reference")).ok().json();
        assert_eq!(fast["covered_pixels"], slow["covered_pixels"]);
        room.run("compare slow.png fast.png --as picture --min-psnr 50").ok();
        let alphas = |name: &str| {
            let source = rilievo_io::Source::open(&room.path(name), &rilievo_io::Limits::default()).unwrap();
            let picture = rilievo_io::decode_picture(&source, &rilievo_io::Limits::default()).unwrap();
            picture.texels().iter().map(|p| p.a).collect::<Vec<_>>()
        };
        let (fast, slow) = (alphas("fast.png"), alphas("slow.png"));
        assert_eq!(fast, slow);
        assert_eq!(fast.iter().any(|&a| a != 0 && a != 255), background.is_empty());
    }
}

#[test]
fn the_quadratic_method_has_orders_and_midpoints() {
    let room = Room::new();
    room.bump_normals("n.png");
    let shot = |name: &str, flags: &str| {
        let said = room.run(&format!("{RING} -o {name}.png {flags}")).ok();
        assert!(!said.stderr.contains("warning"), "{}", said.stderr);
        room.read(&format!("{name}.png"))
    };
    let auto = shot("auto", "--method quadratic");
    assert!(auto == shot("said", "--method quadratic --order auto --midpoints gram-schmidt"));
    assert!(shot("linear", "--method linear") == shot("order", "--method quadratic --order linear"));
    let frames = shot("frames", "--method quadratic --order quadratic --midpoints frames");
    let averaged = shot("averaged", "--method quadratic --order quadratic --midpoints averaged");
    assert!(frames != averaged && averaged != auto && auto != frames);
    room.run(&format!("{RING} --order linear --midpoints frames"))
        .warns(&["--order: not used", "--midpoints: not used"]);
    room.run(&format!("{RING} --method quadratic --order linear --midpoints frames")).warns(&["--midpoints: not used"]);
}

#[test]
fn polar_units_take_any_map_and_differ_as_they_should() {
    let room = Room::new();
    room.bump("hill.png");
    room.bump_normals("n.png");
    room.run("normal hill.png --depth 0.1 --onto sphere --map-size 256 -o o.png").ok();
    room.run("quantize o.png --space object -n 64 -o o.ktx2").ok();
    for map in ["--normals n.png", "--height hill.png --depth 0.1", "--normals o.png --space object", ""] {
        let shot = format!("render sphere {map} --size 128 --sampling nearest --background 404040");
        room.run(&format!("{shot} --method exact -o exact.png")).ok();
        for (unit, psnr) in [("e1", 32), ("e3", 32), ("kim", 32), ("peercy", 32)] {
            let said = room.run(&format!("{shot} --method polar --unit {unit} -o {unit}.png --json")).ok().json();
            assert_eq!(said["method"], "polar");
            room.run(&format!("compare exact.png {unit}.png --as picture --min-psnr {psnr}")).ok();
        }
        // The published rotation is wrong, and shows it.
        room.run(&format!("{shot} --method polar --unit published -o p.png")).ok();
        room.run("compare exact.png p.png --as picture --min-psnr 32").fails(1, &[]);
    }
    let shot = "render sphere --normals n.png --size 64 --method polar -o p.png";
    room.run(&format!("{shot} --unit e3 --table-bits 4")).ok();
    let coarse = room.read("p.png");
    room.run(&format!("{shot} --unit e3 --table-bits 12")).ok();
    assert!(coarse != room.read("p.png"));
    room.run(&format!("{shot} --unit e5")).fails(2, &["'e5'", "published", "e4d"]);
    for bits in [3, 15] {
        room.run(&format!("{shot} --table-bits {bits}")).fails(2, &["4 to 14"]);
    }
    room.run(&format!("{shot} --model chrome")).fails(2, &["polar", "Blinn-Phong"]);
    let point = "--point-light -60,20,1.3,ffc080*2";
    room.run(&format!("{shot} --unit e4d {point}")).fails(2, &["e4d"]);
    room.run(&format!("{shot} --unit e4 {point}")).ok();
    room.run("render sphere --indexed o.ktx2 --method polar --size 64").fails(2, &["index map", "normal map"]);
    room.run("render sphere --method exact --size 64 --unit e1 -o s.png").warns(&["--unit: not used"]);
}

#[test]
fn interpolated_vectors_take_heights_and_smooth_meshes_and_refuse_the_rest() {
    let room = Room::new();
    room.bump("hill.png");
    room.bump_normals("n.png");
    room.run("normal hill.png --onto sphere -o o.png").ok();
    room.run("quantize o.png --space object -n 64 -o o.ktx2").ok();
    // Heights are what the height stage makes of them.
    room.run("normal hill.png --depth 0.1 -o same.exr").ok();
    for method in ["linear", "normalized", "quadratic"] {
        let shot = format!("render sphere --size 64 --method {method}");
        room.run(&format!("{shot} --height hill.png --depth 0.1 -o heights.png")).ok();
        room.run(&format!("{shot} --normals same.exr -o normals.png")).ok();
        room.run("compare heights.png normals.png --as picture --min-psnr 45").ok();
        room.run(&format!("{shot} -o smooth.png")).ok();
        room.run("render sphere --size 64 --method exact -o exact.png").ok();
        room.run("compare exact.png smooth.png --as picture --min-psnr 40").ok();
        room.run(&format!("{shot} --normals o.png --space object"))
            .fails(2, &["tangent-space", "table, exact and static"]);
        room.run(&format!("{shot} --indexed o.ktx2")).fails(2, &["tangent-space", "index map"]);
        room.run(&format!("{shot} --model chrome")).fails(2, &[method, "Blinn-Phong", "exact"]);
        room.run(&format!("{shot} --height hill.png --map-size 64 -n 9 -o h.png"))
            .warns(&["--map-size: not used", "-n: not used"]);
    }
}

#[test]
fn light_maps_stand_still() {
    let room = Room::new();
    let frames = |turn: &str| {
        let said =
            room.run(&format!("render torus:24x12 --method static --size 32 --frames 3 --turn {turn} -o f.png")).ok();
        assert!(said.stderr.contains("the light map is that of the first frame"), "{}", said.stderr);
        frames_of(&room.read("f.png"))
    };
    let light = frames("light");
    assert!(light.len() == 3 && light[0] == light[1] && light[1] == light[2]);
    let object = frames("camera");
    assert!(object[0] != object[1]);
    let said = room.run("render torus:24x12 --method static --size 32 -o one.png").ok();
    assert!(!said.stderr.contains("first frame"), "{}", said.stderr);
}

/// The frames of an animated PNG of which each covers the whole picture.
fn frames_of(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let count = reader.info().animation_control().map_or(1, |a| a.num_frames);
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let mut frames = Vec::new();
    for _ in 0..count {
        reader.next_frame(&mut buffer).unwrap();
        frames.push(buffer.clone());
    }
    frames
}

#[test]
fn frames_of_an_animation_are_what_single_pictures_show() {
    let room = Room::new();
    room.bump("hill.png");
    let shot = "render sphere --height hill.png --depth 0.1 --map-size 128x64 -n 200 --size 40";
    let said = room.run(&format!("{shot} --frames 4 --turn camera -o f.png --json")).ok().json();
    assert!(said["map_seconds"].is_number() && said["frames"] == 4);
    let frames = frames_of(&room.read("f.png"));
    for (i, azimuth) in [0, 90, 180, 270].into_iter().enumerate() {
        room.run(&format!("{shot} --camera {azimuth},15,1.05 -o one.png")).ok();
        let one = frames_of(&room.read("one.png"));
        let off = one[0].iter().zip(&frames[i]).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert!(off * 200 < one[0].len(), "frame {i}: {off} values differ");
    }
    // Whatever turns, the first frame is the picture itself.
    for turn in ["object", "light"] {
        room.run(&format!("{shot} --frames 2 --turn {turn} -o f.png")).ok();
        room.run(&format!("{shot} -o one.png")).ok();
        let turned = frames_of(&room.read("f.png"));
        assert!(turned[0] == frames_of(&room.read("one.png"))[0] && turned[0] != turned[1], "{turn}");
    }
}

#[test]
fn triangles_left_out_are_told() {
    let room = Room::new();
    let said = room.run("render sphere --method exact --size 64 -o s.png --json").ok();
    let skipped = &said.json()["skipped"];
    // Half of a ball is turned away.
    assert!(skipped["back_facing"].as_u64().unwrap() > 1500 && skipped["outside"] == 0, "{skipped}");
    let behind = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n[[objects]]\n[[objects]]\nposition = [0, 0, 20]\n";
    room.write("behind.toml", behind.as_bytes());
    let said = room.run("render behind.toml --method exact --size 64 -o s.png --json").ok();
    let (report, ball) = (said.json(), 2 * 64 * 31);
    assert!(report["skipped"]["outside"] == ball && report["triangles"] == 2 * ball, "{report}");
    assert!(said.stderr.contains("outside the view or behind the camera"), "{}", said.stderr);
    room.write("flat.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    let flat = room.run("render flat.obj --method exact --size 64 -o s.png --json").ok();
    assert_eq!(flat.json()["skipped"]["without_area"], 1);
    assert!(flat.stderr.contains("1 triangles without an area"), "{}", flat.stderr);
    let quiet = room.run("render behind.toml --method exact --size 64 -o s.png --quiet").ok();
    assert!(quiet.stderr.is_empty(), "{}", quiet.stderr);
}

#[test]
fn sizes_are_refused_before_anything_is_read() {
    let room = Room::new();
    // The mesh is not there: had it been looked for, the code would be another.
    room.run("render gone.obj --size 20000x10").fails(2, &["20000 x 10", "16384"]);
    room.run("render gone.obj --size 5000 --supersample 4").fails(2, &["4 x 4 samples", "20000 x 20000", "16384"]);
    room.run("render gone.obj --size 4000 --frames 1000").fails(2, &["1000 frames", "4 GiB"]);
    assert!(room.files().is_empty());
}

#[test]
fn meshes_come_from_stdin_and_pictures_go_to_stdout() {
    let room = Room::new();
    let mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let args = ["render", "-", "--method", "exact", "--size", "32", "-o", "-"].map(Path::new);
    let said = room.run_with(&args, mesh).ok();
    room.write("t.obj", mesh);
    room.run("render t.obj --method exact --size 32 -o t.png").ok();
    assert!(said.stdout == room.read("t.png"));
    // Without texture coordinates there is nothing to look up.
    room.run("render t.obj --size 32").fails(2, &["texture coordinates", "exact"]);
}
