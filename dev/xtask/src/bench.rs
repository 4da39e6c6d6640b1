//! `cargo xtask bench`: measure against peers.

use crate::run::Run;
use crate::workspace::root;
use anyhow::{Result, ensure};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Options {
    /// What to measure; without it, everything. See --list.
    name: Option<String>,
    /// One JSON object a line, on stdout.
    #[arg(long)]
    json: bool,
    /// How often each side of a timed case runs; the median counts.
    #[arg(long, value_name = "N")]
    rounds: Option<u32>,
    /// Say what can be measured, and stop.
    #[arg(long)]
    list: bool,
    /// With `raster`: also hold it against a build for this very processor, which has a folder of its own.
    #[arg(long)]
    native: bool,
}

/// Names the second build to the bench.
const NATIVE: &str = "RILIEVO_BENCH_NATIVE";

pub(crate) fn run(options: &Options) -> Result<()> {
    let asked = |group: &str| options.name.as_deref().is_none_or(|name| name == group) && !options.list;
    let raster = asked("raster");
    ensure!(raster || !options.native, "--native belongs to the group `raster`");
    if asked("scale") {
        // Measured as users have it.
        Run::cargo().args(["build", "--release", "--quiet", "--package", "rilievo-cli"]).wait()?;
    }
    if asked("page") {
        crate::web::build()?;
    }
    let mut run = Run::cargo();
    if options.native {
        run = run.env(NATIVE, native()?);
    }
    run.args(["run", "--release", "--quiet", "--package", "bench"])
        // GPUs, through sixty crates that nothing else needs.
        .args((raster || asked("gpu")).then_some("--features=gpu"))
        .arg("--")
        .args(&options.name)
        .args(options.json.then_some("--json"))
        .args(options.list.then_some("--list"))
        .args(options.rounds.map(|rounds| format!("--rounds={rounds}")))
        .wait()
}

/// Builds the bench for the processor at hand; gives the program.
fn native() -> Result<PathBuf> {
    let folder = root().join("target/native");
    Run::cargo()
        .env("RUSTFLAGS", "-C target-cpu=native")
        .args(["build", "--release", "--quiet", "--package", "bench", "--target-dir"])
        .arg(&folder)
        .wait()?;
    Ok(folder.join("release").join(format!("bench{}", std::env::consts::EXE_SUFFIX)))
}
