//! The models of bump units that are drawn with: pairs of inner products a second, against the same products in floating point.

use anyhow::Result;
use rilievo::polar::{Frame, Model, Sample, UnitKind, Width};

use crate::harness::duel;
use crate::report::{Case, Report, Unit};

/// Pixels of a sample; their words fit the second cache.
const PIXELS: usize = 1 << 14;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    for kind in [UnitKind::Published, UnitKind::E1, UnitKind::E2, UnitKind::E3, UnitKind::E4, UnitKind::E4d] {
        let model = Model::new(kind, Width::PAPER, Frame::default());
        let samples: Vec<Sample> = Sample::random(1).take(PIXELS).collect();
        let words: Vec<u16> = samples.iter().flat_map(|sample| sample.words(kind)).collect();
        let mut out = vec![[0; 2]; PIXELS];
        let ours = || {
            model.products_of(&words, &mut out);
            Ok(out.iter().fold(0i64, |sum, pair| sum + i64::from(pair[0]) + i64::from(pair[1])))
        };
        let peer = || Ok(samples.iter().map(in_floats).fold(0.0, |sum, [a, b]| sum + a + b));
        let found = duel(rounds, ours, peer)?;
        let note = format!(
            "{:.1} million pairs of products a second; peer rotates in f32, sines by the system's library",
            PIXELS as f64 / found.ours / 1e6
        );
        let name = format!("polar/{kind}");
        report.add(&Case { note, ..Case::new(name, Unit::Seconds, found.ours, Some(found.peer)) })?;
    }
    Ok(())
}

/// `N'·L'` and `N'·H'` of a pixel by the rotation itself.
fn in_floats(sample: &Sample) -> [f32; 2] {
    let angle = |word: u16| f32::from(word) * (std::f32::consts::TAU / 65_536.0);
    let (sin_n, cos_n) = angle(sample.normal.polar).sin_cos();
    let (sin_phi, cos_phi) = angle(sample.bump.azimuth).sin_cos();
    let (sin_b, cos_b) = angle(sample.bump.polar).sin_cos();
    [sample.light, sample.half].map(|vector| {
        let (sin_d, cos_d) = angle(vector.azimuth.wrapping_sub(sample.normal.azimuth)).sin_cos();
        let (sin, cos) = angle(vector.polar).sin_cos();
        let (x, y) = (sin * cos_d, sin * sin_d);
        (x * cos_n - cos * sin_n) * sin_b * cos_phi + y * sin_b * sin_phi + (x * sin_n + cos * cos_n) * cos_b
    })
}
