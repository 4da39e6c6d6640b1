//! The page of `relight --html`, in a real browser.

use rilievo::Rgba8;
use serde_json::Value;
use testkit::browser::Browser;

use crate::runner::Room;

/// Red, green and blue of all pixels of the picture that is shown.
const PIXELS: &str = "(async () => { const p = document.getElementById('picture'); await p.decode(); \
    const c = document.createElement('canvas'); c.width = p.naturalWidth; c.height = p.naturalHeight; \
    const x = c.getContext('2d'); x.drawImage(p, 0, 0); return Array.from(x.getImageData(0, 0, c.width, c.height).data); })()";

/// Whether the last wish is drawn: two frames without a change of the picture.
const SETTLED: &str = "(async () => { const p = document.getElementById('picture'), frame = () => new Promise(requestAnimationFrame); \
    const before = p.src; for (let i = 0; i < 6; i++) await frame(); await p.decode(); return p.src === before && !p.hidden; })()";

fn pixels(browser: &mut Browser) -> Vec<Rgba8> {
    browser.wait_until(SETTLED);
    let data: Vec<u8> = browser.eval(PIXELS).as_array().unwrap().iter().map(|v| v.as_u64().unwrap() as u8).collect();
    data.chunks_exact(4).map(|p| Rgba8::new(p[0], p[1], p[2], p[3])).collect()
}

/// The picture the program makes of the same.
fn expected(room: &Room, command: &str) -> Vec<Rgba8> {
    room.run(&format!("relight {command} -o expected.png")).ok();
    let limits = rilievo_io::Limits::default();
    let source = rilievo_io::Source::open(&room.path("expected.png"), &limits).unwrap();
    rilievo_io::decode_picture(&source, &limits).unwrap().texels().to_vec()
}

#[track_caller]
fn assert_alike(found: &[Rgba8], expected: &[Rgba8], most: u8) {
    assert_eq!(found.len(), expected.len());
    let apart = |(a, b): (&Rgba8, &Rgba8)| a.r.abs_diff(b.r).max(a.g.abs_diff(b.g)).max(a.b.abs_diff(b.b));
    let worst = found.iter().zip(expected).map(apart).max().unwrap();
    assert!(worst <= most, "{worst} codes apart");
}

/// The middle of the picture and half of its size, on the page.
fn stage(browser: &mut Browser) -> [[f64; 2]; 2] {
    let text = "(() => { const b = document.getElementById('stage').getBoundingClientRect(); \
        return [b.left + b.width / 2, b.top + b.height / 2, b.width / 2, b.height / 2]; })()";
    let box_: Vec<f64> = browser.eval(text).as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    [[box_[0], box_[1]], [box_[2], box_[3]]]
}

#[test]
fn the_page_is_lit_as_the_program_lights() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 64 -o map.png").ok();
    room.run("relight map.png --html -o page.html --light -45,40,ffddaa --light 100,20,8090ff*0.5 --quiet").ok();
    browser.open(&room.path("page.html"));
    let light = "--light 100,20,8090ff*0.5";
    let shown = pixels(&mut browser);
    assert_alike(&shown, &expected(&room, &format!("map.png --light -45,40,ffddaa {light}")), 1);

    // Dragged to the right, half way to the rim: 30° around, level.
    let [[x, y], [w, _]] = stage(&mut browser);
    browser.mouse("mousePressed", [x, y]);
    browser.mouse("mouseMoved", [x + 0.5 * w, y]);
    browser.mouse("mouseReleased", [x + 0.5 * w, y]);
    let dragged = pixels(&mut browser);
    assert_alike(&dragged, &expected(&room, &format!("map.png --light 30,0,ffddaa {light}")), 3);
    assert_ne!(shown, dragged);
    let told = browser.eval("document.getElementById('stage').getAttribute('aria-valuetext')");
    assert_eq!(told, Value::from("azimuth 30°, elevation 0°"));

    // Keys move it too.
    browser.eval("document.getElementById('stage').focus()");
    browser.key("ArrowUp");
    browser.key("ArrowLeft");
    let moved = pixels(&mut browser);
    assert_alike(&moved, &expected(&room, &format!("map.png --light 27,3,ffddaa {light}")), 3);

    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
    let outside: Vec<_> =
        browser.requests.iter().filter(|url| !url.starts_with("file:") && !url.starts_with("blob:")).collect();
    assert!(outside.is_empty(), "{outside:?}");
}

#[test]
fn any_map_becomes_a_page_and_any_other_map_can_be_dropped_on_it() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let room = Room::new();
    room.bump_normals("n.png");
    // Two materials, more entries than a palette has, and a file that is no index map.
    let mask = rilievo::Grid::from_fn(64, 48, |x, _| u8::from(x > 31)).unwrap();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 64, 48);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(mask.texels()).unwrap();
    room.write("mask.png", &bytes);
    room.run("quantize n.png -n 1000 --materials mask.png -o large.ktx2").ok();
    let finish = "--material 0,d08050 --material 1,181818,ffffff*0.5,90";
    room.run(&format!("relight large.ktx2 --html -o page.html {finish}")).ok();
    browser.open(&room.path("page.html"));
    let shown = pixels(&mut browser);
    // Fewer normals, dithered: alike on average.
    let whole = expected(&room, &format!("large.ktx2 {finish}"));
    let mean = |p: &[Rgba8]| p.iter().map(|p| f64::from(p.r)).sum::<f64>() / p.len() as f64;
    assert!((mean(&shown) - mean(&whole)).abs() < 1.0, "{} {}", mean(&shown), mean(&whole));
    room.run("relight n.png --html -o normals.html").ok();
    browser.open(&room.path("normals.html"));
    let plain = pixels(&mut browser);
    assert!((mean(&plain) - mean(&expected(&room, "large.ktx2"))).abs() < 1.0);

    // Dropped: another map is shown, what is none is told.
    room.run("quantize n.png -n 8 -o few.png").ok();
    let drop = |bytes: &[u8], name: &str| {
        format!(
            "(() => {{ const d = new DataTransfer(); d.items.add(new File([new Uint8Array({bytes:?})], '{name}')); \
             dispatchEvent(new DragEvent('drop', {{ dataTransfer: d }})); }})()"
        )
    };
    browser.eval(&drop(&room.read("few.png"), "few.png"));
    browser.wait_until("document.getElementById('say').textContent.includes('8 normals')");
    let title = browser.eval("document.title");
    assert_eq!(title, Value::from("few.png"));
    for (bytes, name, told) in [
        (&b"GIF89a"[..], "a.gif", "not a PNG"),
        (&room.read("n.png")[..], "n.png", "no palette"),
        (&room.read("few.png")[..60], "cut.png", "ends too early"),
    ] {
        browser.eval(&drop(bytes, name));
        browser.wait_until(&format!("document.getElementById('say').textContent.includes('{told}')"));
        // What was there stays.
        assert_eq!(browser.eval("document.title"), Value::from("few.png"));
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn what_a_palette_cannot_do_is_refused() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 16 -o map.png").ok();
    room.run("relight map.png --html --frames 4").fails(2, &["--frames", "--html"]);
    room.run("relight map.png --html --color n.png").fails(2, &["--color", "--html"]);
    room.run("relight map.png --html --model chrome").fails(2, &["--html", "Blinn-Phong"]);
    room.run("relight map.png --html -o page.png").fails(2, &["page.png", ".html"]);
    room.run("relight map.png --html").ok();
    assert!(room.files().contains(&"map_relight.html".to_owned()), "{:?}", room.files());
}
