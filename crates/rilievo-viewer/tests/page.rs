//! The page in a real browser: by WebGPU, by WebGL2, and by the CPU; lit, turned, switched, given a file.
//!
//! It takes a built page: `cargo xtask web --test` builds it and runs these.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "tests fail loudly")]

use std::path::Path;
use std::time::Instant;

use rilievo::Grid;
use rilievo::color::Picture;
use testkit::browser::{Browser, Server};
use testkit::eye::Part;

fn seen(browser: &mut Browser) -> Picture {
    let source = rilievo_io::Source::from_bytes("screenshot", browser.screenshot());
    rilievo_io::decode_picture(&source, &rilievo_io::Limits::default()).unwrap()
}

/// The picture, left of the panel.
fn stage(picture: &Picture) -> Part {
    Part { across: 20..picture.width() - 320, down: 40..picture.height() - 60 }
}

/// Pixels of clay there.
fn warm(picture: &Picture) -> usize {
    stage(picture).warm(picture).len()
}

/// Pixels there that differ.
fn changed(a: &Picture, b: &Picture) -> usize {
    stage(a).changed(a, b)
}

/// Waits until something is to be seen; gives the picture once it is still.
#[track_caller]
fn wait_for(browser: &mut Browser, what: &str, is_there: impl Fn(&Picture) -> bool) -> Picture {
    let start = Instant::now();
    let mut last = seen(browser);
    loop {
        std::thread::sleep(std::time::Duration::from_millis(400));
        let now = seen(browser);
        if now == last && is_there(&now) && !words(browser).contains("refining") {
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

/// Round hills, as a gray PNG of 16 bits.
fn hills(side: u32) -> Vec<u8> {
    let wave = |v: u32| (v as f32 / side as f32 * 25.0).sin();
    let heights = Grid::from_fn(side, side, |x, y| 0.5 + 0.25 * (wave(x) + wave(y))).unwrap();
    rilievo_io::encode_gray_png16(&heights).unwrap()
}

/// How a page of this kind tells what it shows.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Viewer,
    Plain,
}

/// What the page says in words.
fn words(browser: &mut Browser) -> String {
    let all = "['state', 'told', 'message'].map((id) => document.getElementById(id)?.textContent ?? '').join(' ')";
    browser.eval(all).as_str().unwrap().to_owned()
}

/// Waits for words.
#[track_caller]
fn wait_for_words(browser: &mut Browser, sought: &str) -> String {
    let start = Instant::now();
    loop {
        let words = words(browser);
        if words.contains(sought) {
            return words;
        }
        assert!(start.elapsed().as_secs() < 60, "no {sought:?} in {words:?}; {:?}", browser.complaints);
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}

/// The light comes from the right after a drag to the right: the vase is brighter there.
fn side_of_light(picture: &Picture) -> f64 {
    let (mut left, mut right) = (0.0, 0.0);
    let middle = (picture.width() - 300) / 2;
    for y in 200..picture.height() - 200 {
        for x in 20..picture.width() - 320 {
            let light = f64::from(picture[(x, y)].r);
            if x < middle { left += light } else { right += light }
        }
    }
    right / left
}

/// Used as a hand uses it; `wish` is the page's query.
fn uses(mut browser: Browser, kind: Kind, wish: &str, name: &str) {
    let server = Server::start();
    browser.go_to(&format!("{}{wish}", server.address()));
    let first = wait_for(&mut browser, "the vase", |p| warm(p) > 5_000);
    keep(&first, name);

    browser.drag("right", [200.0, 400.0], [300.0, 400.0]);
    let relit = wait_for(&mut browser, "the vase in another light", |p| warm(p) > 2_000 && changed(p, &first) > 5_000);
    keep(&relit, &format!("{name}-relit"));
    assert!(changed(&first, &relit) > 5_000, "{name}: the light moves {} pixels", changed(&first, &relit));
    let sides = [&first, &relit].map(side_of_light);
    assert!(sides[1] > sides[0] * 1.05, "{name}: the light goes to the right: {sides:?}");

    browser.drag("left", [200.0, 400.0], [280.0, 410.0]);
    let turned =
        wait_for(&mut browser, "the vase from another side", |p| warm(p) > 2_000 && changed(p, &relit) > 5_000);
    assert!(changed(&relit, &turned) > 5_000, "{name}: the object turns");

    // Exact instead of by table: almost the same picture, and the words say which.
    match kind {
        Kind::Viewer => browser.key("2"),
        Kind::Plain => drop(browser.eval(
            "(() => { const w = document.getElementById('way'); w.value = 'Exact'; \
             w.dispatchEvent(new Event('change')); return w.value })()",
        )),
    }
    let said = wait_for_words(&mut browser, if kind == Kind::Viewer { "Exact" } else { "drawn by the CPU" });
    let exact = wait_for(&mut browser, "the vase, exact", |p| warm(p) > 2_000 && *p != turned);
    keep(&exact, &format!("{name}-exact"));
    let off = [0, 2].map(|least: u8| {
        let codes = turned.texels().iter().zip(exact.texels()).map(|(a, b)| a.r.abs_diff(b.r));
        codes.filter(|&d| d > least).count()
    });
    assert!(off[0] > 200, "{name}: another method draws another picture: {off:?}; {said}");
    assert!(changed(&turned, &exact) < 40_000, "{name}: the same object: {}", changed(&turned, &exact));

    let bar = if kind == Kind::Viewer { "wait" } else { "work" };
    browser.eval(&format!(
        "globalThis.waited = false; globalThis.bar = document.getElementById('{bar}'); \
         new MutationObserver(() => waited ||= !bar.hidden).observe(bar, {{ attributes: true }})"
    ));
    browser.drop_file("hills.png", &hills(256));
    let hills = wait_for(&mut browser, "the hills", |p| warm(p) < 2_000 && changed(p, &turned) > 20_000);
    keep(&hills, &format!("{name}-hills"));
    assert_eq!(browser.eval("[waited, bar.hidden].join()"), "true,true", "{name}: a bar tells how far the work is");

    browser.drop_file("notes.txt", b"Not a map of anything, nor a mesh.");
    let said = wait_for_words(&mut browser, "notes.txt");
    assert!(said.contains("PNG") && said.contains("GLB"), "{name}: {said}");
    let after = wait_for(&mut browser, "the hills still", |p| warm(p) < 2_000);
    assert!(changed(&hills, &after) < 60_000, "{name}: what was there stays");

    honest(&browser, &server, name);
}

/// No request leaves the page's server, and nothing went wrong on the way.
fn honest(browser: &Browser, server: &Server, name: &str) {
    let ours = |r: &&String| [server.address(), "data:", "blob:"].iter().any(|scheme| r.starts_with(scheme));
    let foreign: Vec<&String> = browser.requests.iter().filter(|r| !ours(r)).collect();
    assert!(foreign.is_empty(), "{name}: requests leave the origin: {foreign:?}");
    assert!(browser.complaints.is_empty(), "{name}: {:?}", browser.complaints);
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_webgpu() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, Kind::Viewer, "", "webgpu");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_webgl2() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, Kind::Viewer, "?webgl", "webgl");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn by_the_cpu_in_the_viewer() {
    let Some(browser) = Browser::start_with_gpu() else { return };
    uses(browser, Kind::Viewer, "?cpu", "cpu");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn without_any_gpu() {
    let Some(browser) = Browser::start(&["--disable-3d-apis", "--disable-software-rasterizer"]) else { return };
    uses(browser, Kind::Plain, "", "plain");
}

/// What happens to a page whose GPU is taken away by a script: the CPU goes on with the same map.
fn loses(wish: &str, before: &str, lose: &str, name: &str) {
    let Some(mut browser) = Browser::start_with_gpu() else { return };
    let server = Server::start();
    browser.before(before);
    browser.go_to(&format!("{}{wish}", server.address()));
    wait_for(&mut browser, "the vase", |p| warm(p) > 5_000);
    browser.drop_file("hills.png", &hills(128));
    wait_for_words(&mut browser, "hills");
    let hills = wait_for(&mut browser, "the hills", |p| warm(p) < 2_000);
    browser.eval(lose);
    let said = wait_for_words(&mut browser, "drawn by the CPU");
    assert!(said.contains("was lost") && said.contains("CPU draws"), "{name}: {said}");
    let after = wait_for(&mut browser, "the hills, by the CPU", |p| changed(p, &hills) > 1_000 && warm(p) < 2_000);
    keep(&after, &format!("{name}-lost"));
    browser.drag("right", [300.0, 400.0], [420.0, 400.0]);
    let relit = wait_for(&mut browser, "the hills in another light", |p| changed(p, &after) > 5_000);
    keep(&relit, &format!("{name}-lost-relit"));
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn lost_device() {
    let spy = "globalThis.devices = []; const request = GPUAdapter.prototype.requestDevice; \
               GPUAdapter.prototype.requestDevice = async function (...wishes) { \
                 const device = await request.apply(this, wishes); devices.push(device); return device; };";
    loses("", spy, "devices.forEach((device) => device.destroy())", "device");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn lost_context() {
    let lose =
        "document.getElementById('viewer').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()";
    loses("?webgl", "", lose, "context");
}

#[test]
#[ignore = "needs the page: cargo xtask web --test"]
fn in_the_hand() {
    let Some(mut browser) = Browser::start_in_hand([390, 844]) else { return };
    let server = Server::start();
    browser.go_to(server.address());
    let first = wait_for(&mut browser, "the vase", |p| {
        Part { across: 0..p.width(), down: 0..p.height() / 2 }.warm(p).len() > 5_000
    });
    keep(&first, "hand");
    assert_eq!(first.size(), (780, 1688));
    browser.swipe([120.0, 200.0], [240.0, 220.0]);
    let off =
        |a: &Picture, b: &Picture| a.texels().iter().zip(b.texels()).filter(|(a, b)| a.r.abs_diff(b.r) > 6).count();
    let turned = wait_for(&mut browser, "the vase from another side", |p| off(p, &first) > 5_000);
    keep(&turned, "hand-turned");
    honest(&browser, &server, "hand");
}
