//! `cargo xtask bless`: take today's pictures as the golden ones, and today's errors of the quantiser as the most allowed.

use crate::run::Run;
use anyhow::Result;

pub(crate) fn run() -> Result<()> {
    Run::cargo()
        .args(["test", "--package", "testkit", "--test", "golden", "--test", "quality"])
        .env("RILIEVO_BLESS", "1")
        .wait()?;
    eprintln!("Look at every changed picture at full size before you commit it:");
    Run::new("git").args(["status", "--short"]).wait()
}
