//! The `rilievo` program: arguments in, results on stdout, messages and progress on stderr, an exit code that tells.
#![forbid(unsafe_code)]

mod args;
mod batch;
mod commands;
mod demo;
mod exit;
mod inputs;
mod progress;
mod relief;
mod report;
mod surface;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::exit::Outcome;

const AFTER_HELP: &str = "\
Start here:
  rilievo demo                                     the whole pipeline on the built-in vase
  rilievo normal bricks.png --depth 0.04           height map -> 16-bit normal map
  rilievo quantize bricks_normal_gl.png -n 256     normal map -> indexed PNG, relightable by its palette
  rilievo relight bricks_normal_gl_256.png --light -60,30
  rilievo render sphere --height earth.png --depth 0.01

Exit codes: 0 done; 1 a negative answer (a comparison over its threshold); 2 wrong usage; 3 cannot read or write;
4 bad input file; 5 unsupported.";

/// Bump mapping from end to end: height maps and scans to compact, relightable surfaces, and pictures of them.
#[derive(Debug, Parser)]
#[command(name = "rilievo", version, after_help = AFTER_HELP, max_term_width = 110)]
struct Cli {
    /// Threads to use; 0 is one per core.
    #[arg(long, global = true, value_name = "N", default_value_t = 0)]
    threads: usize,
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
    Render(commands::render::Args),
    Compare(commands::compare::Args),
    Demo(commands::demo::Args),
    Completions(commands::completions::Args),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    exit::quiet(cli.quiet);
    // A pool that cannot be made is not worth stopping for: rayon then uses its own.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(cli.threads).build_global();
    let outcome = match cli.command {
        Command::Normal(args) => commands::normal::run(&args),
        Command::Quantize(args) => commands::quantize::run(&args),
        Command::Relight(args) => commands::relight::run(&args),
        Command::Render(args) => commands::render::run(&args),
        Command::Compare(args) => commands::compare::run(&args),
        Command::Demo(args) => commands::demo::run(&args),
        Command::Completions(args) => commands::completions::run(&args),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Negative) => ExitCode::from(exit::NEGATIVE),
        Ok(Outcome::Failed(code)) => ExitCode::from(code),
        Err(error) => exit::fail(&error),
    }
}
