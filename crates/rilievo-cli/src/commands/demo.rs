//! `rilievo demo`: the whole pipeline on the built-in vase.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};

use crate::demo::{Demo, Entry, page};
use crate::exit::{Outcome, remark};

const AFTER_HELP: &str = "\
Examples:
  rilievo demo                     -> rilievo-demo/index.html and everything it shows
  rilievo demo -o somewhere --width 4096";

/// Run the whole pipeline on the built-in vase and leave a page that shows every step.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The folder to fill; made if it is not there.
    #[arg(short, long, value_name = "FOLDER", default_value = "rilievo-demo")]
    output: PathBuf,
    /// Width of the vase's maps in texels.
    #[arg(long, value_name = "TEXELS", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(64..=8192))]
    width: u32,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let started = Instant::now();
    fs::create_dir_all(&args.output).with_context(|| args.output.display().to_string())?;
    let sections = Demo::new(&args.output, args.width)?.run()?;
    let seconds = started.elapsed().as_secs_f64();
    let index = args.output.join("index.html");
    rilievo_io::write_atomic(&index, page(&sections, args.width, seconds).as_bytes())?;
    for entry in sections.iter().flat_map(|s| &s.entries) {
        describe(&args.output, entry);
    }
    remark(format!("done in {seconds:.1} s; open {}", index.display()));
    Ok(Outcome::Done)
}

fn describe(folder: &Path, entry: &Entry) {
    let size = entry.bytes as f64 / 1000.0;
    remark(format!("{:40} {size:9.1} kB  {}", folder.join(&entry.file).display(), entry.caption));
}
