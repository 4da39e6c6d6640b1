//! The renderer against other software renderers: the same torus, maps, shaders and pictures.
//!
//! Peers are software GPUs (lavapipe, the CPU driver of Mesa; SwiftShader, the one of Chromium) through wgpu, and euc, a
//! rasteriser in Rust. Figures are processor seconds of a frame of 1024 × 1024, all threads of the process that draws,
//! the mean over three views. A frame clears, draws and leaves finished 8-bit colours in memory; nothing is read back. A
//! peer's maps and tables are in its memory beforehand, ours lights its table in every frame.
//!
//! wgpu keeps its own checks of array bounds in the shaders where a driver has none; both drivers here have.

mod child;
mod drivers;
mod euc;
mod ours;
mod pictures;
mod renderer;
mod scene;
mod threads;
#[cfg(feature = "gpu")]
mod vulkan;

pub(crate) use child::{Role, serve};

use crate::harness::turns;
use crate::report::{Case, Report, Unit};
use anyhow::{Context, Result};
use child::Child;
use drivers::{DRIVERS, Driver};
use ours::Ours;
use pictures::Difference;
use renderer::{Job, Renderer, Sampling, Shading};
use scene::{Size, VIEW_COUNT};
use serde_json::json;
use std::path::Path;

/// Names a second build of this program, compiled for the machine it runs on: `cargo xtask bench raster --native`.
const NATIVE: &str = "RILIEVO_BENCH_NATIVE";
/// Least ratio of a lit frame's time to that of one that is mostly dark: dark ones may take 1.05 times as long.
const DARK: f64 = 0.952;
/// Least ratio of normalised vectors' time to quadratic ones': those may take 1.03 times as long.
const NORMALIZED: f64 = 0.971;

/// Somebody who draws.
struct Player {
    name: &'static str,
    renderer: Box<dyn Renderer>,
}

/// Whom we are held against, drawing what.
struct Rival {
    name: &'static str,
    job: Job,
    /// Least ratio of its time to ours.
    target: Option<f64>,
}

/// One way of ours, and all who draw the same.
struct Contest {
    name: String,
    ours: Job,
    rivals: Vec<Rival>,
}

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let mut players = players(report)?;
    for size in Size::ALL {
        coverage(&mut players, size, report)?;
    }
    for contest in contests() {
        hold(&contest, &mut players, rounds, report)?;
    }
    dark(&mut players, rounds, report)?;
    threads::run(rounds, report)?;
    let folder = Path::new(pictures::FOLDER);
    report.remark(&format!("pictures and their differences (times eight): {}", folder.display()));
    Ok(())
}

/// Ours first, then all peers that are there.
fn players(report: &mut Report) -> Result<Vec<Player>> {
    let mut players = vec![
        Player { name: "ours", renderer: Box::new(Ours::new()?) },
        Player { name: "euc", renderer: Box::new(euc::Euc::new()) },
    ];
    let program = std::env::current_exe().context("cannot find this program itself")?;
    for driver in &DRIVERS {
        let Some(manifest) = driver.find() else {
            report.remark(&format!("NO {}: it is left out. To have it: {}", driver.name, driver.install));
            continue;
        };
        match Child::start(&program, "vulkan", &Driver::environment(&manifest)) {
            Ok(child) => {
                report.remark(&format!("{}: {}", driver.name, child.name()));
                players.push(Player { name: driver.name, renderer: Box::new(child) });
            }
            Err(error) => {
                report.remark(&format!("{} DOES NOT RUN: it is left out. {error:#}", driver.name));
            }
        }
    }
    if let Some(native) = std::env::var_os(NATIVE) {
        let child = Child::start(Path::new(&native), "ours", &[])?;
        players.push(Player { name: "native", renderer: Box::new(child) });
    }
    Ok(players)
}

fn contests() -> Vec<Contest> {
    use Sampling::{Bilinear, Nearest};
    use Shading::{Exact, Flat, Normalized, Quadratic, Table};
    let mut contests = Vec::new();
    for size in Size::ALL {
        let small = size == Size::T288;
        let job = |shading, sampling| Job::new(size, shading, sampling);
        let rival = |name, job, target| Rival { name, job, target };
        let mut contest = |name: &str, ours: Job, rivals: Vec<Rival>| {
            contests.push(Contest { name: format!("raster/{}/{name}", size.name()), ours, rivals });
        };
        let (nearest, bilinear, table) = (job(Exact, Nearest), job(Exact, Bilinear), job(Table, Nearest));
        contest(
            "exact",
            nearest,
            vec![
                rival("lavapipe", nearest, Some(3.0)),
                rival("swiftshader", nearest, None),
                rival("euc", nearest, Some(if small { 20.0 } else { 8.0 })),
                rival("native", nearest, Some(0.95)),
            ],
        );
        contest(
            "exact-bilinear",
            bilinear,
            vec![
                rival("lavapipe", bilinear, Some(3.0)),
                rival("swiftshader", bilinear, None),
                rival("native", bilinear, Some(0.95)),
            ],
        );
        let (quadratic, normalized) = (job(Quadratic, Nearest), job(Normalized, Nearest));
        contest(
            "quadratic",
            quadratic,
            vec![
                rival("lavapipe", nearest, small.then_some(4.0)),
                rival("lavapipe", normalized, None),
                // Ours against ours: the picture it stands for, and what it replaces.
                rival("ours", nearest, None),
                rival("ours", normalized, small.then_some(NORMALIZED)),
                rival("native", quadratic, Some(0.95)),
            ],
        );
        contest("normalized", normalized, vec![rival("lavapipe", normalized, None), rival("ours", nearest, None)]);
        contest(
            "table",
            table,
            vec![
                rival("lavapipe", table, Some(if small { 5.0 } else { 4.0 })),
                rival("lavapipe", nearest, Some(if small { 7.0 } else { 4.0 })),
                rival("lavapipe", job(Flat, Nearest), None),
                rival("swiftshader", table, None),
                rival("euc", table, None),
                rival("native", table, Some(0.95)),
            ],
        );
    }
    contests
}

/// All who take part in a contest draw in turns; a row for each rival.
fn hold(contest: &Contest, players: &mut [Player], rounds: usize, report: &mut Report) -> Result<()> {
    let find = |rival: &Rival| players.iter().position(|p| p.name == rival.name);
    let rivals: Vec<(usize, &Rival)> = contest.rivals.iter().filter_map(|r| Some((find(r)?, r))).collect();
    let times = turns(rounds, rivals.len() + 1, |side| match side.checked_sub(1) {
        None => players[0].renderer.seconds(contest.ours),
        Some(rival) => players[rivals[rival].0].renderer.seconds(rivals[rival].1.job),
    })?;
    for ((at, rival), &theirs) in rivals.iter().zip(&times[1..]) {
        let what = match rival.job.shading {
            shading if shading == contest.ours.shading => String::new(),
            shading => format!("-{shading:?}").to_lowercase(),
        };
        let name = format!("{}/{}{what}", contest.name, rival.name);
        // A flat picture is no picture of the same thing.
        let alike = if rival.job.shading == Shading::Flat {
            None
        } else {
            Some(compare(&name, (contest.ours, rival.job), (*at, players))?)
        };
        report.add(&Case {
            psnr_db: alike.map(|d| d.psnr_db()),
            target: rival.target,
            note: alike.map_or_else(String::new, |d| format!("coverage differs in {} pixels of 3 views", d.coverage)),
            ..Case::new(name, Unit::Seconds, times[0], Some(theirs))
        })?;
    }
    Ok(())
}

/// The pictures of ours and of player `at` in all views; those of the first are kept.
fn compare(name: &str, (ours, theirs): (Job, Job), (at, players): (usize, &mut [Player])) -> Result<Difference> {
    let mut sum = Difference::NONE;
    for view in 0..VIEW_COUNT {
        let mut picture = |at: usize, job: Job| {
            players[at].renderer.draw(job, view, 1)?;
            players[at].renderer.picture()
        };
        let (a, b) = (picture(0, ours)?, picture(at, theirs)?);
        sum = sum.and(Difference::between(&a, &b));
        if view == 0 {
            let file = name.trim_start_matches("raster/").replace('/', "-");
            pictures::keep(&format!("{file}-ours"), &a)?;
            pictures::keep(&format!("{file}-peer"), &b)?;
            pictures::keep(&format!("{file}-difference"), &pictures::difference(&a, &b))?;
        }
    }
    Ok(sum)
}

/// Pixels that each covers in each view.
fn coverage(players: &mut [Player], size: Size, report: &Report) -> Result<()> {
    let job = Job::new(size, Shading::Exact, Sampling::Nearest);
    for view in 0..VIEW_COUNT {
        let mut counts = serde_json::Map::new();
        for player in players.iter_mut() {
            player.renderer.draw(job, view, 1)?;
            counts.insert(player.name.to_owned(), pictures::covered(&player.renderer.picture()?).into());
        }
        let text: Vec<String> = counts.iter().map(|(name, count)| format!("{name} {count}")).collect();
        let case = format!("raster/{}/coverage-{view}", size.name());
        let text = format!("{case:<24} covered pixels: {}", text.join(", "));
        report.row(&json!({ "case": case, "covered_pixels": counts }), &text)?;
    }
    Ok(())
}

/// Powers of small numbers become denormal, and those are slow if nobody takes care.
fn dark(players: &mut [Player], rounds: usize, report: &mut Report) -> Result<()> {
    let ours = &mut players[0].renderer;
    for (name, shading) in [("exact", Shading::Exact), ("table", Shading::Table)] {
        let lit = Job::new(Size::T288, shading, Sampling::Nearest);
        let dark = Job { dark: true, ..lit };
        let times = turns(rounds, 2, |side| ours.seconds(if side == 0 { dark } else { lit }))?;
        report.add(&Case {
            target: Some(DARK),
            note: "ours lit from behind; the other side is ours lit from the front".to_owned(),
            ..Case::new(format!("raster/288/{name}/dark"), Unit::Seconds, times[0], Some(times[1]))
        })?;
    }
    Ok(())
}
