//! `cargo xtask test`: the one command that says whether the work is sound.

use crate::run::{Run, has_cargo_command, is_ci};
use crate::skips::{SkipLog, VARIABLE};
use crate::{hygiene, needs, rtl, smoke, web};
use anyhow::{Result, bail};
use clap::Args;
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

#[derive(Args)]
pub(crate) struct Options {
    /// Run only this step (may repeat); see --list.
    #[arg(long, value_name = "STEP", value_parser = clap::builder::PossibleValuesParser::new(STEPS.iter().map(|s| s.name)))]
    only: Vec<String>,
    /// Leave out the documentation and the release build of the real program.
    #[arg(long)]
    fast: bool,
    /// List the steps and stop.
    #[arg(long)]
    list: bool,
}

/// One step. They run in order, and a failing one does not keep the others from telling what they know.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    what: &'static str,
    /// What it cannot run without: names in [`needs`]. Without them it is skipped, loudly.
    pub(crate) tools: &'static [&'static str],
    slow: bool,
    run: fn(&SkipLog) -> Result<()>,
}

pub(crate) const STEPS: &[Step] = &[
    Step { name: "fmt", what: "format", tools: &["rustfmt"], slow: false, run: |_| fmt() },
    Step { name: "clippy", what: "lints", tools: &["clippy"], slow: false, run: |_| clippy() },
    Step { name: "tests", what: "unit and integration tests", tools: &[], slow: false, run: tests },
    Step { name: "doctests", what: "examples in the documentation", tools: &[], slow: false, run: doctests },
    Step { name: "one-thread", what: "the library without rayon", tools: &[], slow: false, run: one_thread },
    Step { name: "docs", what: "documentation builds without a warning", tools: &[], slow: true, run: |_| docs() },
    Step { name: "hygiene", what: "the files themselves", tools: &["git"], slow: false, run: |_| hygiene::run() },
    Step {
        name: "hardware",
        what: "the polar units' hardware against their models",
        tools: &["verilator", "yosys"],
        slow: false,
        run: |_| rtl::run(&rtl::Options::default()),
    },
    Step {
        name: "page",
        what: "the viewer in a real browser",
        tools: &["rustup", "chromium"],
        slow: true,
        run: |_| web::build().and_then(|()| web::drive()),
    },
    Step { name: "demo", what: "the real program, from end to end", tools: &[], slow: true, run: |_| smoke::run() },
];

enum Outcome {
    Passed(Duration),
    Failed(Duration, String),
    Skipped(String),
}

pub(crate) fn run(options: &Options) -> Result<()> {
    let chosen = |step: &&Step| {
        if options.only.is_empty() { !(options.fast && step.slow) } else { options.only.iter().any(|o| o == step.name) }
    };
    let steps: Vec<&Step> = STEPS.iter().filter(chosen).collect();
    if options.list {
        for step in steps {
            eprintln!("{:<11} {}", step.name, step.what);
        }
        return Ok(());
    }

    announce("needs", "external tools");
    let mut skips: BTreeSet<String> = needs::provide()?.into_iter().collect();
    let log = SkipLog::new()?;
    let mut outcomes = Vec::new();
    for step in steps {
        announce(step.name, step.what);
        let outcome = take(step, &log);
        match &outcome {
            Outcome::Passed(time) => eprintln!("{}: ok in {:.1} s", step.name, time.as_secs_f64()),
            Outcome::Failed(_, why) => eprintln!("{}: FAILED: {why}", step.name),
            Outcome::Skipped(why) => {
                eprintln!("{}: SKIPPED: {why}", step.name);
                skips.insert(format!("step {}: {why}", step.name));
            }
        }
        outcomes.push((step.name, outcome));
    }
    skips.extend(log.lines()?);
    close(&outcomes, &skips)
}

fn announce(name: &str, what: &str) {
    eprintln!("\n==== {name}: {what}");
}

fn take(step: &Step, log: &SkipLog) -> Outcome {
    if let Some(tool) = step.tools.iter().find(|tool| !needs::has(tool)) {
        return Outcome::Skipped(format!("{tool} is missing"));
    }
    let start = Instant::now();
    match (step.run)(log) {
        Ok(()) => Outcome::Passed(start.elapsed()),
        Err(error) => Outcome::Failed(start.elapsed(), format!("{error:#}")),
    }
}

/// The table of all steps, what was skipped, and the verdict.
fn close(outcomes: &[(&str, Outcome)], skips: &BTreeSet<String>) -> Result<()> {
    eprintln!("\n==== summary");
    for (name, outcome) in outcomes {
        match outcome {
            Outcome::Passed(time) => eprintln!("{name:<11} ok       {:>7.1} s", time.as_secs_f64()),
            Outcome::Failed(time, _) => eprintln!("{name:<11} FAILED   {:>7.1} s", time.as_secs_f64()),
            Outcome::Skipped(why) => eprintln!("{name:<11} SKIPPED  {why}"),
        }
    }
    if !skips.is_empty() {
        eprintln!("\nNOT EVERYTHING COULD RUN ON THIS MACHINE:");
        for skip in skips {
            eprintln!("  {skip}");
        }
        eprintln!();
    }
    eprintln!("{}", verdict(outcomes)?);
    Ok(())
}

fn verdict(outcomes: &[(&str, Outcome)]) -> Result<String> {
    let all = outcomes.len();
    let failed: Vec<_> =
        outcomes.iter().filter(|(_, o)| matches!(o, Outcome::Failed(..))).map(|(name, _)| *name).collect();
    let skipped = outcomes.iter().filter(|(_, o)| matches!(o, Outcome::Skipped(_))).count();
    if !failed.is_empty() {
        bail!("xtask test: {} of {all} steps failed: {}", failed.len(), failed.join(", "));
    }
    Ok(match skipped {
        0 => format!("xtask test: all {all} steps passed"),
        _ => format!("xtask test: {} of {all} steps passed, the others were skipped", all - skipped),
    })
}

fn fmt() -> Result<()> {
    Run::cargo().args(["fmt", "--all", "--check"]).wait()
}

/// The program with its window: what is left out of the plain one is little, and the `demo` step builds that.
pub(crate) const WITH_WINDOW: &str = "--features=rilievo-cli/view";

fn clippy() -> Result<()> {
    Run::cargo().args(["clippy", "--workspace", WITH_WINDOW, "--all-targets", "--", "-D", "warnings"]).wait()
}

fn tests(log: &SkipLog) -> Result<()> {
    let run = Run::cargo().env(VARIABLE, log.path());
    if has_cargo_command("nextest") {
        let profile = if is_ci() { "ci" } else { "default" };
        run.args(["nextest", "run", "--workspace", WITH_WINDOW, "--profile", profile]).wait()
    } else {
        run.args(["test", "--workspace", WITH_WINDOW, "--lib", "--bins", "--tests", "--examples", "--no-fail-fast"])
            .wait()
    }
}

fn doctests(log: &SkipLog) -> Result<()> {
    Run::cargo().env(VARIABLE, log.path()).args(["test", "--workspace", WITH_WINDOW, "--doc"]).wait()
}

/// The same tests, golden bits among them, on one thread of execution: rayon must change no bit.
fn one_thread(log: &SkipLog) -> Result<()> {
    let package = ["--package", "rilievo", "--no-default-features"];
    // A development dependency that switches rayon on again would make this step test nothing.
    let tree = Run::cargo().arg("tree").args(package).args(["--edges", "normal,dev", "--prefix", "none"]).output()?;
    if tree.lines().any(|line| line.starts_with("rayon ")) {
        bail!("rayon is still on without default features: some crate asks for the library with them");
    }
    Run::cargo().env(VARIABLE, log.path()).arg("test").args(package).arg("--lib").wait()
}

fn docs() -> Result<()> {
    Run::cargo().env("RUSTDOCFLAGS", "-D warnings").args(["doc", "--workspace", WITH_WINDOW, "--no-deps"]).wait()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(kind: u8) -> Outcome {
        match kind {
            0 => Outcome::Passed(Duration::from_secs(1)),
            1 => Outcome::Failed(Duration::from_secs(1), "why".to_owned()),
            _ => Outcome::Skipped("why".to_owned()),
        }
    }

    #[test]
    fn all_passed() {
        let line = verdict(&[("a", outcome(0)), ("b", outcome(0))]).unwrap();
        assert_eq!(line, "xtask test: all 2 steps passed");
    }

    #[test]
    fn skipped_is_not_passed() {
        let line = verdict(&[("a", outcome(0)), ("b", outcome(2))]).unwrap();
        assert_eq!(line, "xtask test: 1 of 2 steps passed, the others were skipped");
    }

    #[test]
    fn one_failure_fails_and_is_named() {
        let error = verdict(&[("a", outcome(0)), ("b", outcome(1)), ("c", outcome(2))]).unwrap_err();
        assert_eq!(error.to_string(), "xtask test: 1 of 3 steps failed: b");
    }
}
