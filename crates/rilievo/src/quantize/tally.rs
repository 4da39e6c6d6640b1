//! Counting the normals of a map that passes by once.
//!
//! Colours of 24 bits are counted exactly, one counter for each there may be (64 MiB). Everything else, and
//! colours with materials, is counted in cells of a grid on the sphere, each with the sum of its normals: the finest
//! grid, of 1.5 thousandths of a degree, as long as no more than [`MOST_CELLS`] are used, and a coarser one from then
//! on. What is joined then lies far closer together than entries of a table do.

use std::collections::HashMap;

use super::octahedral::{MORTON_CODE_BITS, morton};
use super::points::{Points, of_counted_colors};
use super::rows::{Band, BandTexels};
use crate::Space;
use crate::normal::{Bare, decode_u8};

/// Colours of 24 bits.
const COLORS: usize = 1 << 24;
/// Cells in use at most; a hundred for each entry of the largest table. They take some 250 MB.
const MOST_CELLS: usize = 1 << 22;

/// Normals seen so far.
#[derive(Debug)]
pub(super) struct Tally {
    /// Texels of each 24-bit colour without a material; empty if there are none.
    colors: Vec<u32>,
    /// By material and Morton code: sum of the normals, and how many.
    cells: HashMap<u64, ([f64; 3], u32)>,
    most_cells: usize,
    /// How often the grid's cells were joined by four.
    coarseness: u32,
}

/// What the map has.
pub(super) struct Counted {
    pub points: Points,
    /// If there are only colours without materials: the colours and the point of each.
    pub colors: Option<(Vec<[u8; 3]>, Vec<u32>)>,
}

/// A colour's place among all.
pub(super) fn code([r, g, b]: [u8; 3]) -> usize {
    usize::from(r) << 16 | usize::from(g) << 8 | usize::from(b)
}

fn color(code: usize) -> [u8; 3] {
    [(code >> 16) as u8, (code >> 8) as u8, code as u8]
}

impl Tally {
    pub(super) fn new() -> Self {
        Self { colors: Vec::new(), cells: HashMap::new(), most_cells: MOST_CELLS, coarseness: 0 }
    }

    /// Counts the covered texels of some rows.
    pub(super) fn add<S: Space>(&mut self, band: &Band<'_, S>) {
        let covered = (0..band.texels.count()).filter(|&i| band.is_covered(i));
        match (band.texels, band.materials) {
            (BandTexels::Rgb8(codes), None) => {
                self.colors.resize(COLORS, 0);
                covered.for_each(|i| self.colors[code(codes[i])] += 1);
            }
            (BandTexels::Rgb8(codes), Some(materials)) => {
                covered.for_each(|i| self.add_normal(decode_u8(codes[i]), materials[i], 1));
            }
            (BandTexels::Normals(normals), materials) => {
                covered.for_each(|i| self.add_normal(normals[i].relabel(), materials.map_or(0, |m| m[i]), 1));
            }
        }
    }

    fn add_normal(&mut self, normal: Bare, material: u8, count: u32) {
        let direction = normal.vec().to_array();
        let key = u64::from(material) << MORTON_CODE_BITS | morton(direction);
        let cell = self.cells.entry(key >> (2 * self.coarseness)).or_default();
        cell.0 = [0, 1, 2].map(|k| cell.0[k] + f64::from(direction[k]) * f64::from(count));
        cell.1 += count;
        while self.cells.len() > self.most_cells {
            self.join();
        }
    }

    /// Joins cells by four.
    fn join(&mut self) {
        // In order: the sums are the same in every run.
        let mut cells: Vec<_> = std::mem::take(&mut self.cells).into_iter().collect();
        cells.sort_unstable_by_key(|c| c.0);
        for (key, (sum, count)) in cells {
            let cell = self.cells.entry(key >> 2).or_default();
            cell.0 = [0, 1, 2].map(|k| cell.0[k] + sum[k]);
            cell.1 += count;
        }
        self.coarseness += 1;
    }

    /// The points that stand for what was counted.
    pub(super) fn finish(mut self) -> Counted {
        let colors = std::mem::take(&mut self.colors);
        let distinct: Vec<usize> = (0..colors.len()).filter(|&code| colors[code] > 0).collect();
        if self.cells.is_empty() {
            let counts: Vec<u32> = distinct.iter().map(|&code| colors[code]).collect();
            let distinct: Vec<[u8; 3]> = distinct.into_iter().map(color).collect();
            let (points, point_of) = of_counted_colors(&distinct, &counts);
            return Counted { points, colors: Some((distinct, point_of)) };
        }
        for code in distinct {
            self.add_normal(decode_u8(color(code)), 0, colors[code]);
        }
        let bits = MORTON_CODE_BITS - 2 * self.coarseness;
        let mean = |(key, (sum, count)): (u64, ([f64; 3], u32))| {
            ((key >> bits) as u8, sum.map(|c| (c / f64::from(count)) as f32), count)
        };
        Counted { points: Points::sorted(self.cells.into_iter().map(mean)), colors: None }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::scattered;
    use super::*;
    use crate::{Normal, Object};
    use glam::Vec3;

    #[test]
    fn joined_cells_keep_weight_and_mean_and_few_normals_stay_what_they_are() {
        let points = scattered(5000, 1);
        let normals: Vec<Normal<Object>> =
            (0..points.len()).map(|i| Normal::new(Vec3::from_array(points.at(i))).unwrap()).collect();
        let materials: Vec<u8> = (0..points.len()).map(|i| [3, 9][i % 2]).collect();
        for most_cells in [10_000, 700, 40] {
            let mut tally = Tally { most_cells, ..Tally::new() };
            let texels = BandTexels::Normals(&normals);
            tally.add(&Band { texels, covered: None, materials: Some(&materials) });
            let Counted { points: found, colors } = tally.finish();
            assert!(colors.is_none() && found.len() <= most_cells && found.groups.len() == 2);
            for group in &found.groups {
                let (mut sum, mut expected) = ([0.0; 4], [0.0; 4]);
                for i in group.points.clone() {
                    let [x, y, z] = found.at(i).map(f64::from);
                    let weight = f64::from(found.weight[i]);
                    sum = [sum[0] + x * weight, sum[1] + y * weight, sum[2] + z * weight, sum[3] + weight];
                }
                for (n, _) in normals.iter().zip(&materials).filter(|(_, m)| **m == group.material) {
                    let [x, y, z] = n.vec().to_array().map(f64::from);
                    expected = [expected[0] + x, expected[1] + y, expected[2] + z, expected[3] + 1.0];
                }
                assert!((0..4).all(|k| (sum[k] - expected[k]).abs() < 1e-3), "{most_cells}: {sum:?} {expected:?}");
            }
        }
        let few: Vec<Normal<Object>> = (0..1000).map(|i| normals[i % 7 * 4]).collect();
        let mut tally = Tally::new();
        tally.add(&Band { texels: BandTexels::Normals(&few), covered: None, materials: None });
        let found = tally.finish().points;
        assert_eq!(found.len(), 7);
        assert!((0..7).all(|i| few.iter().any(|n| n.vec().to_array() == found.at(i))));
    }
}
