//! A program that was built without a window says how to get one.

use anyhow::{Result, bail};

use crate::exit::Outcome;

/// Look at a surface: turn it, light it, compare methods. This program was built without it.
///
/// cargo install --path crates/rilievo-cli --features view
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Files and flags of the viewer.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    arguments: Vec<String>,
}

pub(crate) fn run(args: Args) -> Result<Outcome> {
    let called = ["rilievo view"].into_iter().chain(args.arguments.iter().map(String::as_str));
    bail!(
        "{}: this program was built without its window; build it with `cargo install --path crates/rilievo-cli --features view`",
        called.collect::<Vec<_>>().join(" ")
    )
}
