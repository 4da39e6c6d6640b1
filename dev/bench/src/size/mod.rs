//! What a normal map costs in bytes for what error: index maps beside what else normals are stored in.
//!
//! Nothing here is timed, so the figures are the same in every run; they and their plot go into `docs/`.

mod codecs;
mod page;
mod plot;

use crate::report::Report;
use anyhow::{Context, Result};
use codecs::Stored;
use plot::{Plot, Series, Side};
use rilievo::measure::angle_stats;
use rilievo::progress::Silent;
use rilievo::quantize::{Options, quantize};
use rilievo::{Convention, Grid, NormalMap, Object};
use rilievo_io::{Limits, Source, decode_normals};
use serde_json::json;

/// A map of a real scan, in object space.
const REAL_MAP: &str = "normal/bunny_object_1536x1024.png";
/// Sizes of the table.
const ENTRIES: [u32; 9] = [64, 128, 256, 512, 1024, 2048, 4096, 8192, 16_384];
/// The largest palette.
const PALETTE: u32 = 256;
/// Bits per component of octahedral maps.
const OCTAHEDRAL_BITS: [u32; 4] = [5, 6, 7, 8];

/// One way to store the map.
struct Row {
    family: &'static str,
    variant: String,
    bytes: usize,
    rms_deg: f64,
    max_deg: f64,
}

pub(crate) fn run(_rounds: usize, report: &mut Report) -> Result<()> {
    let Some(folder) = testkit::shared_data() else { return Ok(()) };
    let limits = Limits::default();
    let real = decode_normals::<Object>(&Source::open(&folder.join(REAL_MAP), &limits)?, Convention::Gl, &limits)?;
    let codes = real.colors.as_ref().context("the real map is no longer one of 24-bit colours")?;
    let rows = measure(&real.normals, codes, report)?;
    report.line(&format!(
        "{:<18} {:<12} {:>10} {:>9} {:>9} {:>9}",
        "stored as", "", "kB", "bits/txl", "RMS °", "max °"
    ))?;
    let texels = codes.texels().len() as f64;
    for row in &rows {
        let Row { family, variant, bytes, rms_deg, max_deg } = row;
        let (kilobytes, bits) = (*bytes as f64 * 1e-3, *bytes as f64 * 8.0 / texels);
        report.row(
            &json!({ "case": format!("size/{family}/{variant}"), "bytes": bytes, "rms_deg": rms_deg, "max_deg": max_deg }),
            &format!("{family:<18} {variant:<12} {kilobytes:>10.1} {bits:>9.3} {rms_deg:>9.4} {max_deg:>9.3}"),
        )?;
    }
    page::update(&rows, codes.texels().len())?;
    page::write_plot(&plot_of(&rows).to_svg())?;
    report.remark("docs/size-against-error.md and its plot are up to date");
    Ok(())
}

fn measure(normals: &NormalMap<Object>, codes: &Grid<[u8; 3]>, report: &Report) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let mut add = |family, variant: String, Stored { bytes, normals: stored }: Stored| -> Result<()> {
        report.remark(&format!("size: {family} {variant}"));
        let error = angle_stats(normals, &stored, None)?;
        let (rms_deg, max_deg) = (error.rms_rad.to_degrees(), error.max_rad.to_degrees());
        rows.push(Row { family, variant, bytes, rms_deg, max_deg });
        Ok(())
    };
    for entries in ENTRIES {
        let made = quantize::<Object>(codes, &Options { entries, ..Options::default() }, &Silent)?;
        let variant = format!("K = {entries}");
        let stored = |bytes: Vec<u8>| Stored { bytes: bytes.len(), normals: made.map.expand() };
        add(KTX2, variant.clone(), stored(rilievo_io::encode_ktx2(&made.map, Convention::Gl)?))?;
        if entries <= PALETTE {
            add(INDEXED_PNG, variant, stored(rilievo_io::encode_indexed_png(&made.map, Convention::Gl)?))?;
        }
    }
    for bits in OCTAHEDRAL_BITS {
        let map = codecs::octahedral(normals, bits)?;
        add(OCTAHEDRAL, format!("{bits} + {bits}"), codecs::packed(&map)?)?;
        add(OCTAHEDRAL_PNG, format!("{bits} + {bits}"), codecs::gray_alpha_png(&map)?)?;
    }
    for (name, settings) in codecs::bc7_settings() {
        add(BC7, name.to_owned(), codecs::bc7(codes, settings)?)?;
    }
    add(PNG24, AS_WRITTEN.to_owned(), codecs::png24(normals, codes)?)?;
    add(PNG24, "smallest".to_owned(), codecs::smallest_png24(normals, codes)?)?;
    Ok(rows)
}

const KTX2: &str = "index KTX2";
const INDEXED_PNG: &str = "indexed PNG";
const OCTAHEDRAL: &str = "octahedral, Zstd";
const OCTAHEDRAL_PNG: &str = "octahedral, PNG";
const BC7: &str = "BC7, Zstd";
const PNG24: &str = "PNG-24";
const AS_WRITTEN: &str = "as written";

/// Families as lines, single files as points. PNG-24 has no error against itself, so it stands on the lower edge.
fn plot_of(rows: &[Row]) -> Plot {
    let family = |name| Series {
        name,
        points: (rows.iter().filter(|r| r.family == name && r.variant != AS_WRITTEN))
            .map(|r| (r.bytes as f64 * 1e-3, r.rms_deg, r.variant.clone(), side(r)))
            .collect(),
    };
    Plot {
        x_label: "kB in the file",
        y_label: "RMS error in degrees",
        series: [KTX2, INDEXED_PNG, OCTAHEDRAL, OCTAHEDRAL_PNG, BC7, PNG24].map(family).into(),
    }
}

/// Where a label is out of the way of the other lines, which cross about 1°.
fn side(row: &Row) -> Side {
    match (row.family, row.rms_deg < 1.0) {
        (KTX2, true) | (INDEXED_PNG | OCTAHEDRAL, false) => Side::AboveRight,
        (KTX2, false) | (OCTAHEDRAL | OCTAHEDRAL_PNG, true) => Side::BelowLeft,
        (OCTAHEDRAL_PNG, false) => Side::BelowRight,
        _ => Side::Right,
    }
}
