//! `cargo xtask bench`: measure against peers.

use crate::run::Run;
use anyhow::Result;
use clap::Args;

#[derive(Args)]
pub(crate) struct Options {
    /// What to measure; without it, everything.
    name: Option<String>,
    /// One JSON object a line, on stdout.
    #[arg(long)]
    json: bool,
    /// Passed on to the benchmark.
    #[arg(last = true)]
    rest: Vec<String>,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    Run::cargo()
        .args(["run", "--release", "--package", "bench", "--"])
        .args(&options.name)
        .args(options.json.then_some("--json"))
        .args(&options.rest)
        .wait()
}
