//! `cargo xtask bench`: measure against peers.

use crate::run::Run;
use anyhow::Result;
use clap::Args;

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
}

pub(crate) fn run(options: &Options) -> Result<()> {
    if options.name.as_deref().is_none_or(|name| name == "scale") && !options.list {
        // Measured as users have it.
        Run::cargo().args(["build", "--release", "--quiet", "--package", "rilievo-cli"]).wait()?;
    }
    Run::cargo()
        .args(["run", "--release", "--quiet", "--package", "bench", "--"])
        .args(&options.name)
        .args(options.json.then_some("--json"))
        .args(options.list.then_some("--list"))
        .args(options.rounds.map(|rounds| format!("--rounds={rounds}")))
        .wait()
}
