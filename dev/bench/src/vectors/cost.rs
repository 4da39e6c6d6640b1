//! Tables 1 and 2 of the source, in one run.

use super::{SIDE, bare, quadratic, scene, torus};
use crate::harness::duel;
use crate::report::{Case, Report, Unit};
use anyhow::Result;
use glam::{DVec2, Vec3};
use rilievo::Grid;
use rilievo::fill::Triangle;
use rilievo::raster::scanline::{LeftEdges, Setup, Stage, interpolate, set_up_denominator};
use rilievo::raster::vectors::{Interpolation, Midpoints};

/// The torus of Table 2 has 800 polygons.
const TORUS: u32 = 20;
/// What the source's times say: (22.0 − 8.0) / (18.1 − 8.0) = 1.39, and how near to it we want to be.
const NORMALIZED_OVER_QUADRATIC: f64 = 1.25;
/// Triangles of Table 1.
const TRIANGLES: usize = 20_000;

pub(super) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    interpolation(rounds, report)?;
    setup(rounds, report)
}

/// Table 2: time of the stage over the empty loop.
fn interpolation(rounds: usize, report: &mut Report) -> Result<()> {
    let mesh = torus(TORUS)?;
    let scene = scene(bare(&mesh), 0.85, 0.4)?;
    let mut depths = [0, 1].map(|_| Grid::filled(SIDE, SIDE, 1.0f32));
    let [Ok(ours), Ok(theirs)] = &mut depths else { anyhow::bail!("no room for depths") };
    let run = |stage, depth: &mut Grid<f32>| {
        depth.texels_mut().fill(1.0);
        Ok(interpolate(&scene, stage, depth)?)
    };
    let quadratic = Stage::Interpolate(quadratic(Midpoints::GramSchmidt));
    let [linear, normalized] = [Interpolation::Linear, Interpolation::Normalized].map(Stage::Interpolate);
    let mut times = |a, b| duel(rounds, || run(a, ours), || run(b, theirs));
    let methods = times(quadratic, normalized)?;
    let rest = times(Stage::Empty, linear)?;
    let depth = times(Stage::Depth, Stage::Depth)?.ours;
    let note = |base: f64| {
        let ms = |s: f64| (s - base) * 1e3;
        format!(
            "{SIDE}², {} triangles; ms linear {:.2}, quadratic {:.2}, normalised {:.2}",
            mesh.triangles().len(),
            ms(rest.peer),
            ms(methods.ours),
            ms(methods.peer)
        )
    };
    for (name, base, target) in
        [("vectors/stage", rest.ours, Some(NORMALIZED_OVER_QUADRATIC)), ("vectors/stage-without-z", depth, None)]
    {
        let case = Case::new(name, Unit::Seconds, methods.ours - base, Some(methods.peer - base));
        report.add(&Case { target, note: note(base), ..case })?;
    }
    Ok(())
}

/// Table 1: coefficients and variables of the quadratic denominator.
fn setup(rounds: usize, report: &mut Report) -> Result<()> {
    for (two_left, paper) in [(false, 24.7 / 16.1), (true, 26.2 / 16.4)] {
        let triangles = triangles(two_left);
        let all = |setup| {
            let one = |(edges, corners): &(LeftEdges, [Vec3; 3])| set_up_denominator(setup, edges, corners);
            Ok(triangles.iter().map(one).sum::<f32>())
        };
        let times = duel(rounds, || all(Setup::Normalized), || all(Setup::Actual))?;
        let each = 1e9 / triangles.len() as f64;
        let note = format!(
            "{:.0} ns ortho-normalised, {:.0} ns actual triangle; the source has {paper:.2}",
            times.ours * each,
            times.peer * each
        );
        let name = format!("vectors/setup-{}-left", if two_left { "two" } else { "one" });
        report.add(&Case { note, ..Case::new(name, Unit::Seconds, times.ours, Some(times.peer)) })?;
    }
    Ok(())
}

/// Triangles whose middle corner is on the left, or on the right, with unit vectors at their corners.
fn triangles(two_left: bool) -> Vec<(LeftEdges, [Vec3; 3])> {
    let mut random = testkit::Random::new(11);
    let mut out = Vec::with_capacity(TRIANGLES);
    while out.len() < TRIANGLES {
        let mut in_range = |low: f64, high: f64| random.range(low, high);
        let top = DVec2::new(in_range(100.0, 900.0), in_range(100.0, 800.0));
        let bottom = top + DVec2::new(in_range(-60.0, 60.0), in_range(40.0, 100.0));
        let middle =
            top.lerp(bottom, in_range(0.2, 0.8)) + DVec2::X * in_range(10.0, 60.0) * if two_left { -1.0 } else { 1.0 };
        let mut unit = || Vec3::new(in_range(-0.5, 0.5) as f32, in_range(-0.5, 0.5) as f32, 1.0).normalize();
        let corners = [unit(), unit(), unit()];
        out.extend(Triangle::new([top, middle, bottom]).map(|shape| (LeftEdges::new(&shape, SIDE), corners)));
    }
    out
}
