//! Figure 4 of Tarini et al.: few normals, dithered.

use anyhow::Result;
use glam::Vec3;
use rilievo::light::Material;
use rilievo::quantize::Dither;
use rilievo::raster::{Detail, Method};
use rilievo::{Edges, Grid, LinearRgb, NormalMap, Object as ObjectSpace, Progress};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};
use crate::reproduce::subjects::{Cover, Vase, crop, psnr_of_covered, shoot};

const ENTRIES: [u32; 2] = [64, 256];
const METHODS: [(Dither, &str, &str); 3] = [
    (Dither::None, "nearest entry", "none"),
    (Dither::Diffusion, "error diffusion", "diffusion"),
    (Dither::BlueNoise, "blue noise", "blue_noise"),
];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let vase = kit.vase()?;
    let materials = [Material::blinn_phong(LinearRgb::gray(0.7), LinearRgb::gray(0.12), 12.0)];
    let size = Vase::picture_size(kit.size);
    let take = |detail: Detail<'_>, method| {
        shoot(&vase.scene(detail, &materials, Cover::None, Vase::one_light(), 0.75)?, method, size)
    };
    kit.bars.begin("dithered tables", (ENTRIES.len() * METHODS.len()) as u64 + 1);
    let exact = take(vase.exact(), Method::Exact)?;
    let covered = &vase.bent().covered;
    let meant = low_pass(&vase.bent().normals, covered)?;
    kit.bars.advance(1);

    let mut found = Findings::default();
    found.paper("The bunny with 256 normals, as it is and with its normal map dithered by a program for pictures: the facets are gone.");
    found.here(
        "The vase in light gray with a soft highlight, with 64 and 256 normals. Errors are diffused, or entries drawn by a mask of blue noise, \
         on the sphere and not in the cube of colours. The low-pass is a Gaussian of σ = 1 texel over the covered part of the map: what a \
         filter or an eye makes of neighbours. The shoulder of the vase is shown enlarged.",
    );
    let mut table = Table::new(
        "Error of single texels, after the low-pass, and of the picture (against per-pixel shading, over the pixels the vase covers).",
        ["entries", "RMS, °", "RMS after low-pass, °", "PSNR, dB"].map(Column::here).to_vec(),
    );
    let mut shots = Shots::new(4);
    let mut shares = Vec::new();
    for entries in ENTRIES {
        let mut plain = f64::NAN;
        shots.add(shot(&exact.picture, "exact".to_owned(), "per-pixel shading, not quantised".to_owned())?);
        for (dither, name, key) in METHODS {
            let quantized = vase.quantized(entries, dither)?;
            let shown = take(Detail::Indexed(&quantized.map), Method::Table)?;
            let single = quantized.error.rms_rad.to_degrees();
            let low = rms_deg(&meant, &low_pass(&quantized.map.expand(), covered)?, covered);
            let psnr = psnr_of_covered(&exact, &shown)?;
            if dither == Dither::None {
                plain = low;
            } else {
                shares.push(low / plain);
            }
            found.figure(format!("{entries}_{key}_rms_deg"), single);
            found.figure(format!("{entries}_{key}_low_pass_rms_deg"), low);
            found.figure(format!("{entries}_{key}_psnr_db"), psnr);
            table.row(vec![
                format!("{entries}, {name}"),
                format!("{single:.2}"),
                format!("{low:.2}"),
                format!("{psnr:.1}"),
            ]);
            shots.add(shot(
                &shown.picture,
                format!("{entries} normals, {name}"),
                format!("{low:.2}° after the low-pass, {psnr:.1} dB"),
            )?);
            kit.bars.advance(1);
        }
    }
    found.show(table);
    found.show(shots);
    let share = |i: usize| shares.get(i).map_or(f64::NAN, |s| 100.0 * s);
    found.remark(format!(
        "As in the paper, facets turn into grain that filters away. Single texels are farther from what they should be, but after the low-pass the \
         error is {:.0} % (diffusion) and {:.0} % (blue noise) of that of the nearest entries with 64 normals, {:.0} % and {:.0} % with 256. Where the \
         map's own detail is as fine as its texels, less is gained than on a smooth surface.",
        share(0),
        share(1),
        share(2),
        share(3)
    ));
    Ok(found)
}

/// The whole picture over its shoulder, enlarged.
fn shot(picture: &rilievo::color::Picture, title: String, caption: String) -> Result<Shot> {
    let (width, height) = picture.size();
    let part = crop(picture, (width * 36 / 100, height * 30 / 100), ((width / 4).max(1), (width / 5).max(1)))?;
    Ok(Shot::new(picture, title, caption)?.over(&part)?.enlarged())
}

/// Weights of a Gaussian of σ = 1 texel, cut at 3.
fn weights() -> [f32; 7] {
    std::array::from_fn(|i| (-(i as f32 - 3.0).powi(2) / 2.0).exp())
}

/// Covered normals averaged with a Gaussian of σ = 1 texel, made unit length again; u wraps and v ends.
fn low_pass(map: &NormalMap<ObjectSpace>, covered: &Grid<bool>) -> Result<Grid<Vec3>> {
    let (weights, (w, h)) = (weights(), map.size());
    let counted = |x: u32, y: u32| if covered[(x, y)] { map[(x, y)].vec() } else { Vec3::ZERO };
    let near = |edges: Edges, at: u32, i: usize, len: u32| edges.resolve(i64::from(at) + i as i64 - 3, len);
    let rows = Grid::from_fn(w, h, |x, y| {
        weights.iter().enumerate().fold(Vec3::ZERO, |sum, (i, &wt)| sum + counted(near(Edges::Wrap, x, i, w), y) * wt)
    })?;
    Ok(Grid::from_fn(w, h, |x, y| {
        let sum = weights
            .iter()
            .enumerate()
            .fold(Vec3::ZERO, |sum, (i, &wt)| sum + rows[(x, near(Edges::Clamp, y, i, h))] * wt);
        sum.normalize_or_zero()
    })?)
}

/// Root-mean-square angle over the covered texels, in degrees.
fn rms_deg(a: &Grid<Vec3>, b: &Grid<Vec3>, covered: &Grid<bool>) -> f64 {
    let (mut sum, mut count) = (0.0, 0u64);
    for ((a, b), _) in a.texels().iter().zip(b.texels()).zip(covered.texels()).filter(|(_, covered)| **covered) {
        let chord = (a.as_dvec3() - b.as_dvec3()).length();
        sum += (2.0 * (chord / 2.0).min(1.0).asin()).powi(2);
        count += 1;
    }
    (sum / count.max(1) as f64).sqrt().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::Normal;

    #[test]
    fn the_low_pass_averages_covered_texels_only() {
        let tilted = Normal::new(Vec3::new(1.0, 0.0, 1.0)).unwrap();
        let map = Grid::from_fn(16, 16, |x, _| if x % 2 == 0 { tilted } else { Normal::Z }).unwrap();
        let everywhere = Grid::filled(16, 16, true).unwrap();
        let smooth = low_pass(&map, &everywhere).unwrap();
        // Half of each: about half of 45 degrees.
        let angle = smooth[(8, 8)].angle_between(Vec3::Z).to_degrees();
        assert!((angle - 22.5).abs() < 2.0, "{angle}");
        let columns = Grid::from_fn(16, 16, |x, _| x % 2 == 0).unwrap();
        let only_tilted = low_pass(&map, &columns).unwrap();
        assert!(only_tilted[(8, 8)].angle_between(tilted.vec()) < 1e-3);
        assert!(rms_deg(&smooth, &smooth, &everywhere) < 1e-6);
        assert!((rms_deg(&only_tilted, &Grid::filled(16, 16, Vec3::Z).unwrap(), &columns) - 45.0).abs() < 0.1);
    }
}
