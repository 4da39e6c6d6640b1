//! The developer's commands, each in a file of its own: `cargo xtask COMMAND`.
//!
//! This crate is built before anything else, so it depends on few crates, and of the product's own only on the models of the polar
//! units, which depend on none.
#![forbid(unsafe_code)]
#![expect(clippy::print_stderr, reason = "a tool for the terminal; stdout belongs to the programs it runs")]

mod bench;
mod bless;
mod demo;
mod deny;
mod hygiene;
mod needs;
mod rtl;
mod run;
mod skips;
mod smoke;
mod test;
mod web;
mod workspace;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "The developer's commands of rilievo")]
struct Arguments {
    #[command(subcommand)]
    command: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Check everything: format, lints, tests, documentation, hygiene, and the real program.
    Test(test::Options),
    /// Say which external tools are missing, what for, and how to get them.
    Needs,
    /// Run the whole pipeline on the built-in vase.
    Demo(demo::Options),
    /// Take today's pictures as the golden ones.
    Bless,
    /// Check the files themselves: paths, sizes, manifests, licences.
    Hygiene,
    /// Check licences, duplicates and sources with cargo-deny, stricter than the hygiene step.
    Deny,
    /// Check the hardware of the polar units against their models: tables, lint, replay, cost.
    Rtl(rtl::Options),
    /// Build the viewer as a page, measure it, and serve it.
    Web(web::Options),
    /// Measure against peers.
    Bench(bench::Options),
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Task::Test(options) => test::run(&options),
        Task::Needs => needs::report(),
        Task::Demo(options) => demo::run(&options),
        Task::Bless => bless::run(),
        Task::Hygiene => hygiene::run(),
        Task::Deny => deny::run(),
        Task::Rtl(options) => rtl::run(&options),
        Task::Web(options) => web::run(&options),
        Task::Bench(options) => bench::run(&options),
    };
    // Without a stack trace: what failed is another program or a file, not this one.
    done.map_or_else(
        |error| {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}
