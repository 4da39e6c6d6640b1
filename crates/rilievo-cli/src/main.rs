//! The `rilievo` program: arguments in, results on stdout, messages and progress on stderr, an exit code that tells.
#![forbid(unsafe_code)]

mod args;
mod base64;
mod batch;
mod commands;
mod demo;
mod exit;
mod inputs;
mod progress;
mod relief;
mod report;
mod reproduce;
mod scene;
mod shoot;
mod surface;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::args::Given;
use crate::exit::Outcome;

const AFTER_HELP: &str = "\
Start here:
  rilievo demo                                     the whole pipeline on the built-in vase
  rilievo normal bricks.png --depth 0.04           height map -> 16-bit normal map
  rilievo quantize bricks_normal_gl.png -n 256     normal map -> indexed PNG, relightable by its palette
  rilievo relight bricks_normal_gl_256.png --light -60,30
  rilievo render sphere --height earth.png --depth 0.01
  rilievo view                                     a window to turn, light and compare in

Exit codes: 0 done; 1 a negative answer (a comparison over its threshold); 2 wrong usage; 3 cannot read or write;
4 bad input file; 5 unsupported.";

/// Bump mapping from end to end: height maps and scans to compact, relightable surfaces, and pictures of them.
#[derive(Debug, Parser)]
#[command(name = "rilievo", version, after_help = AFTER_HELP, max_term_width = 110)]
struct Cli {
    /// Threads to use; 0 is one per core.
    #[arg(long, global = true, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,
    /// No progress bars and no remarks on stderr; errors and warnings stay.
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Normal(commands::normal::Args),
    Quantize(commands::quantize::Args),
    Relight(commands::relight::Args),
    Render(Box<commands::render::Args>),
    Compare(commands::compare::Args),
    Polar(commands::polar::Args),
    View(commands::view::Args),
    Demo(commands::demo::Args),
    Reproduce(commands::reproduce::Args),
    Completions(commands::completions::Args),
}

fn main() -> ExitCode {
    let program = Cli::command();
    let matches = program.clone().get_matches();
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|e| e.exit());
    exit::quiet(cli.quiet);
    match run(cli, &Given::of(&program, &matches)) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Negative) => ExitCode::from(exit::NEGATIVE),
        Ok(Outcome::Failed(code)) => ExitCode::from(code),
        Err(error) => exit::fail(&error),
    }
}

fn run(cli: Cli, given: &Given) -> anyhow::Result<Outcome> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(cli.threads.into());
    pool.build_global().map_err(|e| exit::usage(format!("--threads {}: {e}", cli.threads)))?;
    match cli.command {
        Command::Normal(args) => commands::normal::run(&args, given),
        Command::Quantize(args) => commands::quantize::run(&args),
        Command::Relight(args) => commands::relight::run(&args, given),
        Command::Render(args) => commands::render::run(&args, given),
        Command::Compare(args) => commands::compare::run(&args, given),
        Command::Polar(args) => commands::polar::run(&args),
        Command::View(args) => commands::view::run(args),
        Command::Demo(args) => commands::demo::run(&args),
        Command::Reproduce(args) => commands::reproduce::run(&args, given),
        Command::Completions(args) => commands::completions::run(&args),
    }
}
