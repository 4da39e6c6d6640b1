//! A map of 16 384 × 16 384 texels through the program, from file to file: memory, error, and time per texel beside those of
//! a small map of the same normals.

use crate::inputs::rough;
use crate::report::{Case, Report, Unit};
use anyhow::{Context, Result, ensure};
use png::{BitDepth, ColorType};
use rilievo::grid::Edges;
use rilievo::height::{Filter, HeightMap};
use rilievo::normal::encode_u8;
use rilievo::{Grid, Tangent, height::to_normals};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Side of the large map, in texels.
const LARGE: u32 = 16_384;
/// Side of the small one, which has one texel of every 16 × 16.
const SMALL: u32 = 1024;
/// Side of the relief that the large map repeats, turned about its normal by another angle each time.
const TILE: u32 = 2048;
/// What the large map may take, in bytes.
const MOST_MEMORY: f64 = 3.0 * (1u64 << 30) as f64;

/// What a run of the program took and told.
struct Run {
    seconds: f64,
    rms_deg: f64,
    peak_bytes: f64,
}

pub(crate) fn run(_rounds: usize, report: &mut Report) -> Result<()> {
    let program = std::env::current_exe()?.with_file_name("rilievo");
    if !program.is_file() || !Path::new("/proc/self/status").is_file() {
        report.remark("scale: needs /proc, and `cargo build --release --package rilievo-cli` first; left out");
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let map = Turned::new()?;
    for entries in [2048, 16_384] {
        let mut runs = Vec::new();
        for side in [SMALL, LARGE] {
            let input = folder.path().join(format!("{side}.png"));
            if !input.is_file() {
                report.remark(&format!("scale: writing a map of {side} × {side} texels"));
                map.write(side, &input)?;
            }
            runs.push(quantize(&program, &input, entries, &folder.path().join("out.ktx2"))?);
        }
        let [small, large] = &runs[..] else { unreachable!("two maps") };
        let texels = |side: u32| f64::from(side) * f64::from(side);
        let name = |what: &str| format!("scale/{entries}-{what}");
        let peak = Case::new(name("memory"), Unit::Bytes, large.peak_bytes, Some(MOST_MEMORY));
        report.add(&Case { target: Some(1.0), note: "peer is the limit".to_owned(), ..peak })?;
        let note = "peer is the map of 1024 × 1024".to_owned();
        let error = Case::new(name("rms"), Unit::Degrees, large.rms_deg, Some(small.rms_deg));
        report.add(&Case { note, ..error })?;
        let (ours, peer) = (large.seconds / texels(LARGE), small.seconds / texels(SMALL));
        let note = format!("a texel, with packing; {:.0} s in all, two threads at most", large.seconds);
        report.add(&Case { note, ..Case::new(name("time"), Unit::Seconds, ours, Some(peer)) })?;
    }
    Ok(())
}

/// Runs `rilievo quantize`, and watches its memory.
fn quantize(program: &Path, input: &Path, entries: u32, output: &Path) -> Result<Run> {
    let start = Instant::now();
    let mut child = Command::new(program)
        .args(["quantize", "--json", "--quiet", "-n", &entries.to_string(), "-o"])
        .args([output, input])
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| program.display().to_string())?;
    let status = format!("/proc/{}/status", child.id());
    let mut peak_bytes = 0.0f64;
    while child.try_wait()?.is_none() {
        let peak = std::fs::read_to_string(&status).ok().and_then(|s| high_water_mark(&s));
        peak_bytes = peak_bytes.max(peak.unwrap_or(0.0));
        std::thread::sleep(Duration::from_millis(20));
    }
    let seconds = start.elapsed().as_secs_f64();
    let output = child.wait_with_output()?;
    ensure!(output.status.success(), "{} fails on {}", program.display(), input.display());
    let told: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let rms_deg = told["rms_deg"].as_f64().context("the report has no rms_deg")?;
    Ok(Run { seconds, rms_deg, peak_bytes })
}

/// The most memory a process had, in bytes, from its `/proc` status.
fn high_water_mark(status: &str) -> Option<f64> {
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0)
}

/// A relief again and again, each time turned.
struct Turned {
    tiles: Vec<Grid<[u8; 3]>>,
}

impl Turned {
    fn new() -> Result<Self> {
        let normals = to_normals(&HeightMap::new(rough(TILE)?, 0.2)?, Filter::Plane4, Edges::Wrap);
        let turned = |i: u32| {
            let (sin, cos) = (f32::sin(i as f32 * 0.3), f32::cos(i as f32 * 0.3));
            normals.map(|n| {
                let [x, y, z] = n.vec().to_array();
                encode_u8(rilievo::Normal::<Tangent>::new_or([x * cos - y * sin, x * sin + y * cos, z].into(), *n))
            })
        };
        Ok(Self { tiles: (0..LARGE / TILE).map(turned).collect() })
    }

    /// Writes the map with so many texels a side.
    fn write(&self, side: u32, path: &Path) -> Result<()> {
        let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), side, side);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        let mut rows = writer.stream_writer()?;
        let step = LARGE / side;
        // One texel anywhere in each block of the large map: a regular choice would hit the noise's lattice only.
        let mut random = testkit::Random::new(side.into());
        let mut any = |first: u32| first + (random.unit() * f64::from(step)) as u32;
        for y in (0..LARGE).step_by(step as usize) {
            let mut row = Vec::with_capacity(3 * side as usize);
            for x in (0..LARGE).step_by(step as usize) {
                let (x, y) = (any(x), any(y));
                let tile = &self.tiles[((x / TILE + y / TILE) % (LARGE / TILE)) as usize];
                row.extend(tile[(x % TILE, y % TILE)]);
            }
            rows.write_all(&row)?;
        }
        rows.finish()?;
        Ok(writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_from_the_status() {
        assert_eq!(high_water_mark("Name:\tx\nVmPeak:\t 99 kB\nVmHWM:\t  12 kB\n"), Some(12_288.0));
        assert_eq!(high_water_mark("Name:\tx\n"), None);
    }
}
