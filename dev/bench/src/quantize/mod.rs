//! The quantiser: its error against the best there can be, its time and error against other quantisers.

mod peers;

use crate::harness::{duel_with_program, once};
use crate::report::{Case, Report, Unit};
use anyhow::{Context, Result};
use peers::{Files, PEERS, Peer};
use rilievo::measure::angle_stats;
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, Texels, fejes_toth_rms_rad, quantize};
use rilievo::{Convention, Grid, NormalMap, Object};
use rilievo_io::{Limits, Source, decode_normals};

/// The three sizes of a table in Tarini et al. 2000 and in everything compared with it.
const ENTRIES: [u32; 3] = [256, 2048, 16_384];
/// What the error may be at most, over the bound.
const TARGET: f64 = 1.008;
/// The same for the highest effort, 256 entries.
const BEST_TARGET: f64 = 1.005;
/// A map of a real scan, in object space.
const REAL_MAP: &str = "normal/bunny_object_1536x1024.png";
/// What the RMS error on it should be at most, in degrees, for [`ENTRIES`] and with the highest effort for the first.
const REAL_TARGETS: [f64; 3] = [4.25, 1.385, 0.420];
const REAL_BEST_TARGET: f64 = 4.20;
/// How many times faster than netpbm the fast effort should be, for [`ENTRIES`].
const NETPBM_TARGETS: [f64; 3] = [15.0, 60.0, 120.0];
/// How many times faster than pngquant, and how its error should compare.
const PNGQUANT_TARGETS: (f64, f64) = (4.0, 0.95);
/// The error of the fast effort over that of the normal one.
const FAST_TARGET: f64 = 1.02;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let sphere: NormalMap<Object> = Grid::new(1000, 1000, testkit::uniform_sphere(1_000_000, 1))?;
    for entries in ENTRIES {
        let bound = fejes_toth_rms_rad(entries).to_degrees();
        let (rms, case) = measure(&format!("quantize/sphere-{entries}"), (&sphere).into(), entries, Effort::Normal)?;
        let note = match 1_000_000 / entries {
            0..100 => "against the Fejes Tóth bound; so few samples an entry that the table fits these, not the sphere",
            _ => "against the Fejes Tóth bound",
        };
        let with_bound = Case { target: Some(TARGET), note: note.to_owned(), peer: Some(bound), ours: rms, ..case };
        report.add(&with_bound)?;
    }
    let (_, best) = measure("quantize/sphere-256-best", (&sphere).into(), ENTRIES[0], Effort::Best)?;
    let bound = fejes_toth_rms_rad(ENTRIES[0]).to_degrees();
    report.add(&Case { target: Some(BEST_TARGET), peer: Some(bound), note: "against the bound".to_owned(), ..best })?;
    let Some(folder) = testkit::shared_data() else { return Ok(()) };
    let path = folder.join(REAL_MAP);
    let limits = Limits::default();
    let real = decode_normals::<Object>(&Source::open(&path, &limits)?, Convention::Gl, &limits)?;
    let codes = real.colors.as_ref().context("the real map is no longer one of 24-bit colours")?;
    let mut normal_rms = Vec::new();
    for (entries, target) in ENTRIES.into_iter().zip(REAL_TARGETS) {
        let (rms, case) = measure(&format!("quantize/bunny-{entries}"), real.texels(), entries, Effort::Normal)?;
        normal_rms.push(rms);
        let note = format!("peer is the target, {target}°");
        report.add(&Case { peer: Some(target), target: Some(1.0), note, ..case })?;
    }
    let (_, best) = measure("quantize/bunny-256-best", real.texels(), ENTRIES[0], Effort::Best)?;
    let note = format!("peer is the target, {REAL_BEST_TARGET}°");
    report.add(&Case { peer: Some(REAL_BEST_TARGET), target: Some(1.0), note, ..best })?;
    let mut fast_rms = Vec::new();
    for (entries, normal) in ENTRIES.into_iter().zip(normal_rms) {
        let (rms, case) = measure(&format!("quantize/bunny-{entries}-fast"), real.texels(), entries, Effort::Fast)?;
        fast_rms.push(rms);
        let note = "peer is the normal effort".to_owned();
        report.add(&Case { peer: Some(normal), target: Some(FAST_TARGET), note, ..case })?;
    }
    against_peers(rounds, report, &real.normals, codes, &fast_rms, &path)
}

/// Times the fast effort on the decoded map against whole processes, in turns, and compares errors.
fn against_peers(
    rounds: usize,
    report: &mut Report,
    real: &NormalMap<Object>,
    codes: &Grid<[u8; 3]>,
    fast_rms: &[f64],
    png: &std::path::Path,
) -> Result<()> {
    let files = Files::new(codes)?;
    Peer::give_png(&files, png)?;
    for peer in &PEERS {
        if !peer.is_installed() {
            report.remark(&format!("{} is not here ({}): left out", peer.name, peer.install));
            continue;
        }
        for (i, entries) in ENTRIES.into_iter().enumerate().filter(|&(_, entries)| entries <= peer.most) {
            let options = Options { entries, effort: Effort::Fast, ..Options::default() };
            let ours = || Ok(quantize::<Object>(codes, &options, &Silent)?);
            // The slow ones are slow enough for their median to settle early.
            let rounds = if entries > 256 { rounds.min(3) } else { rounds };
            let times = duel_with_program(rounds, ours, || peer.run(&files, entries))?;
            let found = angle_stats(real, &peer.result(&files, real.size())?, None)?.rms_rad.to_degrees();
            let (faster, closer) = match peer.name {
                "netpbm" => (Some(NETPBM_TARGETS[i]), None),
                "pngquant" => (Some(PNGQUANT_TARGETS.0), Some(PNGQUANT_TARGETS.1)),
                _ => (None, None),
            };
            let name = |what: &str| format!("quantize/{}-{entries}-{what}", peer.name);
            let note = format!("{}; ours: fast, in memory", peer.note);
            let time = Case::new(name("time"), Unit::Seconds, times.ours, Some(times.peer));
            report.add(&Case { target: faster, note, ..time })?;
            let error = Case::new(name("rms"), Unit::Degrees, fast_rms[i], Some(found));
            report.add(&Case { target: closer, ..error })?;
        }
    }
    Ok(())
}

/// Errors are the same in every run, so each table is made once, whatever the number of rounds.
fn measure(name: &str, map: Texels<'_, Object>, entries: u32, effort: Effort) -> Result<(f64, Case)> {
    let options = Options { entries, effort, ..Options::default() };
    let (made, spent) = once(|| Ok(quantize(map, &options, &Silent)?))?;
    let rms = made.error.rms_rad.to_degrees();
    Ok((rms, Case { spent: Some(spent), ..Case::new(name, Unit::Degrees, rms, None) }))
}
