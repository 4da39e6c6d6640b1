//! Benchmarks against peers: `cargo xtask bench [NAME] [--json] [--rounds N]`.
//!
//! Figures are ratios within one run: both sides on one thread, in processor time, in turns, medians over the rounds.
//! So they bear a busy machine better than bare times do; no test depends on any of them.
#![forbid(unsafe_code)]

mod clock;
#[cfg(feature = "gpu")]
mod gpu;
mod harness;
mod height;
mod inputs;
mod light;
mod machine;
mod models;
mod page;
mod polar;
mod quantize;
mod raster;
mod relight;
mod render;
mod report;
mod scale;
mod size;
mod vectors;

use anyhow::{Context, Result};
use clap::Parser;
use clap::builder::PossibleValuesParser;
use report::Report;
use std::num::NonZeroUsize;

/// A group of cases, in a file of its own.
struct Group {
    name: &'static str,
    what: &'static str,
    run: fn(rounds: usize, &mut Report) -> Result<()>,
}

/// Without the feature it is there to be asked for, and says what it takes.
#[cfg(not(feature = "gpu"))]
mod gpu {
    pub(crate) fn run(_: usize, report: &mut crate::report::Report) -> anyhow::Result<()> {
        report.remark("gpu: this build has no GPU; `cargo xtask bench gpu` makes one that has");
        Ok(())
    }
}

const GROUPS: [Group; 13] = [
    Group { name: "quantize", what: "error of tables against the best there can be", run: quantize::run },
    Group {
        name: "scale",
        what: "a map of 16 384 × 16 384 texels through the program: memory, error, time",
        run: scale::run,
    },
    Group {
        name: "size",
        what: "bytes against error: index maps, PNG, BC7, octahedral; rewrites docs/",
        run: size::run,
    },
    Group { name: "gpu", what: "what a moved light costs before the GPU draws: time, bytes", run: gpu::run },
    Group { name: "height", what: "height → normal against copying the same bytes", run: height::run },
    Group { name: "light", what: "a table lit sixteen normals at a time against one at a time", run: light::run },
    Group { name: "models", what: "a table's light against a frame's and against every pixel's", run: models::run },
    Group { name: "page", what: "the viewer in a browser: loading, a dropped map, frames", run: page::run },
    Group { name: "polar", what: "models of bump units against the same products in floats", run: polar::run },
    Group { name: "relight", what: "rewriting a palette against looking up every texel", run: relight::run },
    Group { name: "raster", what: "frames against lavapipe, SwiftShader and euc", run: raster::run },
    Group { name: "render", what: "the reference renderer: table against exact", run: render::run },
    Group {
        name: "vectors",
        what: "interpolated light vectors: cost by scan lines, lengths, pictures",
        run: vectors::run,
    },
];

/// Measure against peers, on one thread.
#[derive(Parser)]
#[command(name = "cargo xtask bench --")]
struct Arguments {
    /// What to measure; without it, everything.
    #[arg(value_parser = PossibleValuesParser::new(GROUPS.iter().map(|g| g.name)))]
    name: Option<String>,
    /// One JSON object a line, on stdout.
    #[arg(long)]
    json: bool,
    /// How often each side of a timed case runs; the median counts.
    #[arg(long, default_value = "7")]
    rounds: NonZeroUsize,
    /// Say what can be measured, and stop.
    #[arg(long)]
    list: bool,
    /// Be a renderer for another process of this program, on stdin and stdout.
    #[arg(long, hide = true, value_name = "ROLE")]
    serve: Option<raster::Role>,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let mut report = Report::new(arguments.json);
    if arguments.list {
        return GROUPS.iter().try_for_each(|g| report.line(&format!("{:<9} {}", g.name, g.what)));
    }
    // The main thread is the pool: the clock sees all of the work and no other thread sleeps and wakes.
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()
        .context("cannot confine the work to one thread")?;
    if let Some(role) = arguments.serve {
        return raster::serve(role);
    }
    let rounds = arguments.rounds.get();
    report.remark(&machine::describe(rounds));
    report.heading()?;
    for group in GROUPS.iter().filter(|g| arguments.name.as_deref().is_none_or(|name| name == g.name)) {
        (group.run)(rounds, &mut report).with_context(|| format!("bench {}", group.name))?;
    }
    report.close()
}
