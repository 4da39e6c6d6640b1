//! The smaller levels of a normal map.
//!
//! Normals of one material are averaged, materials are voted for, and gutter counts only where there is nothing else.
//! The quantiser takes its levels from here too, so index maps and normal maps agree on what a level should show.

use crate::error::Result;
use crate::grid::Grid;
use crate::indexed::MaterialMap;
use crate::mip::{MipChain, next_size, span};
use crate::normal::{Normal, NormalMap, Space};
use crate::par;

/// A normal map with its mip levels, and the materials of the same levels.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalLevels<S> {
    /// The normals, largest level first.
    pub normals: MipChain<Normal<S>>,
    /// The materials, if there are any.
    pub materials: Option<MipChain<u8>>,
}

/// One texel of a level.
#[derive(Debug, Clone, Copy)]
struct Texel<S> {
    /// Sum of the full-size normals it stands for, of its material only: not normalised between levels, so that each
    /// level is the mean of the map and not of the level above.
    sum: [f32; 3],
    /// Its direction.
    normal: Normal<S>,
    material: u8,
    covered: bool,
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
    let at = |x, y| {
        let normal = map[(x, y)];
        let material = materials.as_ref().map_or(0, |m| m[(x, y)]);
        Texel { sum: normal.vec().to_array(), normal, material, covered: covered.is_none_or(|c| c[(x, y)]) }
    };
    let mut smaller = halved(map.size(), at)?;
    let (mut normal_maps, mut material_maps) = (Vec::new(), Vec::new());
    while let Some(level) = smaller {
        normal_maps.push(level.map(|t| t.normal));
        material_maps.push(level.map(|t| t.material));
        smaller = halved(level.size(), |x, y| level[(x, y)])?;
    }
    normal_maps.insert(0, map);
    let materials = materials.map(|base| {
        material_maps.insert(0, base);
        MipChain::from_levels(material_maps)
    });
    Ok(NormalLevels { normals: MipChain::from_levels(normal_maps)?, materials: materials.transpose()? })
}

/// The level after one of size `above` whose texels are `at(x, y)`; `None` after 1 × 1.
fn halved<S: Space>(above: (u32, u32), at: impl Fn(u32, u32) -> Texel<S> + Sync) -> Result<Option<Grid<Texel<S>>>> {
    let Some((width, height)) = next_size(above) else { return Ok(None) };
    let empty = Texel { sum: [0.0; 3], normal: Normal::Z, material: 0, covered: false };
    let mut level = Grid::filled(width, height, empty)?;
    par::for_each_row(level.texels_mut(), width as usize, |y, row| {
        let mut block = Vec::with_capacity(9);
        for (x, texel) in row.iter_mut().enumerate() {
            block.clear();
            for sy in span(y as u32, above.1) {
                block.extend(span(x as u32, above.0).map(|sx| at(sx, sy)));
            }
            *texel = reduce(&block);
        }
    });
    Ok(Some(level))
}

/// One texel from the block above it, which has at least one.
fn reduce<S: Space>(block: &[Texel<S>]) -> Texel<S> {
    let covered = block.iter().any(|t| t.covered);
    let counted = || block.iter().filter(|t| t.covered == covered);
    let votes = |material: u8| counted().filter(|t| t.material == material).count();
    let winner = counted().map(|t| (votes(t.material), std::cmp::Reverse(t.material))).max();
    let material = winner.map_or(0, |(_, std::cmp::Reverse(material))| material);
    let members = || counted().filter(|t| t.material == material);
    let sum = members().fold([0.0f32; 3], |a, t| [0, 1, 2].map(|k| a[k] + t.sum[k]));
    // Opposite normals may leave no direction: then the first texel of the block speaks for it.
    let first = members().next().unwrap_or(&block[0]).normal;
    let length = sum.iter().map(|c| c * c).sum::<f32>().sqrt();
    let normal = if length > 1e-6 { Normal::new_or(sum.into(), first) } else { first };
    Texel { sum, normal, material, covered }
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
    fn opposites_leave_the_first_and_sizes_must_agree() {
        let map = Grid::new(2, 1, vec![Normal::<Object>::X, normal(-1.0, 0.0, 0.0)]).unwrap();
        assert_eq!(normal_levels(map.clone(), None, None).unwrap().normals.level(1)[(0, 0)], Normal::X);
        assert!(normal_levels(map, Some(Grid::filled(1, 1, 0).unwrap()), None).is_err());
    }
}
