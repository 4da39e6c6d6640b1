use crate::runner::Room;
use rilievo::{Convention, Tangent};
use rilievo_io::{Limits, Source, decode_normals};

fn normals(room: &Room, name: &str, convention: Convention) -> rilievo::NormalMap<Tangent> {
    let source = Source::open(&room.path(name), &Limits::default()).unwrap();
    decode_normals(&source, convention, &Limits::default()).unwrap().normals
}

#[test]
fn bumps_are_out_and_green_is_up() {
    let room = Room::new();
    room.bump("hill.png");
    room.run("normal hill.png --depth 0.1").ok();
    assert_eq!(room.files(), ["hill.png", "hill_normal_gl.png"]);
    let map = normals(&room, "hill_normal_gl.png", Convention::Gl);
    // The left slope of a bump faces left, its upper slope faces up.
    assert!(map[(12, 20)].vec().x < -0.1 && map[(28, 20)].vec().x > 0.1);
    assert!(map[(20, 12)].vec().y > 0.1 && map[(20, 28)].vec().y < -0.1);
    assert!(map[(60, 40)].vec().z > 0.9999);
    // In the file of the other convention green is the other way round.
    room.run("normal hill.png --depth 0.1 --convention dx").ok();
    let dx = normals(&room, "hill_normal_dx.png", Convention::Gl);
    assert!(dx[(20, 12)].vec().y < -0.1 && dx[(12, 20)].vec().x < -0.1);
    assert_eq!(normals(&room, "hill_normal_dx.png", Convention::Dx)[(20, 12)], map[(20, 12)]);
}

#[test]
fn sixteen_bits_stay_and_eight_are_dithered() {
    let room = Room::new();
    room.bump("hill.png");
    room.run("normal hill.png --depth 0.01 -o exact.exr").ok();
    room.run("normal hill.png --depth 0.01 -o n16.png").ok();
    room.run("normal hill.png --depth 0.01 --bits 8 -o n8.png").ok();
    room.run("normal hill.png --depth 0.01 --bits 8 --dither diffusion -o n8d.png").ok();
    room.run("normal hill.png --depth 0.01 --bits 8 --dither blue-noise -o n8o.png").ok();
    let worst = |name: &str| {
        let said = room.run(&format!("compare exact.exr {name} --as normals --json")).ok();
        said.json()["max_deg"].as_f64().unwrap()
    };
    assert!(worst("n16.png") <= 0.003, "{}", worst("n16.png"));
    assert!((0.01..1.0).contains(&worst("n8.png")));
    assert_ne!(room.read("n8.png"), room.read("n8d.png"));
    assert_ne!(room.read("n8o.png"), room.read("n8d.png"));
    room.run("normal hill.png --dither blue-noise").fails(2, &["--bits 8"]);
}

#[test]
fn stdin_to_stdout() {
    let room = Room::new();
    let height = std::fs::read(room.bump("hill.png")).unwrap();
    let said = room.run_with(&["normal", "-", "-o", "-"].map(std::path::Path::new), &height).ok();
    room.run("normal hill.png -o file.png").ok();
    assert_eq!(said.stdout, room.read("file.png"));
}

#[test]
fn one_bad_file_does_not_stop_the_rest() {
    let room = Room::new();
    room.bump("a.png");
    room.write("b.png", b"not a picture");
    room.bump("c.png");
    let said = room.run("normal a.png b.png missing.png c.png");
    // Unreadable is 3 and bad is 4: the higher tells, in either order.
    assert_eq!(said.code, 4, "{}", said.stderr);
    assert_eq!(room.run("normal missing.png b.png").code, 4);
    assert!(said.stderr.contains("b.png") && said.stderr.contains("missing.png"));
    assert_eq!(room.files(), ["a.png", "a_normal_gl.png", "b.png", "c.png", "c_normal_gl.png"]);
    room.run("normal a.png c.png -o one.png").fails(2, &["folder"]);
}

#[test]
fn onto_a_mesh_gives_an_object_space_map() {
    let room = Room::new();
    room.bump("hill.png");
    room.run("normal hill.png --onto sphere --depth 0.05 -o o.png").ok();
    let map = normals(&room, "o.png", Convention::Gl);
    // Right of the middle is +X on a globe whose middle faces +Z; the upper rows point up.
    assert!(map[(48, 24)].vec().x > 0.9 && map[(32, 2)].vec().y > 0.9);
    room.bump_normals("n.png");
    room.run("normal n.png --from normal --onto plane -o p.png").ok();
    room.run("compare n.png p.png --as normals --max-deg 0.01").ok();
    room.run("normal n.png --from normal").fails(2, &["--onto"]);
}
