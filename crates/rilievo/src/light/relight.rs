//! The flat map under new light.

use crate::color::{LinearRgb, Picture, Rgba8};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::indexed::QuantizedMap;
use crate::light::{Blend, ShadeTable};
use crate::normal::Space;

/// The full-size map coloured by look-up: one table entry per texel, no filtering.
///
/// With `base`, an sRGB picture of the map's size, its colour meets the light as `blend` says and keeps its alpha.
///
/// # Errors
/// [`Error::Length`] if `table` was not made from the map's own table, [`Error::SizeMismatch`] if `base` has another
/// size.
pub fn relight<S: Space>(
    map: &QuantizedMap<S>,
    table: &ShadeTable,
    base: Option<&Picture>,
    blend: Blend,
) -> Result<Picture> {
    let (expected, actual) = (map.table().len(), table.entries().len());
    if expected != actual {
        return Err(Error::Length { what: "entries of the shade table", expected, actual });
    }
    let Some(base) = base else {
        let colors: Vec<Rgba8> = table.to_srgb();
        return Ok(map.base().map(|&i| colors[usize::from(i)]));
    };
    map.base().expect_same_size("the base colour", base)?;
    let tinted = map.base().texels().iter().zip(base.texels()).map(|(&i, &color)| {
        let light = table.entries()[usize::from(i)].over(LinearRgb::from_srgb(color.rgb()), blend);
        Rgba8 { a: color.a, ..light.to_srgb() }
    });
    Grid::new(base.width(), base.height(), tinted.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indexed::NormalTable;
    use crate::light::{Light, Lighting, Material};
    use crate::mip::MipChain;
    use crate::normal::{Normal, Tangent};
    use glam::Vec3;

    #[test]
    fn texels_show_their_entry_and_tint_their_base() {
        let left = Normal::<Tangent>::new(Vec3::new(-0.6, 0.0, 0.8)).unwrap();
        let table = NormalTable::new(vec![left, Normal::Z]).unwrap();
        let indices = MipChain::single(Grid::new(2, 1, vec![1, 0]).unwrap());
        let map = QuantizedMap::new(table, indices).unwrap();
        let lighting = Lighting::new(LinearRgb::BLACK, vec![Light::directional(left, LinearRgb::WHITE)]);
        let materials = [Material::MATTE_WHITE];
        let shades = ShadeTable::new(map.table(), &materials, &lighting, Normal::Z, Vec3::ZERO).unwrap();
        let relight = |base| relight(&map, &shades, base, Blend::Add);
        let plain = relight(None).unwrap();
        assert_eq!(plain.texels(), [LinearRgb::gray(0.8 * 0.8).to_srgb(), LinearRgb::gray(0.8).to_srgb()]);
        let base = Grid::filled(2, 1, Rgba8::new(255, 0, 0, 7)).unwrap();
        let red = relight(Some(&base)).unwrap();
        assert_eq!(red.texels()[1], Rgba8 { g: 0, b: 0, a: 7, ..plain.texels()[1] });
        assert!(relight(Some(&Grid::filled(1, 1, Rgba8::default()).unwrap())).is_err());
    }
}
