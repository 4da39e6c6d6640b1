use crate::runner::Room;

const COMMANDS: [&str; 8] = ["normal", "quantize", "relight", "render", "compare", "demo", "reproduce", "completions"];

#[test]
fn every_command_has_help_with_examples() {
    let room = Room::new();
    for command in COMMANDS {
        let help = String::from_utf8(room.run(&format!("{command} --help")).ok().stdout).unwrap();
        assert!(help.contains("Examples:") && help.contains(&format!("rilievo {command}")), "{command}: {help}");
    }
    let help = String::from_utf8(room.run("--help").ok().stdout).unwrap();
    assert!(COMMANDS.iter().all(|c| help.contains(c)) && help.contains("Exit codes"));
    assert!(String::from_utf8(room.run("--version").ok().stdout).unwrap().starts_with("rilievo "));
}

#[test]
fn wrong_usage_is_code_2_and_leaves_nothing() {
    let room = Room::new();
    for args in [
        "",
        "nonsense",
        "normal",
        "normal a.png --edges sideways",
        "quantize a.png -n 70000",
        "relight a.png --light 1",
        "render sphere:9 --method exact",
        "render vase --size 0x4",
        "render sphere --camera 0,91 --method exact",
        "compare a.png",
        "compare a.png b.png --min-psnr nan",
        "compare - -",
        "render vase --repeat 2 --size 16",
        "render cube --method exact --size 60000 --supersample 8",
        "render cube --method exact --size 8192 --frames 10000",
        "render vase:3x4",
        "normal a.png --threads 1000000",
    ] {
        assert_eq!(room.run(args).code, 2, "{args}");
    }
    assert!(room.files().is_empty());
}

#[test]
fn completions_for_every_shell() {
    let room = Room::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = room.run(&format!("completions {shell}")).ok().stdout;
        assert!(script.len() > 1000, "{shell}");
    }
}

#[test]
fn outputs_never_replace_inputs_or_each_other() {
    let room = Room::new();
    room.bump("a.png");
    let before = room.read("a.png");
    room.run("normal a.png -o a.png").fails(2, &["a.png", "replaced"]);
    room.run("normal a.png -o ./a.png").fails(2, &["replaced"]);
    room.run("render sphere --height a.png --size 16 -o a.png").fails(2, &["replaced"]);
    assert_eq!(room.read("a.png"), before);
    for folder in ["x", "y", "out"] {
        std::fs::create_dir(room.path(folder)).unwrap();
    }
    room.bump("x/h.png");
    room.bump("y/h.png");
    room.run("normal x/h.png y/h.png -o out").fails(2, &["x/h.png", "y/h.png"]);
    room.run("normal x/h.png y/h.png").ok();
    assert_eq!(std::fs::read_dir(room.path("out")).unwrap().count(), 0);
}

#[test]
fn extensions_say_what_is_written() {
    let room = Room::new();
    room.bump("h.png");
    room.bump_normals("n.png");
    room.run("quantize n.png -n 16 -o q.png").ok();
    for args in [
        "normal h.png -o n.jpg",
        "normal h.png -o n",
        "relight q.png -o lit.ktx2",
        "render cube --method exact -o c.jpg",
    ] {
        room.run(args).fails(2, &["write to a .png"]);
    }
}

#[test]
fn flags_that_play_no_part_are_told() {
    let room = Room::new();
    room.bump("h.png");
    room.bump_normals("n.png");
    room.run("quantize n.png -n 16 -o q.png").ok();
    let warned = |args: &str, flag: &str| {
        let said = room.run(args).ok();
        assert!(said.stderr.contains(&format!("warning: {flag}: not used")), "{args}: {}", said.stderr);
    };
    warned("normal h.png --gutter 3", "--gutter");
    warned("normal h.png -o n.exr --bits 8", "--bits");
    warned("relight q.png --delay 9", "--delay");
    warned("render cube --method exact --size 16 -n 9 -o c.png", "-n");
    warned("render plane --indexed q.png --size 16 --depth 1 -o c.png", "--depth");
    warned("render cube --method exact --size 16 --turn light -o c.png", "--turn");
    warned("compare q.png q.png --as picture --convention dx", "--convention");
    // And where they play a part, nothing is said.
    let said = room.run("render sphere --height h.png --depth 0.1 --size 16 --map-size 64x32 -n 9 -o c.png").ok();
    assert!(!said.stderr.contains("warning"), "{}", said.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_stderr_does_not_stop_the_work() {
    let room = Room::new();
    room.bump("h.png");
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_rilievo"))
        .args(["normal", "h.png", "--gutter", "3"])
        .current_dir(room.path("."))
        .stderr(std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert_eq!(room.files(), ["h.png", "h_normal_gl.png"]);
}
