//! The viewer in a browser, on this machine's processor in all of its modes: the browser's GPU is SwiftShader.

use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use testkit::browser::{Browser, Server};

use crate::inputs::rough;
use crate::report::{Case, Report, Unit};

/// Seconds from the call of the page to the first lit frame.
const LOADED: f64 = 3.0;
/// Seconds from the drop of a height map of [`SIDE`]² to its surface.
const RELIT: f64 = 5.0;
const SIDE: u32 = 2048;
/// Seconds without an answer, or without a frame, in which a page may be called responsive.
const RESPONSIVE: f64 = 0.25;

/// Notes when the page says what, when it makes a frame, and when it hears nothing for more than 50 ms.
const SPY: &str = "globalThis.said = []; globalThis.frames = []; globalThis.tasks = []; \
    new PerformanceObserver((list) => tasks.push(...list.getEntries())).observe({ type: 'longtask' }); \
    addEventListener('DOMContentLoaded', () => { \
      const words = () => ['state', 'told'].map((id) => document.getElementById(id)?.textContent ?? '').join(' '); \
      const note = () => said.push([performance.now(), words()]); \
      new MutationObserver(note).observe(document.body, { subtree: true, childList: true, characterData: true }); \
      const frame = (now) => { frames.push(now); requestAnimationFrame(frame); }; requestAnimationFrame(frame); });";

/// A way to see the page.
struct Mode {
    name: &'static str,
    query: &'static str,
    /// Whether the browser has something like a GPU.
    gpu: bool,
}

const MODES: [Mode; 4] = [
    Mode { name: "webgpu", query: "", gpu: true },
    Mode { name: "webgl", query: "?webgl", gpu: true },
    Mode { name: "cpu", query: "?cpu", gpu: true },
    Mode { name: "plain", query: "", gpu: false },
];

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let map = rilievo_io::encode_gray_png16(&rough(SIDE)?)?;
    let server = Server::start();
    for mode in MODES {
        let (mut loads, mut drops, mut stops, mut tasks) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut last = None;
        for _ in 0..rounds.min(5) {
            // One at a time.
            drop(last.take());
            let Some(mut browser) = start(&mode) else {
                report.remark("page: there is no chromium; left out");
                return Ok(());
            };
            browser.before(SPY);
            browser.go_to(&format!("{}{}", server.address(), mode.query));
            loads.push(wait(&mut browser, &mode, 0.0, "")?);
            browser.take_in_hand("relief.png", &map);
            sleep(Duration::from_secs(1));
            let start = browser.let_go();
            let end = wait(&mut browser, &mode, start, "relief")?;
            drops.push(end - start / 1e3);
            let longest = browser.eval(&format!(
                "frames.filter((t) => t > {start} && t < {end}).reduce(([g, l], t) => [Math.max(g, t - l), t], [0, {start}])[0]",
                end = end * 1e3
            ));
            stops.push(longest.as_f64().context("frames")? / 1e3);
            let longest = browser
                .eval(&format!("Math.max(0, ...tasks.filter((t) => t.startTime > {start}).map((t) => t.duration))"));
            tasks.push(longest.as_f64().context("tasks")? / 1e3);
            last = Some(browser);
        }
        let Some(mut browser) = last else { continue };
        add(report, &mode, "load", loads, LOADED, "to the first lit frame")?;
        add(report, &mode, "drop", drops, RELIT, "a height map of 2048 × 2048 to its surface")?;
        add(report, &mode, "task", tasks, RESPONSIVE, "the longest time in which the page hears nothing meanwhile")?;
        add(report, &mode, "stop", stops, RESPONSIVE, "the longest time without a frame meanwhile")?;
        frames(&mut browser, &mode, report)?;
    }
    Ok(())
}

fn start(mode: &Mode) -> Option<Browser> {
    if mode.gpu {
        Browser::start_with_gpu()
    } else {
        Browser::start(&["--disable-3d-apis", "--disable-software-rasterizer"])
    }
}

/// Adds the median of some seconds.
fn add(report: &mut Report, mode: &Mode, what: &str, mut seconds: Vec<f64>, limit: f64, note: &str) -> Result<()> {
    seconds.sort_by(f64::total_cmp);
    let (name, ours) = (format!("page/{}-{what}", mode.name), seconds[seconds.len() / 2]);
    let note = format!("{note}; peer is the limit");
    report.add(&Case { target: Some(1.0), note, ..Case::new(name, Unit::Seconds, ours, Some(limit)) })
}

/// Waits until the page, after so many milliseconds of its life, has drawn something by this name; gives seconds of its life.
fn wait(browser: &mut Browser, mode: &Mode, after: f64, name: &str) -> Result<f64> {
    // The plain page names the stages of its work, and then what it has drawn.
    let drawn = if mode.gpu {
        format!("later.find(([, w]) => w.includes('entries') && w.includes({name:?}))")
    } else {
        "later.slice(later.findIndex(([, w]) => w.includes('normals'))).find(([, w]) => w.includes('drawn by'))"
            .to_owned()
    };
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(60) {
        let found = browser.eval(&format!(
            "(() => {{ const later = said.filter(([t]) => t > {after}); \
             return later.some(([, w]) => w.includes('normals') || w.includes('entries')) ? {drawn} : undefined; }})()"
        ));
        if let Some(time) = found[0].as_f64() {
            return Ok(time / 1e3);
        }
        sleep(Duration::from_millis(20));
    }
    bail!("the page says: {:?}; {:?}", browser.eval("said.at(-1)"), browser.complaints)
}

/// Lets the light go round, drawn by the GPU and then by the CPU, and tells what the page tells.
fn frames(browser: &mut Browser, mode: &Mode, report: &mut Report) -> Result<()> {
    if mode.gpu {
        browser.drag("left", [200.0, 400.0], [204.0, 400.0]);
        browser.key(" ");
        sleep(Duration::from_secs(4));
        browser.key("c");
        sleep(Duration::from_secs(4));
        browser.key("c");
        sleep(Duration::from_secs(1));
    } else {
        for step in 0..10 {
            browser.drag("right", [200.0, 400.0], [210.0 + f64::from(step), 400.0]);
        }
    }
    let words = browser.eval("said.at(-1)[1]");
    report.remark(&format!("page/{}: {}", mode.name, words.as_str().context("words")?.trim()));
    Ok(())
}
