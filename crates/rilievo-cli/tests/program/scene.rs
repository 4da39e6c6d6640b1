//! Scene files: several objects in one picture, and errors that name file, line and key.

use crate::runner::Room;
use rilievo::color::Picture;
use rilievo_io::{Limits, Source, decode_picture};

fn picture(room: &Room, name: &str) -> Picture {
    decode_picture(&Source::open(&room.path(name), &Limits::default()).unwrap(), &Limits::default()).unwrap()
}

fn write(room: &Room, name: &str, scene: &str) {
    room.write(name, scene.as_bytes());
}

#[test]
fn the_documented_example_is_drawn() {
    let page = include_str!("../../../../docs/scenes.md");
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let room = Room::new();
    write(&room, "example.toml", example);
    room.bump("waves.png");
    room.bump_normals("waves_gl.png");
    let said = room.run("render example.toml --size 192x108 --json").ok();
    let report = said.json();
    assert_eq!((report["output"].as_str(), report["objects"].as_u64()), (Some("example_table.png"), Some(4)));
    assert_eq!(report["object_rms_deg"].as_array().map(Vec::len), Some(4));
    // The floor has one normal.
    assert_eq!(report["entries"].as_u64(), Some(2048 + 2048 + 1024 + 1));
    assert!(report["triangles"].as_u64().unwrap() > 5000 && !said.stderr.contains("warning"), "{}", said.stderr);
    room.run("render example.toml --size 192x108 --method exact -o exact.png").ok();
    room.run("compare exact.png example_table.png --as picture --min-psnr 28").ok();
    // Clay is on the left, blue glaze in the middle, the yellow block on the right.
    let seen = picture(&room, "exact.png");
    let (ring, ball, block) = (seen[(51, 35)], seen[(96, 65)], seen[(150, 72)]);
    assert!(ring.r > ring.b && ball.b > ball.r && block.g > block.b, "{ring:?} {ball:?} {block:?}");
}

#[test]
fn a_scene_and_the_same_flags_are_the_same_picture() {
    let room = Room::new();
    room.bump("hill.png");
    write(
        &room,
        "s.toml",
        "[picture]\nsize = [96, 80]\nsamples = 2\nbackground = \"101820\"\n\
         [camera]\nazimuth = 30\nelevation = 20\n\
         [environment]\nambient = \"ffffff*0.2\"\n\
         [[lights]]\nazimuth = -30\nelevation = 50\ncolor = \"ffddaa*1.1\"\n\
         [materials.m]\ndiffuse = \"80a0c0\"\nspecular = \"ffffff*0.3\"\nshininess = 25\n\
         [[objects]]\nshape = \"torus:24x12\"\nheight = \"hill.png\"\ndepth = 0.1\nrepeat = [3, 1]\nmap_size = [192, 64]\n\
         entries = 300\neffort = \"fast\"\nmaterials = [\"m\"]\nblend = \"exact\"\n",
    );
    let flags = "--size 96x80 --supersample 2 --background 101820 --camera 30,20,1.05 --ambient ffffff*0.2 \
                 --light -30,50,ffddaa*1.1 --material 0,80a0c0,ffffff*0.3,25 --height hill.png --depth 0.1 --repeat 3,1 \
                 --map-size 192x64 -n 300 --effort fast --blend exact";
    room.run("render s.toml -o scene.png").ok();
    room.run(&format!("render torus:24x12 {flags} -o flags.png")).ok();
    assert!(room.read("scene.png") == room.read("flags.png"));
    // And with nothing said, they have the same defaults.
    write(&room, "empty.toml", "[[objects]]");
    room.run("render empty.toml --method exact --size 40 -o scene.png").ok();
    room.run("render sphere --method exact --size 40 -o flags.png").ok();
    assert!(room.read("scene.png") == room.read("flags.png"));
}

#[test]
fn objects_stand_where_they_are_put_and_hide_each_other() {
    let room = Room::new();
    let ball = |color: &str, x: f32, z: f32| {
        let material = format!("materials = [{{ layers = [{{ model = \"ambient\", color = \"{color}\" }}] }}]");
        format!("[[objects]]\nposition = [{x}, 0, {z}]\n{material}\n")
    };
    let head = "lights = []\n[environment]\nambient = \"ffffff\"\n[picture]\nsize = [90, 60]\nmethod = \"exact\"\n\
                [camera]\neye = [0, 0, 12]\ntarget = [0, 0, 0]\n";
    let seen = |objects: &[String]| {
        write(&room, "s.toml", &format!("{head}{}", objects.concat()));
        room.run("render s.toml -o s.png").ok();
        let seen = picture(&room, "s.png");
        [15, 45, 75].map(|x| seen[(x, 30)].rgb())
    };
    let (red, green, blue) = ([255, 0, 0], [0, 255, 0], [0, 0, 255]);
    let row = [ball("ff0000", -3.2, 0.0), ball("00ff00", 0.0, 0.0), ball("0000ff", 3.2, 0.0)];
    assert_eq!(seen(&row), [red, green, blue]);
    // What is nearer hides what is behind it, in either order.
    for (near, far) in [(1.5, -1.5), (-1.5, 1.5)] {
        let hidden = [ball("ff0000", 0.0, near), ball("00ff00", 0.0, far)];
        assert_eq!(seen(&hidden)[1], if near > far { red } else { green });
    }
}

#[test]
fn every_model_can_be_a_layer() {
    let room = Room::new();
    let mut seen = Vec::new();
    for layer in [
        "model = \"ambient\", color = \"ff8040\"",
        "model = \"lambert\"",
        "model = \"steps\", steps = 3",
        "model = \"cartoon\", bands = [[0, \"201008\"], [0.4, \"c08060\"]]",
        "model = \"phong\", shininess = 20",
        "model = \"blinn-phong\", color = \"ffffff\"",
        "model = \"doubled-angle\", color = \"ffffff\"",
        "model = \"chrome\", zenith = \"002060\"",
        "model = \"environment\", roughness = 0.2, weight = 0.5",
        "model = \"metallic-roughness\", metallic = 1, roughness = 0.3",
    ] {
        write(&room, "s.toml", &format!("[[objects]]\nmaterials = [{{ layers = [{{ {layer} }}] }}]"));
        room.run("render s.toml --method exact --size 32 -o s.png").ok();
        let picture = room.read("s.png");
        assert!(!seen.contains(&picture), "{layer} looks like another");
        seen.push(picture);
    }
}

#[test]
fn the_command_line_has_its_way_with_the_picture_only() {
    let room = Room::new();
    write(
        &room,
        "s.toml",
        "[picture]\nsize = [40, 30]\noutput = \"mine.png\"\nframes = 2\n[[objects]]\nmap_size = [64, 32]\n",
    );
    let report = room.run("render s.toml --json").ok().json();
    assert_eq!((report["output"].as_str(), report["method"].as_str()), (Some("mine.png"), Some("table")));
    assert_eq!(report["frames"], 2);
    let said = room.run("render s.toml --method quadratic --size 24x20 -o other.png --frames 1 --json").ok();
    assert!(!said.stderr.contains("warning"), "{}", said.stderr);
    assert_eq!((said.json()["method"].as_str(), said.json()["frames"].as_u64()), (Some("quadratic"), Some(1)));
    assert_eq!(picture(&room, "other.png").size(), (24, 20));
    let said = room.run("render s.toml --depth 1 --light 3,4 -n 9 --frames 1 -o other.png");
    said.warns(&["warning: --depth: not used: s.toml says", "warning: --light: not used", "warning: -n: not used"]);
}

#[test]
fn keys_that_play_no_part_are_told_by_their_line() {
    let room = Room::new();
    write(
        &room,
        "s.toml",
        "[picture]\nmethod = \"exact\"\nsize = [16, 16]\norder = \"linear\"\ndelay = 3\n[environment]\nturn = 4\n\
         [[objects]]\nentries = 9\ndepth = 1\nspace = \"object\"\nmaterials = [{}, {}]\n",
    );
    room.run("render s.toml -o s.png").warns(&[
        "s.toml:4: `order`: not used",
        "s.toml:5: `delay`: not used",
        "s.toml:7: `turn`: not used",
        "s.toml:9: `entries`: not used",
        "s.toml:10: `depth`: not used",
        "s.toml:11: `space`: not used",
        "s.toml:12: `materials`: there is no material 1",
    ]);
}

#[test]
fn errors_name_file_line_and_key_and_leave_nothing() {
    let room = Room::new();
    room.bump_normals("n.png");
    for (scene, code, words) in [
        ("[[objects]]\nscael = 2", 4, &["s.toml:2: `scael` is not a key of [[objects]]"][..]),
        ("[[objects]]\nscale = 0", 4, &["s.toml:2: `scale` is 0; it must be a number from"]),
        ("[[objects]]\nscale = ", 4, &["s.toml:2: "]),
        ("[picture]\nmethod = \"magic\"\n[[objects]]", 4, &["s.toml:2: `method` is 'magic'", "quadratic"]),
        ("[[objects]]\n\nheight = \"gone.png\"", 3, &["s.toml:3: `height`", "gone.png"]),
        ("[[objects]]\nmesh = \"gone.obj\"", 3, &["s.toml:2: `mesh`", "gone.obj"]),
        ("[environment]\nfile = \"gone.hdr\"\n[[objects]]", 3, &["s.toml:2: `file`", "gone.hdr"]),
        ("[[objects]]\nheight = \"n.png\"\nnormals = \"n.png\"", 4, &["s.toml:3: `normals` and `height`"]),
        (
            "[[objects]]\n[[objects]]\nnormals = \"n.png\"\nspace = \"object\"",
            2,
            &["s.toml:2: sphere", "tangent-space"],
        ),
        ("[[objects]]\n[[objects]]\nindexed = \"n.png\"", 4, &["s.toml:2: sphere", "n.png"]),
        ("[picture]\nsize = [9000, 9000]\nsamples = 2\n[[objects]]", 2, &["18000 x 18000", "16384"]),
        ("[picture]\noutput = \"n.png\"\n[[objects]]\nnormals = \"n.png\"", 2, &["n.png", "replaced"]),
        ("[camera]\neye = [0, 0, 0]\n[[objects]]", 2, &["s.toml: camera", "eye"]),
        ("", 4, &["s.toml:1: `objects` is missing"]),
    ] {
        write(&room, "s.toml", scene);
        let method = if scene.contains("space") { "--method linear" } else { "" };
        room.run(&format!("render s.toml {method}")).fails(code, words);
    }
    room.write("s.toml", b"\xff\xfe");
    room.run("render s.toml").fails(4, &["s.toml", "UTF-8"]);
    room.run("render gone.toml").fails(3, &["gone.toml"]);
    assert_eq!(room.files(), ["n.png", "s.toml"]);
}

#[test]
fn paths_are_relative_to_the_scene() {
    let room = Room::new();
    std::fs::create_dir(room.path("deep")).unwrap();
    room.bump("deep/hill.png");
    let scene =
        "[picture]\nsize = [24, 24]\noutput = \"out.png\"\n[[objects]]\nheight = \"hill.png\"\nmap_size = [64, 32]\n";
    write(&room, "deep/s.toml", scene);
    room.run("render deep/s.toml").ok();
    assert!(room.path("deep/out.png").exists());
}
