//! Figures 3 to 8 of Hast et al.: coarse tori under interpolated light.

use anyhow::Result;
use rilievo::Progress;
use rilievo::raster::Method;

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};
use crate::reproduce::subjects::{METHODS, Shown, Torus, VIEWS, difference, flat_shaded, psnr_of_covered, shoot};

/// Cells each way: 512 and 288 triangles, in the order of the paper's figures.
const TORI: [u32; 2] = [16, 12];
/// Differences are shown so many times larger.
const GAIN: u8 = 8;

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let mut found = Findings::default();
    found.paper(
        "Figures 3 to 5 show a bumpy torus of 512 polygons by quadratic, linear and normalised interpolation of the rotated light \
         vectors, figures 6 to 8 one of 288. The highlight breaks up where vectors are linear; the other two are told to look \
         almost the same. Neither is compared with a picture that is right, and there are no figures for the error.",
    );
    found.here(
        "A torus under a relief of waves, Blinn-Phong with exponent 32, a lamp at the upper right of the eye. Each method is set \
         beside the exact picture: frame, light and half vector of every pixel, all normalised. Under each picture is its \
         difference from the exact one, eight times enlarged; under the exact one are the polygons themselves.",
    );
    kit.bars.begin("bumpy tori", (TORI.len() * VIEWS.len() * (METHODS.len() + 1)) as u64);
    let mut tables = Vec::new();
    for n in TORI {
        tables.push(one(kit, n, &mut found)?);
    }
    remark(&mut found, &tables);
    Ok(found)
}

/// PSNR by method and view.
type Psnr = [[f64; VIEWS.len()]; METHODS.len()];

fn one(kit: &Kit<'_>, n: u32, found: &mut Findings) -> Result<Psnr> {
    let torus = Torus::new(n, if kit.quick { 64 } else { 256 })?;
    let polygons = torus.mesh().triangles().len();
    let take = |method, view| -> Result<Shown> {
        let shown = shoot(&torus.scene(view)?, method, (kit.size, kit.size))?;
        kit.bars.advance(1);
        Ok(shown)
    };
    let mut psnr = Psnr::default();
    let mut shots = Shots::new(3);
    for (v, view) in VIEWS.into_iter().enumerate() {
        let exact = take(Method::Exact, view)?;
        if v == 0 {
            let flat = flat_shaded(torus.mesh())?;
            let bare = shoot(&torus.flat_scene(&flat, view)?, Method::Exact, (kit.size, kit.size))?;
            shots.add(Shot::new(&exact.picture, "exact", format!("and the {polygons} polygons"))?.over(&bare.picture)?);
        }
        for (m, way) in METHODS.iter().enumerate() {
            let shown = take(way.method(), view)?;
            psnr[m][v] = psnr_of_covered(&exact, &shown)?;
            found.figure(format!("{polygons}_{}_view_{}_psnr_db", way.key, v + 1), psnr[m][v]);
            if v == 0 {
                let figure = figure(n, m).map_or(String::new(), |f| format!("; the paper's figure {f}"));
                let caption = format!("{:.1} dB{figure}", psnr[m][v]);
                let apart = difference(&exact.picture, &shown.picture, GAIN)?;
                shots.add(Shot::new(&shown.picture, way.name, caption)?.over(&apart)?);
            }
        }
    }
    let mut columns = vec![Column::here("method")];
    columns.extend((1..=VIEWS.len()).map(|v| Column::here(format!("view {v}"))));
    let caption = format!(
        "{polygons} polygons: PSNR in dB against the exact picture, over the pixels the torus covers, at {0} × {0}.",
        2 * kit.size
    );
    let mut table = Table::new(caption, columns);
    for (way, psnr) in METHODS.iter().zip(psnr) {
        table.row(std::iter::once(way.name.to_owned()).chain(psnr.map(|p| format!("{p:.1}"))).collect());
    }
    found.show(table);
    found.show(shots);
    Ok(psnr)
}

/// The paper's figure of method number `m` of the table on this torus.
fn figure(n: u32, m: usize) -> Option<u32> {
    match (n, m) {
        (16, 0) => Some(4),
        (16, 1) => Some(5),
        (16, 2) => Some(3),
        (12, 0) => Some(6),
        (12, 1) => Some(8),
        (12, 2) => Some(7),
        _ => None,
    }
}

fn remark(found: &mut Findings, tables: &[Psnr]) {
    let range = |m: usize, t: usize| {
        let all = tables[t][m];
        let low = all.into_iter().fold(f64::INFINITY, f64::min);
        let high = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        format!("{low:.1}–{high:.1}")
    };
    let mean = |m: usize| tables[1][m].iter().sum::<f64>() / VIEWS.len() as f64;
    let ahead = mean(2) - mean(1);
    let verdict = if ahead.abs() < 3.0 { "its eye is right" } else { "it is more than its eye tells" };
    found.remark(format!(
        "Linear vectors lose the highlight as the paper shows. With 288 polygons quadratic interpolation through new frames reaches {} dB \
         and normalised vectors {} dB. The paper finds the two almost the same: with {ahead:+.1} dB on average {verdict}.",
        range(2, 1),
        range(1, 1)
    ));
    found.remark(format!(
        "What is left of the error with new frames is not the polynomial's: the mean of two tangents is not orthogonal to the mean of their \
         normals. Made orthogonal at the midpoints, which the paper does not do, the same method reaches {} dB at about the same cost. The \
         paper's second way, averaged vectors, is as good as normalising ({} dB): its vectors are nearest to unit length, but their \
         direction misses how the surface turns between the corners.",
        range(4, 1),
        range(3, 1)
    ));
}
