//! `cargo xtask web`: the viewer as a page.

use crate::needs;
use crate::run::Run;
use crate::test::WITH_WINDOW;
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

/// The packages and features of the ordinary tests: with any others, half of what they use would be built again.
const ORDINARY: [&str; 2] = ["--workspace", WITH_WINDOW];

/// Drives the page in a browser.
pub(crate) fn drive() -> Result<()> {
    needs::demand(&["chromium"])?;
    Run::cargo().arg("test").args(ORDINARY).args(["--test", "page", "--", "--ignored", "--test-threads=1"]).wait()
}

/// The program that makes and serves pages.
fn tool() -> Result<PathBuf> {
    Run::cargo().args(["build", "--quiet", "--profile", "test", "--bin", "page"]).args(ORDINARY).wait()?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    Ok(target.join("debug").join(format!("page{}", std::env::consts::EXE_SUFFIX)))
}

/// The compiler's flags.
fn flags() -> Vec<String> {
    // Every browser that has WebGPU or WebGL2 has 128-bit lanes.
    let mut flags = vec!["-Ctarget-feature=+simd128".to_owned()];
    // Whoever loads the page learns nothing of the folders it was built in.
    let variable = |name: &str| std::env::var(name).ok();
    let home = variable("HOME").or_else(|| variable("USERPROFILE"));
    // The last that fits is taken.
    let folders = [(home, "home"), (variable("CARGO_HOME"), "cargo"), (root().to_str().map(str::to_owned), "rilievo")];
    for (folder, name) in folders {
        flags.extend(folder.map(|folder| format!("--remap-path-prefix={folder}={name}")));
    }
    flags
}

/// Builds the page and measures it.
pub(crate) fn build() -> Result<()> {
    make(None)
}

pub(crate) fn run(options: &Options) -> Result<()> {
    make((!options.build && !options.test).then_some(options.port))?;
    if options.test { drive() } else { Ok(()) }
}

/// Builds the page, and serves it at a port if there is one.
fn make(port: Option<u16>) -> Result<()> {
    let built = root().join("target/web");
    needs::demand(&["rustup"])?;
    Run::new("rustup").args(["target", "add", TARGET]).wait()?;
    Run::cargo()
        .env("CARGO_ENCODED_RUSTFLAGS", flags().join("\u{1f}"))
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
        .args(port.map(|port| format!("--serve={port}")))
        .wait()
}
