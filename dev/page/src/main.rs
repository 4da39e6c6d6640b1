//! Makes the script of a page out of a WebAssembly module, measures it, and serves the page: what `cargo xtask web` runs.
//!
//! A program of its own, so that only who builds the page compiles the tool that takes modules apart.
#![forbid(unsafe_code)]

mod serve;

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;
use flate2::Compression;
use flate2::write::GzEncoder;
use wasm_bindgen_cli_support::Bindgen;

/// Bytes that the module may have at most, gzipped.
const MOST_BYTES: u64 = 2_500_000;

/// Makes a page of a WebAssembly module and of the files beside it.
#[derive(Parser)]
#[command(name = "page")]
struct Arguments {
    /// The module, the folder of the page's own files, and where the page is put.
    #[arg(num_args = 3, value_names = ["MODULE", "FILES", "OUTPUT"], required_unless_present = "only_serve")]
    make: Vec<PathBuf>,
    /// Serve it at a port of this machine, 0 for any, until stopped.
    #[arg(long, value_name = "PORT")]
    serve: Option<u16>,
    /// Make nothing; serve a folder at any port.
    #[arg(long, value_name = "FOLDER", conflicts_with = "make")]
    only_serve: Option<PathBuf>,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    if let Some(folder) = &arguments.only_serve {
        return serve::serve(folder, 0);
    }
    let [module, files, output] = &arguments.make[..] else { bail!("three paths make a page") };
    make(module, files, output)?;
    match arguments.serve {
        Some(port) => serve::serve(output, port),
        None => Ok(()),
    }
}

/// Puts the page together, and says how large its module is.
#[expect(clippy::print_stderr, reason = "a developer's command")]
fn make(module: &Path, files: &Path, output: &Path) -> Result<()> {
    fs::create_dir_all(output).with_context(|| output.display().to_string())?;
    Bindgen::new()
        .input_path(module)
        .web(true)?
        .typescript(false)
        .out_name("rilievo")
        .remove_name_section(true)
        .remove_producers_section(true)
        .generate(output)?;
    for entry in fs::read_dir(files).with_context(|| files.display().to_string())? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default();
        fs::copy(&path, output.join(name)).with_context(|| path.display().to_string())?;
    }
    fs::write(output.join("font.ttf"), epaint_default_fonts::UBUNTU_LIGHT)?;
    let module = output.join("rilievo_bg.wasm");
    let (bytes, packed) = sizes(&module)?;
    eprintln!("{}: {:.2} MB, {:.2} MB gzipped", module.display(), bytes as f64 * 1e-6, packed as f64 * 1e-6);
    ensure!(packed <= MOST_BYTES, "the module has {packed} bytes gzipped, and should have {MOST_BYTES} at most");
    Ok(())
}

/// Bytes of a file as it is and gzipped.
fn sizes(file: &Path) -> Result<(u64, u64)> {
    let bytes = fs::read(file).with_context(|| file.display().to_string())?;
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&bytes)?;
    Ok((bytes.len() as u64, packed.finish()?.len() as u64))
}
