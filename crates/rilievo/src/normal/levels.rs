//! The smaller levels of a normal map.
//!
//! Normals of one material are averaged, materials are voted for, and gutter counts only where there is nothing else.
//! The quantiser takes its levels from here too, so index maps and normal maps agree on what a level should show.

use crate::error::Result;
use crate::grid::Grid;
use crate::indexed::MaterialMap;
use crate::mip::{MipChain, next_size, span};
use crate::normal::{Bare, Normal, NormalMap, Space};
use crate::par;

/// A normal map with its mip levels, and the materials of the same levels.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalLevels<S> {
    /// The normals, largest level first.
    pub normals: MipChain<Normal<S>>,
    /// The materials, if there are any.
    pub materials: Option<MipChain<u8>>,
}

/// Rows that go into a [`Cascade`] together.
const BAND_ROWS: usize = 64;

/// One texel of a level.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Texel {
    /// Sum of the full-size normals it stands for, of its material only: not normalised between levels, so that each
    /// level is the mean of the map and not of the level above.
    sum: [f32; 3],
    /// Its direction.
    pub(crate) normal: Bare,
    pub(crate) material: u8,
    covered: bool,
}

impl Texel {
    /// A texel of the full-size map.
    pub(crate) fn new(normal: Bare, material: u8, covered: bool) -> Self {
        Self { sum: normal.vec().to_array(), normal, material, covered }
    }
}

/// Builds all levels of a normal map.
///
/// A texel takes the material that most of its block of the level above has (of equals, the lowest) and the mean of the
/// full-size normals with that material; texels that are not `covered` count only in blocks without covered ones.
///
/// - **Determinism:** class A.
/// - **Source:** Tarini et al. 2000, § 5.2, with the mean of the unquantised normals: averaging table entries adds one
///   quantisation error per level and costs the same.
///
/// # Errors
/// [`crate::Error::SizeMismatch`] if `materials` or `covered` have another size than `map`.
pub fn normal_levels<S: Space>(
    map: NormalMap<S>,
    materials: Option<MaterialMap>,
    covered: Option<&Grid<bool>>,
) -> Result<NormalLevels<S>> {
    materials.as_ref().map_or(Ok(()), |m| map.expect_same_size("the material map", m))?;
    covered.map_or(Ok(()), |c| map.expect_same_size("the coverage", c))?;
    let bare = Normal::relabel_all(map.texels());
    let found = smaller(map.size(), bare, materials.as_ref().map(Grid::texels), covered.map(Grid::texels));
    let (mut normal_maps, mut material_maps) = (vec![map], Vec::new());
    for Smaller { size: (width, height), normals, materials } in found {
        normal_maps.push(Grid::new(width, height, Normal::relabel_vec(normals))?);
        material_maps.push(Grid::new(width, height, materials)?);
    }
    let materials = materials.map(|base| {
        material_maps.insert(0, base);
        MipChain::from_levels(material_maps)
    });
    Ok(NormalLevels { normals: MipChain::from_levels(normal_maps)?, materials: materials.transpose()? })
}

/// A level below the largest.
struct Smaller {
    size: (u32, u32),
    normals: Vec<Bare>,
    materials: Vec<u8>,
}

/// The levels below the largest.
fn smaller(size: (u32, u32), texels: &[Bare], materials: Option<&[u8]>, covered: Option<&[bool]>) -> Vec<Smaller> {
    let mut cascade = Cascade::new(size);
    let empty = |size| Smaller { size, normals: Vec::new(), materials: Vec::new() };
    let mut found: Vec<Smaller> = cascade.sizes().into_iter().map(empty).collect();
    let rows = size.0 as usize * BAND_ROWS;
    for first in (0..texels.len()).step_by(rows) {
        let band = first..texels.len().min(first + rows);
        let texel = |t: usize| Texel::new(texels[t], materials.map_or(0, |m| m[t]), covered.is_none_or(|c| c[t]));
        cascade.push(band.map(texel), |level, texels| {
            let Smaller { normals, materials, .. } = &mut found[level];
            normals.extend(texels.iter().map(|t| t.normal));
            materials.extend(texels.iter().map(|t| t.material));
        });
    }
    found
}

/// All levels below a map whose rows come one after the other, from the top. A few rows of each level are kept.
#[derive(Debug)]
pub(crate) struct Cascade {
    steps: Vec<Halving>,
}

/// One level on its way to the next.
#[derive(Debug)]
struct Halving {
    /// Size of the level that comes in.
    above: (u32, u32),
    /// Size of the level that goes out.
    size: (u32, u32),
    /// Rows that came in and are not used up.
    pending: Vec<Texel>,
    /// The number of the first of them.
    first: u32,
    /// How many rows went out.
    done: u32,
}

impl Cascade {
    /// For a map of this size.
    pub(crate) fn new(size: (u32, u32)) -> Self {
        let mut steps = Vec::new();
        let mut above = size;
        while let Some(size) = next_size(above) {
            steps.push(Halving { above, size, pending: Vec::new(), first: 0, done: 0 });
            above = size;
        }
        Self { steps }
    }

    /// The sizes of the smaller levels, largest first.
    pub(crate) fn sizes(&self) -> Vec<(u32, u32)> {
        self.steps.iter().map(|s| s.size).collect()
    }

    /// Takes the next whole rows of the map, and hands on the rows of each smaller level that are known with them. The
    /// largest of the smaller levels is number 0.
    pub(crate) fn push(&mut self, rows: impl IntoIterator<Item = Texel>, mut emit: impl FnMut(usize, &[Texel])) {
        let Some(first) = self.steps.first_mut() else { return };
        first.pending.extend(rows);
        for level in 0..self.steps.len() {
            let rows = self.steps[level].advance();
            if rows.is_empty() {
                return;
            }
            emit(level, &rows);
            if let Some(next) = self.steps.get_mut(level + 1) {
                next.pending.extend(rows);
            }
        }
    }
}

impl Halving {
    /// The rows whose blocks are complete.
    fn advance(&mut self) -> Vec<Texel> {
        let ((above_width, above_height), (width, height)) = (self.above, self.size);
        let came = self.first + (self.pending.len() / above_width as usize) as u32;
        let ready = (self.done..height).take_while(|&y| span(y, above_height).end <= came).count();
        let mut rows = vec![Texel::new(Normal::Z, 0, false); ready * width as usize];
        par::for_each_row(&mut rows, width as usize, |row, texels| {
            let mut block = Vec::with_capacity(9);
            for (x, texel) in texels.iter_mut().enumerate() {
                block.clear();
                for y in span(self.done + row as u32, above_height) {
                    let start = (y - self.first) as usize * above_width as usize;
                    block.extend(span(x as u32, above_width).map(|x| self.pending[start + x as usize]));
                }
                *texel = reduce(&block);
            }
        });
        self.done += ready as u32;
        let used = if self.done == height { came } else { span(self.done, above_height).start };
        self.pending.drain(..(used - self.first) as usize * above_width as usize);
        self.first = used;
        rows
    }
}

/// One texel from the block above it, which has at least one.
fn reduce(block: &[Texel]) -> Texel {
    let first = block[0];
    // Almost everywhere there is nothing to vote on.
    if block.iter().all(|t| t.material == first.material && t.covered == first.covered) {
        return mean(block.iter(), first);
    }
    let covered = block.iter().any(|t| t.covered);
    let counted = || block.iter().filter(|t| t.covered == covered);
    let votes = |material: u8| counted().filter(|t| t.material == material).count();
    let winner = counted().map(|t| (votes(t.material), std::cmp::Reverse(t.material))).max();
    let material = winner.map_or(0, |(_, std::cmp::Reverse(material))| material);
    let members = || counted().filter(|t| t.material == material);
    mean(members(), *members().next().unwrap_or(&first))
}

/// The mean of texels of one material; `first` is the first of them.
fn mean<'a>(members: impl Iterator<Item = &'a Texel>, first: Texel) -> Texel {
    let sum = members.fold([0.0f32; 3], |a, t| [0, 1, 2].map(|k| a[k] + t.sum[k]));
    // Opposite normals may leave no direction: then the first texel of the block speaks for it.
    let length = sum.iter().map(|c| c * c).sum::<f32>().sqrt();
    let normal = if length > 1e-6 { Normal::new_or(sum.into(), first.normal) } else { first.normal };
    Texel { sum, normal, ..first }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::Object;
    use glam::Vec3;

    fn normal(x: f32, y: f32, z: f32) -> Normal<Object> {
        Normal::new(Vec3::new(x, y, z)).unwrap()
    }

    #[test]
    fn levels_are_means_of_the_map_not_of_the_level_above() {
        // Three texels one way and one the other in each block, then blocks of different agreement.
        let map =
            Grid::from_fn(4, 4, |x, y| if (x + 3 * y) % 5 < 2 { normal(1.0, 0.0, 0.2) } else { normal(0.0, 1.0, 0.3) });
        let map = map.unwrap();
        let mean = map.texels().iter().map(|n| n.vec()).sum::<Vec3>();
        let levels = normal_levels(map, None, None).unwrap();
        assert_eq!(levels.normals.levels().len(), 3);
        assert!(levels.materials.is_none());
        assert!(levels.normals.level(2)[(0, 0)].angle_to(Normal::new(mean).unwrap()) < 1e-6);
    }

    #[test]
    fn the_majority_decides_and_only_its_normals_count() {
        let map = Grid::new(2, 2, vec![Normal::X, Normal::X, Normal::Y, normal(0.0, 1.0, 1.0)]).unwrap();
        let level = |materials: [u8; 4]| {
            let materials = Grid::new(2, 2, materials.to_vec()).unwrap();
            let levels = normal_levels(map.clone(), Some(materials), None).unwrap();
            (levels.materials.unwrap().level(1)[(0, 0)], levels.normals.level(1)[(0, 0)])
        };
        assert_eq!(level([1, 3, 3, 3]).0, 3);
        assert_eq!(level([9, 9, 2, 2]), (2, Normal::new(Vec3::Y + normal(0.0, 1.0, 1.0).vec()).unwrap()));
    }

    #[test]
    fn gutter_counts_only_where_there_is_nothing_else() {
        let map = Grid::new(4, 1, vec![Normal::X, Normal::Y, Normal::Z, Normal::Y]).unwrap();
        let covered = Grid::new(4, 1, vec![true, false, false, false]).unwrap();
        let levels = normal_levels(map, None, Some(&covered)).unwrap();
        assert_eq!(levels.normals.level(1)[(0, 0)], Normal::X);
        assert!(levels.normals.level(1)[(1, 0)].angle_to(normal(0.0, 1.0, 1.0)) < 1e-6);
        assert_eq!(levels.normals.level(2)[(0, 0)], Normal::X);
    }

    #[test]
    fn rows_in_bands_of_any_height_give_the_levels_of_the_whole_map() {
        for (width, height) in [(1, 1), (7, 5), (1, 13), (16, 1), (3, 200), (33, 34)] {
            let texel = |x: u32, y: u32| {
                let v = normal(x as f32 - 3.0, (y * 7 % 11) as f32 - 5.0, 0.5);
                Texel::new(v, ((x + y) % 3) as u8, (x * 5 + y * 3) % 7 > 1)
            };
            let base = Grid::from_fn(width, height, texel).unwrap();
            let blocks = |block: &[&Texel]| reduce(&block.iter().map(|&&t| t).collect::<Vec<_>>());
            let expected = MipChain::build(base.clone(), blocks);
            for band in [1, 2, 3, 7, 64] {
                let mut cascade = Cascade::new((width, height));
                let mut found = vec![Vec::new(); cascade.sizes().len()];
                for rows in base.texels().chunks(band * width as usize) {
                    cascade.push(rows.iter().copied(), |level, texels| found[level].extend_from_slice(texels));
                }
                let parts = |t: &Texel| (t.sum, t.normal, t.material, t.covered);
                let all = |texels: &[Texel]| texels.iter().map(parts).collect::<Vec<_>>();
                assert_eq!(found.len() + 1, expected.levels().len());
                for (found, level) in found.iter().zip(&expected.levels()[1..]) {
                    assert_eq!(all(found), all(level.texels()), "{width}×{height} in bands of {band}");
                }
            }
        }
    }

    #[test]
    fn opposites_leave_the_first_and_sizes_must_agree() {
        let map = Grid::new(2, 1, vec![Normal::<Object>::X, normal(-1.0, 0.0, 0.0)]).unwrap();
        assert_eq!(normal_levels(map.clone(), None, None).unwrap().normals.level(1)[(0, 0)], Normal::X);
        assert!(normal_levels(map, Some(Grid::filled(1, 1, 0).unwrap()), None).is_err());
    }
}
