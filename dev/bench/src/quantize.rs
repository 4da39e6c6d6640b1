//! The quantiser's error against the best there can be.

use crate::harness::once;
use crate::report::{Case, Report, Unit};
use anyhow::Result;
use rilievo::progress::Silent;
use rilievo::quantize::{Options, fejes_toth_rms_rad, quantize};
use rilievo::{Convention, Grid, NormalMap, Object};
use rilievo_io::{Limits, Source, decode_normals};

/// The three sizes of a table in Tarini et al. 2000 and in everything compared with it.
const ENTRIES: [u32; 3] = [256, 2048, 16_384];
/// What the error may be at most, over the bound.
const TARGET: f64 = 1.03;
/// A map of a real scan, in object space.
const REAL_MAP: &str = "normal/bunny_object_1536x1024.png";

/// Errors are the same in every run, so each table is made once, whatever the number of rounds.
pub(crate) fn run(_rounds: usize, report: &mut Report) -> Result<()> {
    let sphere: NormalMap<Object> = Grid::new(1000, 1000, testkit::uniform_sphere(1_000_000, 1))?;
    for entries in ENTRIES {
        let bound = fejes_toth_rms_rad(entries).to_degrees();
        let case = measure(&format!("quantize/sphere-{entries}"), &sphere, None, entries, Some(bound))?;
        report.add(&with_target(case, entries))?;
    }
    let Some(folder) = testkit::shared_data() else { return Ok(()) };
    let limits = Limits::default();
    let real = decode_normals::<Object>(&Source::open(&folder.join(REAL_MAP), &limits)?, Convention::Gl, &limits)?;
    for entries in ENTRIES {
        let name = format!("quantize/bunny-{entries}");
        report.add(&measure(&name, &real.normals, real.covered.as_ref(), entries, None)?)?;
    }
    Ok(())
}

fn measure(
    name: &str,
    map: &NormalMap<Object>,
    covered: Option<&Grid<bool>>,
    entries: u32,
    bound_deg: Option<f64>,
) -> Result<Case> {
    let options = Options { entries, covered, ..Options::default() };
    let (made, spent) = once(|| Ok(quantize(map, &options, &Silent)?))?;
    let case = Case::new(name, Unit::Degrees, made.error.rms_rad.to_degrees(), bound_deg);
    Ok(Case { spent: Some(spent), ..case })
}

/// The bound holds for the sphere; with few samples an entry a table fits these rather than the sphere, and the
/// ratio says little.
fn with_target(case: Case, entries: u32) -> Case {
    let samples = 1_000_000 / entries;
    if samples < 100 {
        let note = format!("no target: with {samples} samples an entry the table fits the samples");
        return Case { note, ..case };
    }
    Case { target: Some(TARGET), note: "against the Fejes Tóth bound; next aim 1.005".to_owned(), ..case }
}
