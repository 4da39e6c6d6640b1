//! `cargo xtask deny`: dependencies, by cargo-deny where it is installed.

use crate::run::{Run, has_cargo_command};
use anyhow::{Result, bail};

/// Not part of `cargo xtask test`: it takes a quarter of an hour to install, and the hygiene step checks every licence.
pub(crate) fn run() -> Result<()> {
    if !has_cargo_command("deny") {
        bail!("cargo-deny is missing; get it with: cargo install cargo-deny --locked");
    }
    Run::cargo().args(["deny", "check", "licenses", "bans", "sources"]).wait()
}
