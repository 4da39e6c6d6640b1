//! The shade table: the one thing that is lit each frame.

use glam::Vec3;

use crate::color::{LinearRgb, Rgba8};
use crate::error::{Error, Result};
use crate::indexed::NormalTable;
use crate::light::{Blend, Lighting, Material, Shade, shade};
use crate::normal::{Normal, Space};

/// One [`Shade`] per entry of a [`NormalTable`].
///
/// Light and view directions are constant over the object: the one approximation of the method besides quantisation
/// (Tarini et al. 2000, § 9). Highlights of nearby eyes shift a little; diffuse light of distant lights is exact.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadeTable {
    entries: Vec<Shade>,
}

impl ShadeTable {
    /// Lights every entry of `table`.
    ///
    /// `lighting` and `view` (surface → eye) are in the table's own space; material `m` is `materials[m]`. Point lights
    /// count as directional, as seen from `middle`, the middle of the object.
    ///
    /// # Errors
    /// [`Error::IndexRange`] if the table names a material that is not there.
    pub fn new<S: Space>(
        table: &NormalTable<S>,
        materials: &[Material],
        lighting: &Lighting<S>,
        view: Normal<S>,
        middle: Vec3,
    ) -> Result<Self> {
        let lighting = &lighting.from_place(middle);
        let mut entries = Vec::with_capacity(table.len());
        for (at, span) in table.spans().iter().enumerate() {
            let index = usize::from(span.material);
            let material = materials.get(index).ok_or(Error::IndexRange {
                what: "material of table span",
                at,
                index: index as u64,
                len: materials.len(),
            })?;
            let normals = &table.normals()[span.entries.start as usize..span.entries.end as usize];
            entries.extend(normals.iter().map(|&n| shade(material, lighting, n, view, middle)));
        }
        Ok(Self { entries })
    }

    /// The colours of a white surface, encoded: what a palette holds.
    pub fn to_srgb(&self) -> Vec<Rgba8> {
        self.entries.iter().map(|s| s.over(LinearRgb::WHITE, Blend::Add).to_srgb()).collect()
    }

    /// The shades, in table order.
    pub fn entries(&self) -> &[Shade] {
        &self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indexed::MaterialSpan;
    use crate::light::Light;
    use crate::normal::Object;

    #[test]
    fn each_span_is_lit_with_its_material() {
        let spans = [(0, 0..1), (2, 1..3)].map(|(material, entries)| MaterialSpan { material, entries });
        let n = Normal::<Object>::new(Vec3::new(0.1, 0.2, 0.9)).unwrap();
        let table = NormalTable::with_materials(vec![n, n, Normal::Z], spans.to_vec()).unwrap();
        let red = Material::matte(LinearRgb::new(1.0, 0.0, 0.0));
        let lighting = Lighting::new(LinearRgb::BLACK, vec![Light::directional(Normal::Z, LinearRgb::WHITE)]);
        let materials = [Material::MATTE_WHITE, Material::MATTE_WHITE, red];
        let make = |m: &[Material]| ShadeTable::new(&table, m, &lighting, Normal::Z, Vec3::ZERO);
        let shades = make(&materials).unwrap();
        assert!(shades.entries()[0].diffuse.g > 0.0 && shades.entries()[1].diffuse.g == 0.0);
        assert_eq!(shades.entries()[2].diffuse, LinearRgb::new(1.0, 0.0, 0.0));
        assert!(make(&materials[..2]).is_err());
    }
}
