//! The window of `rilievo view`, on a real display.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rilievo::color::Picture;
use testkit::display::Display;
use testkit::eye::Part;

use crate::runner::Room;

/// Button that turns the object.
const LEFT: u8 = 1;
/// Button that moves the light.
const RIGHT: u8 = 3;
/// Where the picture is, left of the panel.
const STAGE: Part = Part { across: 40..860, down: 60..720 };

/// The window, closed with the test.
struct Window(Child);

impl Drop for Window {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn open(display: &Display, room: &Room, arguments: &str) -> Window {
    let child = Command::new(env!("CARGO_BIN_EXE_rilievo"))
        .arg("view")
        .args(arguments.split_whitespace())
        .current_dir(room.path("."))
        .env("DISPLAY", display.name())
        .env_remove("WAYLAND_DISPLAY")
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    Window(child)
}

fn is_drawn(picture: &Picture) -> bool {
    STAGE.warm(picture).len() > 40_000
}

fn brightness(picture: &Picture) -> f64 {
    let warm = STAGE.warm(picture);
    let sum: f64 = warm.iter().map(|&at| f64::from(picture[at].r)).sum();
    sum / warm.len().max(1) as f64
}

/// Pictures for the eye, in a folder that is named by the environment.
fn keep(picture: &Picture, name: &str) {
    let Some(folder) = std::env::var_os("RILIEVO_KEEP_PICTURES") else { return };
    let png = rilievo_io::encode_picture_png(picture).unwrap();
    std::fs::write(Path::new(&folder).join(name), png).unwrap();
}

/// Does something until more than so many pixels are others; gives the picture once it is still. A software GPU on a busy machine may take
/// as long for a frame as a hand for a short drag, which is then no drag.
#[track_caller]
fn until_changed(display: &Display, from: &Picture, least: usize, what: &str, act: impl Fn()) -> Picture {
    for _ in 0..6 {
        act();
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(4) {
            if STAGE.changed(from, &display.picture()) > least {
                return display.wait_until_still();
            }
            std::thread::sleep(Duration::from_millis(150));
        }
    }
    panic!("{what}: nothing happens");
}

/// Turned, lit, switched and compared, as a hand does it.
fn uses(extra: &str, name: &str) {
    let Some(display) = Display::start() else { return };
    let room = Room::new();
    let _window = open(&display, &room, &format!("--sample bricks -n 256 {extra}"));
    display.wait_for("the wall", is_drawn);
    let first = display.wait_until_still();
    keep(&first, &format!("{name}-first.png"));

    // Light from the left, drawn far to the right: what was dark is bright.
    let drag = || display.drag(RIGHT, (300, 400), (420, 400));
    let relit = until_changed(&display, &first, 20_000, "the light moves", drag);
    keep(&relit, &format!("{name}-relit.png"));
    assert!(STAGE.changed(&first, &relit) > 20_000, "{name}: the light moves {} pixels", STAGE.changed(&first, &relit));
    let outline = STAGE.warm(&first).len() as f64 / STAGE.warm(&relit).len() as f64;
    assert!((0.7..1.4).contains(&outline), "{name}: the object stays where it is, {outline}");

    let drag = || display.drag(LEFT, (300, 400), (380, 430));
    let turned = until_changed(&display, &relit, 20_000, "the object turns", drag);
    keep(&turned, &format!("{name}-turned.png"));
    assert!(STAGE.changed(&relit, &turned) > 20_000, "{name}: the object turns");

    // Key 2 is the exact method: nearly the same picture, and not the same.
    let exact = until_changed(&display, &turned, 100, "the method changes", || display.key(u32::from(b'2')));
    keep(&exact, &format!("{name}-exact.png"));
    let off = (brightness(&exact) - brightness(&turned)).abs();
    assert!(
        STAGE.changed(&turned, &exact) > 100 && off < 8.0,
        "{name}: {} pixels, {off}",
        STAGE.changed(&turned, &exact)
    );
}

#[test]
fn a_window_drawn_by_the_gpu() {
    uses("", "gpu");
}

#[test]
fn a_window_drawn_by_the_cpu() {
    uses("--cpu", "cpu");
}

#[test]
fn a_height_map_is_shown_and_a_bad_file_is_told() {
    let Some(display) = Display::start() else { return };
    let room = Room::new();
    room.bump_normals("n.png");
    let _window = open(&display, &room, "n.png -n 64 --on sphere --compare exact");
    // Gray as it is, it differs from the ground.
    let seen = display.wait_for("a sphere", |p| {
        let bright = |at| p[at].g > 90;
        (200..700).filter(|&x| bright((x, 380))).count() > 60
    });
    keep(&seen, "sphere.png");
    room.run("view missing.png").fails(3, &["missing.png"]);
    room.run("view n.png n.png").fails(2, &["one mesh and one map"]);
}

#[test]
fn without_a_display_there_is_a_message() {
    let room = Room::new();
    let output = Command::new(env!("CARGO_BIN_EXE_rilievo"))
        .arg("view")
        .current_dir(room.path("."))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{stderr}");
    assert!(stderr.contains("no window can be opened") && stderr.contains("rilievo render"), "{stderr}");
}
