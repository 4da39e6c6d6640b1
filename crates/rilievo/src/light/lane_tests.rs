//! Sixteen lanes against the scalar definition.

use std::sync::Arc;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16};
use glam::{Quat, Vec3};

use super::tests::scattered;
use super::*;
use crate::color::LinearRgb;
use crate::grid::Grid;
use crate::indexed::{MaterialSpan, NormalTable};
use crate::normal::{Normal, Object};
use crate::simd::{LANES, levels};

const COLOR: LinearRgb = LinearRgb::new(0.9, 0.5, 0.2);

/// Every model, with the exponent that decides how far it may be off, and whether it jumps.
fn models() -> Vec<(LightingModel, f32, bool)> {
    let mut all = vec![
        (LightingModel::Ambient { color: COLOR }, 0.0, false),
        (LightingModel::Lambert { color: COLOR }, 0.0, false),
        (LightingModel::Steps { color: COLOR, steps: 5 }, 0.0, true),
        (LightingModel::Cartoon { bands: Bands::of(COLOR) }, 0.0, true),
        (LightingModel::Chrome { landscape: Landscape::default() }, 0.0, false),
    ];
    for shininess in [0.7f32, 1.0, 9.0, 40.0, 133.3] {
        all.push((LightingModel::Phong { color: COLOR, shininess }, shininess, false));
        all.push((LightingModel::BlinnPhong { color: COLOR, shininess }, shininess, false));
        all.push((LightingModel::DoubledAngle { color: COLOR, shininess }, 2.0 * shininess, false));
    }
    for roughness in [0.0f32, 0.1, 0.5, 0.8, 1.0] {
        all.push((LightingModel::Environment { color: COLOR, roughness }, 0.0, false));
        for metallic in [0.0, 0.3, 1.0] {
            let model = LightingModel::MetallicRoughness { base_color: COLOR, metallic, roughness };
            all.push((model, 8.0, false));
        }
    }
    all
}

/// Directional lights, near ones with and without falloff, and each kind of surroundings.
fn lightings() -> Vec<Lighting<Object>> {
    let lights = vec![
        Light::directional(scattered(3), LinearRgb::new(1.1, 1.0, 0.8)),
        Light::point(Vec3::new(-2.0, 1.0, 0.7), LinearRgb::new(0.2, 0.4, 0.9)),
        Light::Point { position: Vec3::new(0.9, 2.0, 1.4), color: LinearRgb::gray(0.6), reference_distance: Some(1.5) },
    ];
    let plain = Lighting::new(LinearRgb::new(0.1, 0.15, 0.2), lights);
    let wave = |x: u32, f: f32| (x as f32 * f).sin() * 0.5 + 0.5;
    let picture = Grid::from_fn(64, 32, |x, y| {
        LinearRgb::new(wave(x, std::f32::consts::TAU / 32.0), wave(y, 0.3), wave(x + y, std::f32::consts::TAU / 64.0))
    });
    let surroundings = |projection| {
        let environment = Environment::new(projection, picture.as_ref().unwrap()).unwrap();
        let to_sky = Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.4);
        Lighting { environment: Some(Arc::new(environment)), to_sky, ..plain.clone() }
    };
    let around = surroundings(Projection::Equirectangular);
    let matcap = surroundings(Projection::Matcap);
    vec![plain, around, matcap]
}

/// A place, an eye and a normal for each lane.
struct Surfaces {
    n: [Normal<Object>; LANES],
    view: [Normal<Object>; LANES],
    position: [Vec3; LANES],
}

impl Surfaces {
    fn new(seed: u32) -> Self {
        let n = std::array::from_fn(|lane| scattered(seed * 16 + lane as u32));
        // Most eyes are in front; some see a normal that turns away, as maps have them.
        let view = std::array::from_fn(|lane| {
            let side = scattered(seed * 31 + 7 * lane as u32 + 1).vec();
            Normal::new_or(n[lane].vec() * 0.8 + side, Normal::Z)
        });
        let position = std::array::from_fn(|lane| scattered(seed * 5 + 3 * lane as u32).vec() * 0.9);
        Self { n, view, position }
    }

    #[inline(always)]
    fn lit<S: Simd>(&self, simd: S, prepared: &Prepared<Object>) -> [Shade; LANES] {
        let lanes = |v: &dyn Fn(usize) -> Vec3| [0, 1, 2].map(|i| f32x16::from_fn(simd, |lane| v(lane)[i]));
        let (n, view) = (lanes(&|lane| self.n[lane].vec()), lanes(&|lane| self.view[lane].vec()));
        let found = prepared.shade(simd, n, view, lanes(&|lane| self.position[lane]));
        std::array::from_fn(|lane| {
            let [r, g, b, sr, sg, sb] = found.map(|v| v[lane]);
            Shade { diffuse: LinearRgb::new(r, g, b), specular: LinearRgb::new(sr, sg, sb) }
        })
    }
}

fn components(shade: &Shade) -> [f32; 6] {
    let (d, s) = (shade.diffuse, shade.specular);
    [d.r, d.g, d.b, s.r, s.g, s.b]
}

#[test]
fn lanes_are_the_scalar_definition() {
    for level in levels() {
        for lighting in lightings() {
            for (model, exponent, jumps) in models() {
                let material = Material::new([Layer { weight: 0.7, model }]);
                let prepared = Prepared::new(&material, &lighting);
                let (mut wrong, mut bright) = (0, 0);
                for seed in 0..60 {
                    let surfaces = Surfaces::new(seed);
                    let found = dispatch!(level, simd => surfaces.lit(simd, &prepared));
                    for lane in 0..LANES {
                        let (n, view, p) = (surfaces.n[lane], surfaces.view[lane], surfaces.position[lane]);
                        let exact = shade(&material, &lighting, n, view, p);
                        for (found, exact) in components(&found[lane]).into_iter().zip(components(&exact)) {
                            assert!(found.is_finite(), "{level:?} {model:?}: {found} for {exact}");
                            let allowed = 2e-4 * (1.0 + exponent) * exact.max(1.0);
                            let off = (found - exact).abs();
                            if off > allowed {
                                assert!(jumps, "{level:?} {model:?}: {found} for {exact} at {n:?} {view:?}");
                                wrong += 1;
                            }
                            bright += usize::from(exact > 0.05);
                        }
                    }
                }
                assert!(wrong < 20, "{level:?} {model:?}: {wrong} jump elsewhere");
                assert!(bright > 0, "{model:?} shows nothing: {bright}");
            }
        }
    }
}

#[test]
fn no_surface_is_lit_by_what_is_no_number() {
    let all: Vec<LightingModel> = models().into_iter().map(|m| m.0).collect();
    let material = Material::new(all);
    let straight = |d: Normal<Object>| Light::directional(d, LinearRgb::WHITE);
    let back = Normal::new(-Vec3::Z).unwrap();
    // Lights straight behind the eye's opposite, at the surface itself, and grazing.
    let lights = vec![straight(back), straight(Normal::Z), straight(Normal::X), Light::point(Vec3::ZERO, COLOR)];
    for mut lighting in lightings() {
        lighting.lights.clone_from(&lights);
        let prepared = Prepared::new(&material, &lighting);
        for (n, view) in [(Normal::Z, Normal::Z), (back, Normal::Z), (Normal::Y, Normal::Z), (Normal::Y, Normal::Y)] {
            let surfaces = Surfaces { n: [n; LANES], view: [view; LANES], position: [Vec3::ZERO; LANES] };
            for level in levels() {
                let found = dispatch!(level, simd => surfaces.lit(simd, &prepared));
                assert!(components(&found[5]).iter().all(|v| v.is_finite()), "{level:?} {n:?} {view:?} {found:?}");
            }
            let exact = shade(&material, &lighting, n, view, Vec3::ZERO);
            assert!(components(&exact).iter().all(|v| v.is_finite()), "{exact:?}");
        }
    }
}

/// Highlights fade to nothing, not to denormal numbers, which processors are slow with.
#[test]
fn dark_surfaces_hold_no_denormal_numbers() {
    let lighting = Lighting::new(LinearRgb::BLACK, vec![Light::directional(Normal::Z, LinearRgb::gray(1e-3))]);
    for shininess in [0.5, 10.0, 77.7, 1000.0] {
        let model = LightingModel::BlinnPhong { color: LinearRgb::gray(1e-3), shininess };
        let prepared = Prepared::new(&Material::new([model]), &lighting);
        for seed in 0..200 {
            let surfaces = Surfaces::new(seed);
            let found = dispatch!(Level::new(), simd => surfaces.lit(simd, &prepared));
            assert!(found.iter().flat_map(components).all(|v| !v.is_subnormal()), "{shininess}: {found:?}");
        }
    }
}

/// Spans of any length, with the odd ones out.
#[test]
fn tables_of_any_length_are_lit_entry_by_entry() {
    let lighting = &lightings()[1];
    let materials: Vec<Material> = models().into_iter().filter(|m| !m.2).map(|m| Material::new([m.0])).collect();
    let middle = Vec3::new(0.1, -0.2, 0.05);
    for len in 1..=70u32 {
        let normals: Vec<_> = (0..len).map(scattered).collect();
        let cut = len / 3;
        let spans = [(2u8, 0..cut), (5, cut..len)].map(|(material, entries)| MaterialSpan { material, entries });
        let spans = spans.into_iter().filter(|s| !s.entries.is_empty()).collect();
        let table = NormalTable::with_materials(normals.clone(), spans).unwrap();
        let shades = ShadeTable::new(&table, &materials, lighting, Normal::Z, middle).unwrap();
        assert_eq!(shades.entries().len(), len as usize);
        for (i, found) in shades.entries().iter().enumerate() {
            let material = &materials[usize::from(table.material_of(i as u16))];
            let exact = shade(material, lighting, normals[i], Normal::Z, middle);
            for (found, exact) in components(found).into_iter().zip(components(&exact)) {
                assert!((found - exact).abs() < 2e-3 * exact.max(1.0), "{len} {i}: {found} for {exact}");
            }
        }
    }
}
