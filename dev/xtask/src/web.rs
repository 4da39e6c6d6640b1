//! `cargo xtask web`: the viewer as a page.

use crate::needs;
use crate::run::Run;
use crate::workspace::root;
use anyhow::{Context, Result};
use clap::Args;
use std::path::PathBuf;

const TARGET: &str = "wasm32-unknown-unknown";

#[derive(Args, Default)]
pub(crate) struct Options {
    /// Build it and measure it, and do not serve it.
    #[arg(long)]
    build: bool,
    /// Build it, and drive it in a browser: by WebGPU, by WebGL2, and by the CPU.
    #[arg(long, conflicts_with = "build")]
    test: bool,
    /// The port of this machine to serve it at; 0 is any.
    #[arg(long, value_name = "PORT", default_value_t = 8000)]
    port: u16,
}

/// Drives the page in a browser.
fn test() -> Result<()> {
    needs::demand(&["chromium"])?;
    Run::cargo()
        .args(["test", "--package", "rilievo-viewer", "--package", "rilievo-cli", "--features=rilievo-cli/view"])
        .args(["--test", "page", "--", "--ignored", "--test-threads=1"])
        .wait()
}

/// The program that makes and serves pages.
fn tool() -> Result<PathBuf> {
    Run::cargo().args(["build", "--quiet", "--package", "page"]).wait()?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    Ok(target.join("debug").join(format!("page{}", std::env::consts::EXE_SUFFIX)))
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let built = root().join("target/web");
    needs::demand(&["rustup"])?;
    Run::new("rustup").args(["target", "add", TARGET]).wait()?;
    // Every browser that has WebGPU or WebGL2 has 128-bit lanes.
    Run::cargo()
        .env("RUSTFLAGS", "-C target-feature=+simd128")
        .args(["rustc", "--profile", "web", "--package", "rilievo-viewer", "--lib", "--crate-type", "cdylib"])
        .args(["--target", TARGET, "--target-dir"])
        .arg(&built)
        .wait()?;
    // The server stays where the page's tests find it.
    let tool = tool()?;
    let server = built.join("serve");
    // One that still serves cannot be written over, but it can be put aside.
    let _ = std::fs::remove_file(&server);
    std::fs::copy(&tool, &server).with_context(|| server.display().to_string())?;
    Run::new(&tool)
        .arg(built.join(TARGET).join("web/rilievo_viewer.wasm"))
        .arg(root().join("crates/rilievo-viewer/page"))
        .arg(built.join("page"))
        .args((!options.build && !options.test).then(|| format!("--serve={}", options.port)))
        .wait()?;
    if options.test { test() } else { Ok(()) }
}
