//! `rilievo reproduce`: the papers' tables and figures, measured again.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::args::Given;
use crate::batch::check_output;
use crate::exit::{Outcome, remark, usage};
use crate::reproduce::{self, SECTIONS, Section};

const AFTER_HELP: &str = "\
Examples:
  rilievo reproduce                              -> rilievo-reproduce.html, in a minute or two
  rilievo reproduce --list                       what there is
  rilievo reproduce --only overhead,entries -o table.html
  rilievo reproduce --json > figures.json        every figure, beside the papers' own

Times are taken on one thread; --threads is for the rest.";

/// Measure the papers' tables and figures again, and leave them beside the papers' own as a page.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// The page: one HTML file with its pictures inside.
    #[arg(short, long, value_name = "HTML", default_value = "rilievo-reproduce.html")]
    output: PathBuf,
    /// Only these sections, in the order of the page; see --list.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    only: Vec<String>,
    /// Small samples and few repetitions: to see that it works.
    #[arg(long)]
    quick: bool,
    /// Height of pictures and side of timed frames, in pixels [default: 512, with --quick 96].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(32..=1024))]
    size: Option<u32>,
    /// List the sections and stop.
    #[arg(long)]
    list: bool,
    /// Print all figures as JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args, given: &Given) -> Result<Outcome> {
    if args.list {
        given.unused(&["output", "only", "quick", "size", "json"], "--list makes no page");
        return list();
    }
    let is_stdout = args.output.as_os_str() == "-";
    if is_stdout && args.json {
        return Err(usage("the page and the figures cannot both go to standard output; give -o a file"));
    }
    check_output(&args.output, &["html", "htm"], &[])?;
    let sections = chosen(&args.only)?;
    // A minute's work should not end at a folder that is not there.
    if let Some(folder) = args.output.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::metadata(folder).with_context(|| folder.display().to_string())?;
    }
    let size = args.size.unwrap_or(if args.quick { 96 } else { 512 });
    let report = reproduce::run(&sections, args.quick, size)?;
    rilievo_io::write_atomic(&args.output, report.html.as_bytes())?;
    if args.json {
        writeln!(io::stdout().lock(), "{}", report.json).context("stdout")?;
    }
    if !is_stdout {
        remark(format!("{}: {:.1} MB", args.output.display(), report.html.len() as f64 / 1e6));
    }
    Ok(Outcome::Done)
}

fn list() -> Result<Outcome> {
    let mut out = io::stdout().lock();
    let width = SECTIONS.iter().map(|s| s.name.len()).max().unwrap_or(0);
    for Section { name, title, .. } in &SECTIONS {
        writeln!(out, "{name:width$}  {title}").context("stdout")?;
    }
    Ok(Outcome::Done)
}

/// The sections of these names, or all.
fn chosen(only: &[String]) -> Result<Vec<&'static Section>> {
    let is_known = |name: &String| SECTIONS.iter().any(|s| s.name == name.trim());
    if let Some(name) = only.iter().find(|name| !is_known(name)) {
        let names: Vec<&str> = SECTIONS.iter().map(|s| s.name).collect();
        return Err(usage(format!("--only: there is no section '{}'; there are {}", name.trim(), names.join(", "))));
    }
    let is_wanted = |section: &&Section| only.is_empty() || only.iter().any(|name| name.trim() == section.name);
    Ok(SECTIONS.iter().filter(is_wanted).collect())
}
