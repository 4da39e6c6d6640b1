//! `cargo xtask demo`: the whole pipeline on the built-in vase.

use crate::run::Run;
use anyhow::Result;
use clap::Args;

#[derive(Args)]
pub(crate) struct Options {
    /// Passed on to `rilievo demo`.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<String>,
}

pub(crate) fn run(options: &Options) -> Result<()> {
    Run::cargo().args(["run", "--release", "--", "demo"]).args(&options.rest).wait()
}
