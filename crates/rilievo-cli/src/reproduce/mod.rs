//! The papers' tables and figures, measured again: one section each, in one table that later papers add a line to.

mod clock;
mod findings;
mod page;
mod sections;
mod subjects;

use std::sync::OnceLock;
use std::time::Instant;

use anyhow::Result;
use serde_json::{Value, json};

use self::clock::Clock;
use self::findings::Findings;
use self::subjects::Vase;
use crate::exit::remark;
use crate::progress::Bars;

const TARINI: &str = "M. Tarini, P. Cignoni, C. Rocchini, R. Scopigno: Real Time, Accurate, Multi-Featured Rendering of Bump Mapped \
     Surfaces. Computer Graphics Forum 19(3), 2000.";
const HAST: &str =
    "A. Hast, T. Barrera, E. Bengtsson: Improved Bump Mapping by using Quadratic Vector Interpolation. 2002.";

const LEE: &str = "S.-G. Lee, W.-C. Park, W.-J. Lee, S.-B. Yang, T.-D. Han: An Effective Bump Mapping Hardware Architecture Using Polar Coordinate \
     System. Journal of Information Science and Engineering 23(2), 2007.";

/// A table or figure of a paper, and how it is made again.
pub(crate) struct Section {
    /// What it is called on the command line.
    pub(crate) name: &'static str,
    /// What it is called on the page.
    pub(crate) title: &'static str,
    /// The paper.
    source: &'static str,
    run: fn(&Kit<'_>) -> Result<Findings>,
}

/// All sections, in the order of the page.
pub(crate) const SECTIONS: [Section; 13] = {
    use sections::*;
    const fn of(
        source: &'static str,
        name: &'static str,
        title: &'static str,
        run: fn(&Kit<'_>) -> Result<Findings>,
    ) -> Section {
        Section { name, title, source, run }
    }
    [
        of(HAST, "setup", "Hast et al., table 1: setup of the quadratic denominator", setup::run),
        of(HAST, "interpolation", "Hast et al., table 2: what interpolation costs", interpolation::run),
        of(HAST, "torus", "Hast et al., figures 3–8: bumpy tori", torus::run),
        of(HAST, "lengths", "Hast et al., section 2: lengths of interpolated vectors", lengths::run),
        of(TARINI, "overhead", "Tarini et al., table 1: overhead of the shade table", overhead::run),
        of(TARINI, "entries", "Tarini et al., figure 3: loss by quantisation", entries::run),
        of(TARINI, "dithering", "Tarini et al., figure 4: dithered normals", dithering::run),
        of(TARINI, "models", "Tarini et al., figures 5–7: lighting models", models::run),
        of(TARINI, "materials", "Tarini et al., figures 8–10: materials in one index map", materials::run),
        of(LEE, "units", "Lee et al., table 1: what the units cost", units::run),
        of(LEE, "bumps", "Lee et al., table 2 and figures 10–12: pictures by the units", bumps::run),
        of(LEE, "rotation", "Lee et al., equations (5)–(18): how far the rotation errs", rotation::run),
        of(LEE, "accuracy", "Lee et al. and beyond: accuracy against cost", accuracy::run),
    ]
};

/// What sections are made with.
pub(crate) struct Kit<'a> {
    /// Small samples and few repetitions: to see that it works, not what it costs.
    quick: bool,
    /// Height of pictures and side of timed frames, in pixels.
    size: u32,
    clock: Clock,
    bars: &'a Bars,
    vase: &'a OnceLock<Vase>,
}

impl Kit<'_> {
    /// The vase, made when it is first asked for.
    fn vase(&self) -> Result<&Vase> {
        if let Some(vase) = self.vase.get() {
            return Ok(vase);
        }
        let made = Vase::new(if self.quick { 256 } else { 1024 }, self.bars)?;
        Ok(self.vase.get_or_init(|| made))
    }
}

/// The report: the page, and its figures for programs.
pub(crate) struct Report {
    pub(crate) html: String,
    pub(crate) json: Value,
}

/// Runs sections one after the other.
///
/// # Errors
/// Whatever a section fails with.
pub(crate) fn run(sections: &[&Section], quick: bool, size: u32) -> Result<Report> {
    let vase = OnceLock::new();
    let clock = Clock::new(quick);
    let mut done = Vec::with_capacity(sections.len());
    for section in sections {
        let started = Instant::now();
        let bars = Bars::new(section.name);
        let kit = Kit { quick, size, clock, bars: &bars, vase: &vase };
        let findings = (section.run)(&kit)?;
        drop(bars);
        let seconds = started.elapsed().as_secs_f64();
        remark(format!("{}: {seconds:.1} s", section.name));
        done.push((section, findings, seconds));
    }
    let parts: Vec<page::Part<'_>> = done
        .iter()
        .map(|(section, findings, seconds)| page::Part {
            name: section.name,
            title: section.title,
            source: section.source,
            findings,
            seconds: *seconds,
        })
        .collect();
    Ok(Report { html: page::page(&conditions(quick, size, clock), &parts), json: to_json(&done, quick, size) })
}

fn to_json(done: &[(&&Section, Findings, f64)], quick: bool, size: u32) -> Value {
    let section = |(section, findings, seconds): &(&&Section, Findings, f64)| {
        let (figures, paper) = findings.to_json();
        let seconds = (seconds * 1e3).round() / 1e3;
        json!({ "name": section.name, "title": section.title, "seconds": seconds, "figures": figures, "paper": paper })
    };
    json!({ "quick": quick, "size": size, "sections": done.iter().map(section).collect::<Vec<_>>() })
}

/// What all measurements have in common.
fn conditions(quick: bool, size: u32, clock: Clock) -> String {
    let (system, processor) = (std::env::consts::OS, std::env::consts::ARCH);
    let build = if cfg!(debug_assertions) {
        " This program was built with its checks on: times are not those of a release."
    } else {
        ""
    };
    let haste =
        if quick { " A quick run: samples are small and repetitions few, so take no time for a result." } else { "" };
    format!(
        "Pictures are {size} pixels high. Times are {}, medians of {} rounds in which all sides take turns, on {system} \
         ({processor}).{build}{haste} Figures in italics are the papers' own.",
        clock::KIND,
        clock.rounds()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_fit_for_addresses_and_differ() {
        for (i, section) in SECTIONS.iter().enumerate() {
            assert!(section.name.bytes().all(|b| b.is_ascii_lowercase() || b == b'-'), "{}", section.name);
            assert!(SECTIONS[..i].iter().all(|other| other.name != section.name), "{}", section.name);
        }
    }
}
