//! Table 2 of Hast et al.: a torus of 800 polygons, interpolated and not lit.

use std::hint::black_box;

use anyhow::Result;
use rilievo::raster::Method;
use rilievo::raster::scanline::{Stage, interpolate};
use rilievo::raster::vectors::Midpoints;
use rilievo::{Grid, Progress};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};
use crate::reproduce::subjects::{Easel, METHODS, Torus, VIEWS, Way, quadratic};

/// 2 · 20 · 20 = 800 triangles.
const TORUS: u32 = 20;
/// The paper's column, in its own unit.
const EMPTY: f64 = 8.0;
const LINEAR: f64 = 15.7;
const QUADRATIC: f64 = 18.1;
const NORMALIZED: f64 = 22.0;

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    kit.bars.begin("timing interpolation", 2);
    let torus = Torus::new(TORUS, if kit.quick { 64 } else { 256 })?;
    let scene = torus.bare_scene(VIEWS[0])?;
    let ways = METHODS.map(|way| Stage::Interpolate(way.how));
    let stages: Vec<Stage> = [Stage::Empty, Stage::Depth].into_iter().chain(ways).collect();
    let mut depth = Grid::filled(kit.size, kit.size, 1.0f32)?;
    let times = kit.clock.turns(stages.len(), |side| {
        depth.texels_mut().fill(1.0);
        black_box(interpolate(&scene, stages[side], &mut depth)?);
        Ok(())
    })?;
    kit.bars.advance(1);
    let ms: Vec<f64> = times.iter().map(|s| s * 1e3).collect();
    let frames = frames(kit, &torus)?;
    kit.bars.advance(1);
    Ok(told(kit, &ms, &frames))
}

/// What the tile renderer takes for lit frames: of each method, and by the pixel.
struct Frames {
    ways: [f64; METHODS.len()],
    exact: f64,
}

fn frames(kit: &Kit<'_>, torus: &Torus) -> Result<Frames> {
    let scene = torus.scene(VIEWS[0])?;
    let methods: Vec<Method> = METHODS.iter().map(Way::method).chain([Method::Exact]).collect();
    let mut easel = Easel::new(kit.size)?;
    let ms = kit.clock.turns(methods.len(), |side| easel.draw(&scene, methods[side]).map(drop))?;
    let ms = |side: usize| ms.get(side).map_or(f64::NAN, |s| s * 1e3);
    Ok(Frames { ways: std::array::from_fn(ms), exact: ms(METHODS.len()) })
}

fn told(kit: &Kit<'_>, ms: &[f64], frames: &Frames) -> Findings {
    let mut found = Findings::default();
    found.paper(
        "A bumpy torus of 800 polygons is turned and scan-converted. The empty loop turns it, reads the bump map and calls a \
         shading function that returns at once; the three methods add their setup, the two inner loops and the depth test, but no \
         lighting and no frame buffer. Taking the empty loop away, normalising takes 37 % longer than quadratic interpolation.",
    );
    found.here(format!(
        "The same torus, {0} × {0} pixels. The empty loop transforms vertices, clips triangles and clears the depths. The paper's \
         quadratic method has new frames at the midpoints of edges; the two others are its second way and this program's own.",
        kit.size
    ));
    let (empty, depth) = (ms[0], ms[1]);
    let net = |i: usize| ms[i] - empty;
    let linear = net(2);
    let mut table = Table::new(
        "Time of a frame; \"net\" is without the empty loop, and × says how it compares with the linear method.",
        vec![
            Column::here("method"),
            Column::here("ms"),
            Column::here("net ms"),
            Column::here("net, × linear"),
            Column::paper("time"),
            Column::paper("net"),
            Column::paper("net, × linear"),
        ],
    );
    let papers = [Some(LINEAR), Some(NORMALIZED), Some(QUADRATIC), None, None];
    let paper_cells = |paper: Option<f64>| match paper {
        Some(p) => {
            let net = p - EMPTY;
            [format!("{p:.1}"), format!("{net:.1}"), format!("{:.2}", net / (LINEAR - EMPTY))]
        }
        None => ["–", "–", "–"].map(str::to_owned),
    };
    let first = |name: &str, ms: f64, rest: [String; 2]| {
        let [net, times] = rest;
        vec![name.to_owned(), format!("{ms:.3}"), net, times]
    };
    let dash = || "–".to_owned();
    let mut row = first("empty loop", empty, [dash(), dash()]);
    row.extend([format!("{EMPTY:.1}"), dash(), dash()]);
    table.row(row);
    let mut row = first("edges and depth test alone", depth, [format!("{:.3}", depth - empty), dash()]);
    row.extend(paper_cells(None));
    table.row(row);
    for (i, (way, paper)) in METHODS.iter().zip(papers).enumerate() {
        let net = net(2 + i);
        let mut row = first(way.name, ms[2 + i], [format!("{net:.3}"), format!("{:.2}", net / linear)]);
        row.extend(paper_cells(paper));
        table.row(row);
        found.figure(format!("{}_net_ms", way.key), net);
        match paper {
            Some(p) => found.against(format!("{}_over_linear", way.key), net / linear, (p - EMPTY) / (LINEAR - EMPTY)),
            None => found.figure(format!("{}_over_linear", way.key), net / linear),
        }
    }
    found.figure("empty_ms", empty);
    found.figure("depth_ms", depth);
    found.show(table);
    let position = |how| METHODS.iter().position(|way| way.how == how).unwrap_or(2);
    let new_frames = net(2 + position(quadratic(Midpoints::NewFrames)));
    let ratio = net(3) / new_frames;
    let paper_ratio = (NORMALIZED - EMPTY) / (QUADRATIC - EMPTY);
    found.against("normalised_over_quadratic", ratio, paper_ratio);
    let verdict = if ratio > 1.05 {
        "dearer than quadratic interpolation, as in the paper"
    } else if ratio < 0.95 {
        "cheaper than quadratic interpolation, against the paper"
    } else {
        "as dear as quadratic interpolation, against the paper"
    };
    let lit = lit(frames, &mut found);
    found.show(lit);
    let sixteen = frames.ways[1] / frames.ways[position(quadratic(Midpoints::NewFrames))];
    found.remark(format!(
        "Normalising is {verdict}: net, the two are as {ratio:.2} to 1 where the paper has {paper_ratio:.2}. Roots and divisions are \
         not what they were in 2002: a processor begins the next one before the last is done, and of a frame of 800 triangles the \
         six samples of each take their share. Where sixteen pixels are shaded side by side, with texture and light, whole frames \
         are as {sixteen:.2} to 1: what speaks for quadratic interpolation now is the picture more than the time. See the next section."
    ));
    found
}

/// Whole frames, with texture and light.
fn lit(frames: &Frames, found: &mut Findings) -> Table {
    let mut table = Table::new(
        "Whole frames with the relief and its light, by the tile renderer, which shades sixteen pixels side by side.",
        ["method", "ms", "× linear"].map(Column::here).to_vec(),
    );
    let ways = METHODS.iter().map(|way| (way.name, way.key)).zip(frames.ways);
    for ((name, key), ms) in ways.chain([(("exact, frame and vectors by the pixel", "exact"), frames.exact)]) {
        found.figure(format!("lit_{key}_frame_ms"), ms);
        table.row(vec![name.to_owned(), format!("{ms:.3}"), format!("{:.2}", ms / frames.ways[0])]);
    }
    table
}
