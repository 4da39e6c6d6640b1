//! The shade table: the one thing that is lit each frame.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u32x16};
use glam::Vec3;

use crate::color::{LinearRgb, Rgba8};
use crate::error::{Error, Result};
use crate::indexed::NormalTable;
use crate::light::scalar::luminance;
use crate::light::{Blend, Lighting, Material, Prepared, Shade};
use crate::normal::{Normal, Space};
use crate::simd::{LANES, gather, splat3, srgb_pixel, three, two};

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
        let mut entries = vec![Shade::default(); table.len()];
        for (at, span) in table.spans().iter().enumerate() {
            let index = usize::from(span.material);
            let material = materials.get(index).ok_or(Error::IndexRange {
                what: "material of table span",
                at,
                index: index as u64,
                len: materials.len(),
            })?;
            let range = span.entries.start as usize..span.entries.end as usize;
            let prepared = Prepared::new(material, lighting);
            let (normals, shades) = (&table.normals()[range.clone()], &mut entries[range]);
            dispatch!(Level::new(), simd => light_span(simd, &prepared, normals, view, shades));
        }
        Ok(Self { entries })
    }

    /// The colours of a white surface, encoded: what a palette holds.
    ///
    /// - **Determinism:** class C: a colour within 0.06 codes of the border between two may be either.
    pub fn to_srgb(&self, blend: Blend) -> Vec<Rgba8> {
        let mut colors = vec![Rgba8::default(); self.entries.len()];
        dispatch!(Level::new(), simd => encode(simd, &self.entries, blend, &mut colors));
        colors
    }

    /// Entries of the kind *colour*: what is shown as it is, in linear light (Tarini et al. 2000, § 5.1 and § 7.3): the colours of
    /// a white surface.
    pub fn colors(&self, blend: Blend) -> impl ExactSizeIterator<Item = LinearRgb> {
        self.entries.iter().map(move |s| s.over(LinearRgb::WHITE, blend))
    }

    /// Entries of the kind *intensity*: the brightness of the diffuse light, for the base colour to be multiplied by.
    pub fn intensities(&self) -> impl ExactSizeIterator<Item = f32> {
        self.entries.iter().map(|s| luminance(s.diffuse))
    }

    /// Entries of the kind *intensity and specular colour*: the three colours of the specular light with the intensity
    /// behind them, as eqs. (1) and (2) take them from an RGBA texture (Tarini et al. 2000, § 7.1).
    pub fn intensities_and_speculars(&self) -> impl ExactSizeIterator<Item = [f32; 4]> {
        self.entries.iter().map(|s| [s.specular.r, s.specular.g, s.specular.b, luminance(s.diffuse)])
    }

    /// The shades, in table order.
    pub fn entries(&self) -> &[Shade] {
        &self.entries
    }
}

/// Lights the entries of one material, sixteen at a time; the last ones share their lanes with repetitions.
#[inline(always)]
fn light_span<S: Simd, Sp: Space>(
    simd: S,
    material: &Prepared<Sp>,
    normals: &[Normal<Sp>],
    view: Normal<Sp>,
    shades: &mut [Shade],
) {
    let view = splat3(simd, view.vec().to_array());
    // Point lights were taken for directional ones.
    let nowhere = splat3(simd, [0.0; 3]);
    for (normals, shades) in normals.chunks(LANES).zip(shades.chunks_mut(LANES)) {
        let last = normals.len() - 1;
        let mut planes = [[0.0f32; LANES]; 3];
        for lane in 0..LANES {
            let n = normals[lane.min(last)].vec();
            (planes[0][lane], planes[1][lane], planes[2][lane]) = (n.x, n.y, n.z);
        }
        let n = three!(k => f32x16::simd_from(simd, planes[k]));
        let lit = material.shade(simd, n, view, nowhere);
        let mut out = [[0.0f32; LANES]; 6];
        for (plane, lanes) in out.iter_mut().zip(lit) {
            lanes.store_slice(plane);
        }
        for (lane, shade) in shades.iter_mut().enumerate() {
            let diffuse = LinearRgb::new(out[0][lane], out[1][lane], out[2][lane]);
            *shade = Shade { diffuse, specular: LinearRgb::new(out[3][lane], out[4][lane], out[5][lane]) };
        }
    }
}

/// Encodes the colours of a white surface, sixteen at a time.
#[inline(always)]
fn encode<S: Simd>(simd: S, entries: &[Shade], blend: Blend, colors: &mut [Rgba8]) {
    let components: &[u32] = bytemuck::cast_slice(entries);
    let white = f32x16::splat(simd, 1.0);
    let first = u32x16::from_fn(simd, |lane| lane as u32 * 6);
    for (i, colors) in colors.chunks_mut(LANES).enumerate() {
        let first = first + (i * LANES * 6) as u32;
        let light = three!(k => {
            let [diffuse, specular] =
                two!(i => gather(simd, components, first + (k + 3 * i) as u32).bitcast::<f32x16<S>>());
            blend.over(simd, diffuse, specular, white)
        });
        let mut words = [0; LANES];
        srgb_pixel(simd, light).store_array(&mut words);
        let bytes: &[Rgba8] = bytemuck::cast_slice(&words);
        colors.copy_from_slice(&bytes[..colors.len()]);
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
        assert_eq!(shades.colors(Blend::Material).collect::<Vec<_>>()[2], LinearRgb::new(1.0, 0.0, 0.0));
        assert!((shades.intensities().last().unwrap() - 0.2126).abs() < 1e-6);
        assert!(make(&materials[..2]).is_err());
    }
}
