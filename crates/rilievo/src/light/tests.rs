//! The scalar definition against angles in f64 and cases made by hand.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::*;
use crate::color::LinearRgb;
use crate::grid::Grid;
use crate::normal::{Normal, Object, World};
use crate::pose::Pose;

const GRAY: LinearRgb = LinearRgb::gray(0.5);

fn unit(x: f32, y: f32, z: f32) -> Normal<Object> {
    Normal::new(Vec3::new(x, y, z)).unwrap()
}

/// Directions that are everywhere and no pattern.
pub(super) fn scattered(i: u32) -> Normal<Object> {
    let t = i as f32;
    unit((t * 0.371).sin(), (t * 0.913).cos(), (t * 0.1131).sin() + 0.01)
}

fn from_left() -> Lighting<Object> {
    Lighting::new(LinearRgb::gray(0.1), vec![Light::directional(unit(-1.0, 0.0, 1.0), LinearRgb::WHITE)])
}

fn one(model: LightingModel, light: Normal<Object>, n: Normal<Object>, view: Normal<Object>) -> Shade {
    let lighting = Lighting::new(LinearRgb::BLACK, vec![Light::directional(light, LinearRgb::WHITE)]);
    shade(&Material::new([model]), &lighting, n, view, Vec3::ZERO)
}

#[test]
fn light_from_the_left_lights_left_slopes() {
    let bands = Bands::of(GRAY);
    let models = [
        LightingModel::Lambert { color: GRAY },
        LightingModel::Steps { color: GRAY, steps: 6 },
        LightingModel::Cartoon { bands },
        LightingModel::MetallicRoughness { base_color: GRAY, metallic: 0.0, roughness: 0.8 },
        LightingModel::MetallicRoughness { base_color: GRAY, metallic: 1.0, roughness: 0.8 },
        LightingModel::Phong { color: GRAY, shininess: 3.0 },
        LightingModel::BlinnPhong { color: GRAY, shininess: 3.0 },
    ];
    for model in models {
        let lit = |x: f32| {
            let shade = shade(&Material::new([model]), &from_left(), unit(x, 0.0, 1.0), Normal::Z, Vec3::ZERO);
            shade.over(LinearRgb::WHITE, Blend::Add).g
        };
        assert!(lit(-0.4) > lit(0.4) + 0.05, "{model:?}");
    }
}

#[test]
fn facing_the_light_gives_its_color_and_behind_gives_ambient() {
    let toward = unit(-1.0, 0.0, 1.0);
    let away = Normal::new(-toward.vec()).unwrap();
    let material = Material::blinn_phong(LinearRgb::gray(0.8), LinearRgb::WHITE, 20.0);
    let front = shade(&material, &from_left(), toward, toward, Vec3::ZERO);
    assert!((front.diffuse.g - 0.8 * 1.1).abs() < 1e-6 && (front.specular.g - 1.0).abs() < 1e-5);
    let back = shade(&material, &from_left(), away, toward, Vec3::ZERO);
    assert_eq!((back.diffuse, back.specular), (LinearRgb::gray(0.1) * LinearRgb::gray(0.8), LinearRgb::BLACK));
}

#[test]
fn lights_and_layers_add_up() {
    let mut two = from_left();
    two.lights.push(Light::directional(Normal::Y, LinearRgb::new(0.0, 0.5, 0.0)));
    let (n, clay) = (unit(-0.2, 0.6, 0.7), Material::default());
    let eval = |m: &Material, l: &Lighting<Object>| shade(m, l, n, Normal::Z, Vec3::ZERO);
    let only_second = Lighting::new(LinearRgb::BLACK, vec![two.lights[1]]);
    let (sum, a, b) = (eval(&clay, &two), eval(&clay, &from_left()), eval(&clay, &only_second));
    assert!((sum.diffuse.g - a.diffuse.g - b.diffuse.g).abs() < 1e-6);
    assert!((sum.specular.g - a.specular.g - b.specular.g).abs() < 1e-6);
    let chrome = Material::new([LightingModel::Chrome { landscape: Landscape::default() }]);
    let mixed = eval(&clay.mix(&chrome, 0.75), &two);
    let by_hand = eval(&clay, &two).specular * 0.75 + eval(&chrome, &two).specular * 0.25;
    assert!((mixed.specular.b - by_hand.b).abs() < 1e-6 && (mixed.diffuse.g - 0.75 * sum.diffuse.g).abs() < 1e-6);
}

/// Each highlight by the angles that define it.
#[test]
fn highlights_are_powers_of_cosines_of_their_angles() {
    let angle = |a: DVec3, b: DVec3| 2.0 * ((a - b).length() * 0.5).min(1.0).asin();
    let mut seen = 0;
    for i in 0..3000 {
        let (n, l, v) = (scattered(i), scattered(i * 7 + 3), scattered(i * 13 + 5));
        let [dn, dl, dv] = [n, l, v].map(|d| d.vec().as_dvec3().normalize());
        if dn.dot(dl) < 1e-3 {
            continue;
        }
        // The mirrored light by turning it half a turn about the normal.
        let mirrored = glam::DQuat::from_axis_angle(dn, std::f64::consts::PI) * dl;
        let theta = angle(mirrored, dv);
        let half = angle(dn, (dl + dv).normalize());
        let shininess = [1.0f32, 8.0, 33.5, 200.0][i as usize % 4];
        let exact = |angle: f64| angle.cos().max(0.0).powf(f64::from(shininess));
        let color = LinearRgb::WHITE;
        for (model, exact) in [
            (LightingModel::Phong { color, shininess }, exact(theta)),
            (LightingModel::BlinnPhong { color, shininess }, exact(half)),
            (LightingModel::DoubledAngle { color, shininess }, exact(2.0 * theta)),
        ] {
            let found = one(model, l, n, v);
            let off = (f64::from(found.specular.g) - exact).abs();
            assert!(off < 2e-6 * f64::from(shininess).max(1.0), "{model:?}: {found:?} for {exact}");
            assert_eq!(found.diffuse, LinearRgb::BLACK);
            seen += usize::from(exact > 0.1);
        }
    }
    assert!(seen > 300, "{seen}");
}

#[test]
fn the_doubled_angle_has_two_highlights() {
    let model = LightingModel::DoubledAngle { color: LinearRgb::WHITE, shininess: 20.0 };
    // Eye and light on one side at the rim: the mirrored light goes straight away from the eye.
    let rim = one(model, unit(1.0, 0.0, 0.02), Normal::Z, unit(1.0, 0.0, 0.02));
    let middle = one(model, Normal::Z, Normal::Z, Normal::Z);
    let between = one(model, unit(1.0, 0.0, 1.0), Normal::Z, Normal::Z);
    assert!(rim.specular.g > 0.8 && middle.specular.g > 0.99 && between.specular.g < 1e-6);
}

#[test]
fn steps_are_few_and_near_lambert() {
    let mut levels = std::collections::BTreeSet::new();
    for i in 0..=1000 {
        let a = (i as f32 / 1000.0) * std::f32::consts::FRAC_PI_2;
        let n = unit(a.sin(), 0.0, a.cos());
        let step = one(LightingModel::Steps { color: LinearRgb::WHITE, steps: 4 }, Normal::Z, n, Normal::Z);
        assert!((step.diffuse.g - a.cos()).abs() <= 0.125 + 1e-6);
        levels.insert((step.diffuse.g * 1000.0) as u32);
    }
    assert_eq!(levels.into_iter().collect::<Vec<_>>(), [0, 250, 500, 750, 1000]);
}

#[test]
fn cartoons_go_by_the_light_of_all_lights() {
    let (dark, bright) = (LinearRgb::new(0.1, 0.0, 0.2), LinearRgb::new(1.0, 0.9, 0.8));
    let bands = Bands::new(&[(0.0, dark), (0.7, bright)]).unwrap();
    let toon = Material::new([LightingModel::Cartoon { bands }]);
    let light = |gray: f32| Light::directional(Normal::<Object>::Z, LinearRgb::gray(gray));
    let seen = |lights| shade(&toon, &Lighting::new(LinearRgb::WHITE, lights), Normal::Z, Normal::Z, Vec3::ZERO);
    assert_eq!(seen(vec![light(0.4)]).diffuse, dark);
    assert_eq!(seen(vec![light(0.4), light(0.4)]).diffuse, bright);
    assert_eq!(seen(vec![]).diffuse, dark);
}

/// The sky stays up when the object turns over.
#[test]
fn chrome_shows_the_sky_above_and_earth_below() {
    let land = Landscape::default();
    let chrome = Material::new([LightingModel::Chrome { landscape: land }]);
    let world = Lighting::<World>::default();
    for angle in [0.0, 1.0, std::f32::consts::PI] {
        let pose = Pose { rotation: glam::Quat::from_rotation_x(angle), ..Pose::IDENTITY };
        let seen = |n: Vec3| {
            let (n, view) = (pose.to_object(Normal::new(n).unwrap()), pose.to_object(Normal::Z));
            shade(&chrome, &world.to_object(&pose), n, view, Vec3::ZERO).specular
        };
        let (up, down) = (seen(Vec3::new(0.0, 1.0, 1.0)), seen(Vec3::new(0.0, -1.0, 1.0)));
        assert!((up.b - land.zenith.b).abs() < 1e-3 && (down.r - land.nadir.r).abs() < 1e-3, "{up:?} {down:?}");
        assert!((up.r - land.zenith.r).abs() < 1e-3 && (down.b - land.nadir.b).abs() < 1e-3);
    }
}

#[test]
fn mirrors_turn_with_the_environment_and_fall_back_to_ambient() {
    // Red on the right half of the panorama (+X), green on the left.
    let half = |x: u32, _| if x >= 32 { LinearRgb::new(1.0, 0.0, 0.0) } else { LinearRgb::new(0.0, 1.0, 0.0) };
    let sky = Environment::new(Projection::Equirectangular, &Grid::from_fn(64, 32, half).unwrap()).unwrap();
    let mirror = Material::new([LightingModel::Environment { color: GRAY, roughness: 0.0 }]);
    let mut lighting = Lighting::<Object>::new(LinearRgb::new(0.0, 0.0, 1.0), vec![]);
    let right = unit(1.0, 0.0, 1.0);
    let seen = |lighting: &Lighting<Object>| shade(&mirror, lighting, right, Normal::Z, Vec3::ZERO).specular;
    assert_eq!(seen(&lighting), LinearRgb::new(0.0, 0.0, 0.5));
    lighting.environment = Some(Arc::new(sky));
    assert!((seen(&lighting).r - 0.5).abs() < 1e-4);
    lighting.to_sky = glam::Quat::from_rotation_y(std::f32::consts::PI);
    assert!((seen(&lighting).g - 0.5).abs() < 1e-4);
}

#[test]
fn metal_tints_what_it_mirrors_and_dielectrics_do_not() {
    let gold = LinearRgb::new(1.0, 0.6, 0.1);
    for (metallic, tinted) in [(1.0, true), (0.0, false)] {
        let model = LightingModel::MetallicRoughness { base_color: gold, metallic, roughness: 0.3 };
        let shade = one(model, Normal::Z, Normal::Z, Normal::Z);
        assert!((shade.diffuse.b / shade.diffuse.r - 0.1).abs() < 1e-4);
        assert_eq!(shade.specular.b, shade.specular.r);
        // All of a metal's light at right angles is tinted, and a dielectric's highlight is not.
        assert_eq!(shade.specular.r < 1e-6 * shade.diffuse.r, tinted, "{shade:?}");
    }
}

#[test]
fn point_lights_are_near_and_tables_see_them_from_the_middle() {
    let light =
        Light::Point { position: Vec3::new(0.0, 0.0, 2.0), color: LinearRgb::WHITE, reference_distance: Some(1.0) };
    let lighting = Lighting::<Object>::new(LinearRgb::BLACK, vec![light]);
    let white = Material::matte(LinearRgb::WHITE);
    let at = |p: Vec3| shade(&white, &lighting, Normal::Z, Normal::Z, p).diffuse.g;
    assert!((at(Vec3::ZERO) - 0.25).abs() < 1e-6 && (at(Vec3::Z) - 1.0).abs() < 1e-6);
    // To the side: 1 / d² times the cosine 2 / d.
    let d2 = 4.0 + 9.0f64;
    assert!((f64::from(at(Vec3::new(3.0, 0.0, 0.0))) - 2.0 / d2.sqrt() / d2).abs() < 1e-6);
    let table = crate::indexed::NormalTable::new(vec![Normal::Z]).unwrap();
    let shades = ShadeTable::new(&table, &[white], &lighting, Normal::Z, Vec3::Z).unwrap();
    assert!((shades.entries()[0].diffuse.g - 1.0).abs() < 1e-6);
}
