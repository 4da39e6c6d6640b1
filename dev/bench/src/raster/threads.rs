//! Two threads against one, on the clock on the wall: the one figure here that a busy machine spoils.

use super::ours::Ours;
use super::renderer::{Job, Renderer, Sampling, Shading};
use super::scene::{Size, VIEW_COUNT};
use crate::harness::turns;
use crate::report::{Case, Report, Unit};
use anyhow::{Context, Result};
use rayon::ThreadPoolBuilder;
use std::time::Instant;

/// How much two threads should be faster than one.
const TARGET: f64 = 1.7;
/// Frames of each view in a sample.
const FRAMES: usize = 4;

pub(super) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    if cores < 2 {
        report.remark("ONE CORE: two threads are not measured against one");
        return Ok(());
    }
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().context("cannot start threads");
    let pools = [pool(2)?, pool(1)?];
    for (size, name, shading) in [
        (Size::T288, "exact", Shading::Exact),
        (Size::T288, "table", Shading::Table),
        (Size::T70k, "exact", Shading::Exact),
        (Size::T70k, "table", Shading::Table),
    ] {
        let job = Job::new(size, shading, Sampling::Nearest);
        let mut renderers = [Ours::new()?, Ours::new()?];
        let times = turns(rounds, 2, |side| {
            let renderer = &mut renderers[side];
            pools[side].install(|| {
                // The first frame makes maps and wakes threads.
                (0..VIEW_COUNT).try_for_each(|view| renderer.draw(job, view, 1))?;
                let start = Instant::now();
                (0..VIEW_COUNT).try_for_each(|view| renderer.draw(job, view, FRAMES))?;
                Ok(start.elapsed().as_secs_f64() / (FRAMES * VIEW_COUNT) as f64)
            })
        })?;
        report.add(&Case {
            target: Some(TARGET),
            note: format!("wall time; two threads against one, {cores} cores"),
            ..Case::new(format!("raster/{}/{name}/threads", size.name()), Unit::Seconds, times[0], Some(times[1]))
        })?;
    }
    Ok(())
}
