use crate::runner::Room;

const COMMANDS: [&str; 7] = ["normal", "quantize", "relight", "render", "compare", "demo", "completions"];

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
