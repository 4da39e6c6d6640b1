//! What the timings say.

use super::timing::{Growth, Rival, Scaling, Table as Timed};
use super::{ENTRIES, MODELS};
use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Table};
use crate::reproduce::page::{Axis, Plot, Series};

pub(super) fn told(kit: &Kit<'_>, timed: &Timed, growth: &Growth, rivals: &[Rival], scaling: &[Scaling]) -> Findings {
    let mut found = Findings::default();
    found.paper(
        "A bunny of 251 faces under a quantised normal map, on a Pentium at 300 MHz with a Riva 128: milliseconds a frame to light \
         the table of normals, which is all that bump mapping adds to drawing a texture, and frames a second, for four \
         lighting models and three sizes of the table. A light map that was baked once is drawn at 16 frames a second, the \
         scanned bunny of 69 000 faces at less than 2.",
    );
    let pixels = f64::from(kit.size).powi(2);
    found.here(format!(
        "The vase of 1200 faces, its normals in tables of the same sizes, in frames of {0} × {0} pixels of which it covers {1:.0} %; \
         drawn by the tile renderer on one thread, texels filtered bilinearly. The table is lit sixteen entries at a time. The \
         dense mesh is the same vase with its relief as geometry.",
        kit.size,
        100.0 * timed.covered as f64 / pixels
    ));
    let table = overhead(timed, &mut found);
    found.show(table);
    found.show(plot(growth));
    let table = methods(rivals, &mut found);
    found.show(table);
    let table = independence(scaling, &mut found);
    found.show(table);
    remark(&mut found, timed, rivals, scaling);
    found
}

fn overhead(timed: &Timed, found: &mut Findings) -> Table {
    let mut table = Table::new(
        "Overhead: lighting the table, in milliseconds and as a share of the frame. Shares of the paper are computed from its \
         milliseconds and frames a second.",
        vec![
            Column::here("model"),
            Column::here("entries"),
            Column::here("overhead, ms"),
            Column::here("share of the frame, %"),
            Column::here("frames a second"),
            Column::paper("overhead, ms"),
            Column::paper("share of the frame, %"),
            Column::paper("frames a second"),
        ],
    );
    for (m, model) in MODELS.iter().enumerate() {
        for (k, entries) in ENTRIES.into_iter().enumerate() {
            let (light, frame) = (timed.table[m][k], timed.frame[m][k]);
            let (paper_ms, paper_fps) = (model.paper_ms[k], model.paper_fps[k]);
            let (share, paper_share) = (100.0 * light / frame, paper_ms * paper_fps / 10.0);
            found.against(format!("{}_{entries}_overhead_ms", model.key), light * 1e3, paper_ms);
            found.against(format!("{}_{entries}_share_percent", model.key), share, paper_share);
            found.against(format!("{}_{entries}_frames_per_second", model.key), 1.0 / frame, paper_fps);
            table.row(vec![
                model.name.to_owned(),
                timed.entries[k].to_string(),
                format!("{:.4}", light * 1e3),
                format!("{share:.1}"),
                format!("{:.0}", 1.0 / frame),
                format!("{paper_ms:.1}"),
                format!("{paper_share:.1}"),
                paper_fps.to_string(),
            ]);
        }
    }
    table
}

fn plot(growth: &Growth) -> Plot {
    let series = MODELS.iter().zip(growth).map(|(model, points)| {
        Series::measured(model.name, points.iter().map(|[entries, seconds]| [*entries, seconds * 1e6]).collect())
    });
    let caption = "Microseconds to light a table, over its size. The slope is that of proportionality as soon as the table is large \
                   enough for what is done once to disappear.";
    Plot::new(caption, Axis::doublings("entries"), Axis::decades("µs"), series.collect())
}

fn methods(rivals: &[Rival], found: &mut Findings) -> Table {
    let mut table = Table::new(
        "The same look by other means, with Lambert and specular light.",
        vec![
            Column::here("method"),
            Column::here("faces"),
            Column::here("ms a frame"),
            Column::here("frames a second"),
            Column::here("time, × light map"),
            Column::paper("frames a second"),
        ],
    );
    let first = rivals.first().map_or(f64::NAN, |r| r.seconds);
    for rival in rivals {
        let times = rival.seconds / first;
        found.figure(format!("{}_frame_ms", rival.key), rival.seconds * 1e3);
        found.figure(format!("{}_over_light_map", rival.key), times);
        table.row(vec![
            rival.name.to_owned(),
            rival.faces.to_string(),
            format!("{:.2}", rival.seconds * 1e3),
            format!("{:.0}", 1.0 / rival.seconds),
            format!("{times:.2}"),
            rival.paper.to_owned(),
        ]);
    }
    table
}

fn independence(scaling: &[Scaling], found: &mut Findings) -> Table {
    let mut table = Table::new(
        "What the overhead does not depend on: 2048 entries, Lambert and specular light, pictures and lights of several numbers.",
        vec![
            Column::here("picture"),
            Column::here("lights"),
            Column::here("overhead, ms"),
            Column::here("frame by table, ms"),
            Column::here("share, %"),
            Column::here("frame by pixel, ms"),
        ],
    );
    for row in scaling {
        let key = format!("picture_{}_lights_{}", row.side, row.lights);
        found.figure(format!("{key}_overhead_ms"), row.table * 1e3);
        found.figure(format!("{key}_frame_ms"), row.frame * 1e3);
        found.figure(format!("{key}_exact_frame_ms"), row.exact * 1e3);
        table.row(vec![
            format!("{0} × {0}", row.side),
            row.lights.to_string(),
            format!("{:.4}", row.table * 1e3),
            format!("{:.2}", row.frame * 1e3),
            format!("{:.1}", 100.0 * row.table / row.frame),
            format!("{:.2}", row.exact * 1e3),
        ]);
    }
    table
}

fn remark(found: &mut Findings, timed: &Timed, rivals: &[Rival], scaling: &[Scaling]) {
    let shares = |k: usize| (0..MODELS.len()).map(move |m| 100.0 * timed.table[m][k] / timed.frame[m][k]);
    let worst = |k: usize| shares(k).fold(0.0, f64::max);
    found.against("largest_share_at_2048_percent", worst(1), 2.6);
    let verdict =
        if worst(1) < 5.0 { "the paper's shape holds" } else { "the paper's shape does not hold in this run" };
    found.remark(format!(
        "With 2048 entries lighting takes {:.1} % of the frame at most (paper: 2.6 %), with 16 384 up to {:.0} % (paper: 17 %): {verdict}. \
         The overhead grows with the number of entries and with what the model asks of one, lights among it, and not with pixels, texels \
         or faces.",
        worst(1),
        worst(2)
    ));
    let of = |key: &str| rivals.iter().find(|r| r.key == key).map_or(f64::NAN, |r| r.seconds);
    let (one, many) = (scaling.get(1), scaling.last());
    let grown = |value: fn(&Scaling) -> f64| match (one, many) {
        (Some(one), Some(many)) => value(many) / value(one),
        _ => f64::NAN,
    };
    found.remark(format!(
        "Against a light map the lit table costs {:.2} × the time (paper: 16 against 15.5 frames a second). Per-pixel shading, which \
         the paper's board could not do, takes {:.2} × the time of the table under one light; under sixteen its frame takes \
         {:.1} × as long as under one, the table's {:.1} ×. The dense mesh, at least eight times slower in the paper, takes {:.1} × the time of \
         the table here: triangles of a few pixels are what a processor's renderer is worst at, but not so bad as the paper's board.",
        of("table") / of("static"),
        of("exact") / of("table"),
        grown(|s| s.exact),
        grown(|s| s.frame),
        of("dense") / of("table")
    ));
}
