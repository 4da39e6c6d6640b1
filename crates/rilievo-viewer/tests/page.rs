//! The page in a real browser: by WebGPU, by WebGL2, and by the CPU; lit, turned, switched, given a file.
//!
//! It takes a built page: `cargo xtask web --test` builds it and runs these.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "tests fail loudly")]

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use rilievo::color::Picture;
use rilievo::{Grid, Rgba8};
use testkit::browser::Browser;

/// Where the developer's command puts the page, and the program that serves it.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/web/page");
const SERVER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/web/serve");

/// The page, served to this machine.
struct Server {
    child: Child,
    address: String,
}

impl Server {
    fn start() -> Self {
        assert!(Path::new(PAGE).join("index.html").is_file(), "no page: `cargo xtask web --build` makes it");
        let mut child = Command::new(SERVER)
            .args(["--only-serve", PAGE])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server of `cargo xtask web --build`");
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        Self { child, address: address.trim().to_owned() }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn seen(browser: &mut Browser) -> Picture {
    let source = rilievo_io::Source::from_bytes("screenshot", browser.screenshot());
    rilievo_io::decode_picture(&source, &rilievo_io::Limits::default()).unwrap()
}

/// Pixels of clay, left of the panel.
fn warm(picture: &Picture) -> usize {
    let at = (40..picture.height() - 60).flat_map(|y| (20..picture.width() - 320).map(move |x| (x, y)));
    at.filter(|&at| i32::from(picture[at].r) > i32::from(picture[at].b) + 24).count()
}

/// Pixels there that differ by more than rounding.
fn changed(a: &Picture, b: &Picture) -> usize {
    let off = |a: Rgba8, b: Rgba8| a.rgb().iter().zip(b.rgb()).any(|(&a, b)| a.abs_diff(b) > 6);
    let at = (40..a.height() - 60).flat_map(|y| (20..a.width() - 320).map(move |x| (x, y)));
    at.filter(|&at| off(a[at], b[at])).count()
}

/// Waits until something is to be seen; gives the picture once it is still.
#[track_caller]
fn wait_for(browser: &mut Browser, what: &str, is_there: impl Fn(&Picture) -> bool) -> Picture {
    let start = Instant::now();
    let mut last = seen(browser);
    loop {
        std::thread::sleep(std::time::Duration::from_millis(400));
        let now = seen(browser);
        if now == last && is_there(&now) {
            return now;
        }
        last = now;
        let told = browser.eval("document.getElementById('message').textContent");
        assert!(start.elapsed().as_secs() < 60, "{what} does not show: {told} {:?}", browser.complaints);
    }
}

fn keep(picture: &Picture, name: &str) {
    let Some(folder) = std::env::var_os("RILIEVO_KEEP_PICTURES") else { return };
    let png = rilievo_io::encode_picture_png(picture).unwrap();
    std::fs::write(Path::new(&folder).join(format!("page-{name}.png")), png).unwrap();
}

/// Drops a file on what is in the middle of the page.
fn drop_file(browser: &mut Browser, name: &str, bytes: &[u8]) {
    let list: Vec<String> = bytes.iter().map(u8::to_string).collect();
    let script = format!(
        "(() => {{ const t = new DataTransfer(); t.items.add(new File([new Uint8Array([{}])], {name:?})); \
         const e = document.querySelector('canvas'); \
         e.dispatchEvent(new DragEvent('drop', {{ dataTransfer: t, bubbles: true, cancelable: true }})); }})()",
        list.join(",")
    );
    browser.eval(&script);
}

/// Round hills, as a gray PNG of 16 bits.
fn hills(side: u32) -> Vec<u8> {
    let wave = |v: u32| (v as f32 / side as f32 * 25.0).sin();
    let heights = Grid::from_fn(side, side, |x, y| 0.5 + 0.25 * (wave(x) + wave(y))).unwrap();
    rilievo_io::encode_gray_png16(&heights).unwrap()
}

/// Used as a hand uses it; `wish` is the page's query.
fn uses(mut browser: Browser, wish: &str, name: &str) {
    let server = Server::start();
    browser.go_to(&format!("{}{wish}", server.address));
    let first = wait_for(&mut browser, "the vase", |p| warm(p) > 5_000);
    keep(&first, name);

    browser.drag("right", [200.0, 400.0], [300.0, 400.0]);
    let relit = wait_for(&mut browser, "the vase in another light", |p| warm(p) > 2_000);
    keep(&relit, &format!("{name}-relit"));
    assert!(changed(&first, &relit) > 5_000, "{name}: the light moves {} pixels", changed(&first, &relit));

    browser.drag("left", [200.0, 400.0], [280.0, 410.0]);
    let turned = wait_for(&mut browser, "the vase from another side", |p| warm(p) > 2_000);
    assert!(changed(&relit, &turned) > 5_000, "{name}: the object turns");

    drop_file(&mut browser, "hills.png", &hills(256));
    let hills = wait_for(&mut browser, "the hills", |p| warm(p) < 2_000 && changed(p, &turned) > 20_000);
    keep(&hills, &format!("{name}-hills"));

    let foreign: Vec<&String> = browser
        .requests
        .iter()
        .filter(|r| !r.starts_with(&server.address) && !r.starts_with("data:") && !r.starts_with("blob:"))
        .collect();
    assert!(foreign.is_empty(), "{name}: requests leave the origin: {foreign:?}");
    assert!(browser.complaints.is_empty(), "{name}: {:?}", browser.complaints);
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_webgpu() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, "", "webgpu");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_webgl2() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, "?webgl", "webgl");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_the_cpu_in_the_viewer() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, "?cpu", "cpu");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn without_any_gpu() {
    let Some(browser) = Browser::start(&["--disable-3d-apis", "--disable-software-rasterizer"]) else { return };
    uses(browser, "", "plain");
}
