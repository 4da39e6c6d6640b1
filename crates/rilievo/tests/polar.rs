//! Pictures by the polar units, against pictures by the pixel.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use glam::{Vec2, Vec3};
use rilievo::grid::Grid;
use rilievo::light::{Layer, Light, Lighting, LightingModel, Material};
use rilievo::normal::normal_levels;
use rilievo::polar::{BumpVectorMap, PixelSampling, Polar, Rotation, Twist, UnitKind, Width, rotation_errors};
use rilievo::progress::Silent;
use rilievo::raster::{Detail, Method, Object, Scene, Target, TextureFilter, draw, prepare};
use rilievo::surface::{Camera, Deflect, Mesh, deflect_normals, shapes};
use rilievo::{Error, LinearRgb, MipChain, Normal, NormalMap, Tangent, World};

const SIDE: u32 = 160;

/// Waves of all directions.
fn waves() -> NormalMap<Tangent> {
    let slope = |x: u32, y: u32| {
        let (x, y) = (x as f32 / 256.0, y as f32 / 128.0);
        Normal::new(Vec3::new((x * 47.0).sin() * 0.4, (y * 31.0 + x * 9.0).cos() * 0.4, 1.0)).unwrap()
    };
    Grid::from_fn(512, 256, slope).unwrap()
}

fn glossy() -> [Material; 1] {
    let layer = |model| Layer { model, weight: 1.0 };
    let gray = LinearRgb::gray;
    [Material::new(vec![
        layer(LightingModel::Ambient { color: LinearRgb::WHITE }),
        layer(LightingModel::Lambert { color: gray(0.75) }),
        layer(LightingModel::BlinnPhong { color: gray(0.35), shininess: 20.0 }),
    ])]
}

fn lighting() -> Lighting<World> {
    let toward = Normal::new(Vec3::new(0.7, 0.9, 1.0)).unwrap();
    Lighting::new(LinearRgb::gray(0.12), vec![Light::directional(toward, LinearRgb::WHITE)])
}

/// The three shapes of the source, with tangents.
fn subjects() -> [(&'static str, Mesh); 3] {
    [
        ("plane", shapes::plane(2.0).unwrap()),
        ("cube", shapes::cube(shapes::CubeUvs::Atlas).unwrap()),
        ("sphere", shapes::sphere(128, 64).unwrap()),
    ]
    .map(|(name, mesh)| (name, mesh.with_tangents().unwrap()))
}

fn picture(mesh: &Mesh, detail: Detail<'_>, method: Method) -> Result<Target, Error> {
    let materials = glossy();
    let camera = Camera::orbit(mesh.bounding_sphere(), 0.5, 0.4, 1.1, 0.6, 1.0).unwrap();
    let scene = Scene { objects: vec![Object::new(mesh, detail, &materials)], lighting: lighting(), camera };
    let mut target = Target::new(SIDE, SIDE)?;
    draw(&prepare(&scene, method, TextureFilter::Nearest)?, &mut target);
    Ok(target)
}

/// Root of the normalised mean square error, and the largest difference in grey levels of linear light, as the source has it.
fn differences(reference: &Target, other: &Target) -> (f64, i32) {
    let (mut squares, mut power, mut worst) = (0.0, 0.0, 0);
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        assert_eq!(reference.depth(x, y).is_some(), other.depth(x, y).is_some());
        if reference.depth(x, y).is_none() {
            continue;
        }
        let levels = |t: &Target| (t.color(x, y).g.min(1.0) * 255.0).round() as i32;
        let (a, b) = (levels(reference), levels(other));
        squares += f64::from((a - b).pow(2));
        power += f64::from(a.pow(2));
        worst = worst.max((a - b).abs());
    }
    ((squares / power).sqrt(), worst)
}

fn polar(unit: UnitKind) -> Method {
    Method::Polar { unit, width: Width::PAPER }
}

/// Object-space normals of a map on a mesh.
fn bent(mesh: &Mesh, map: &NormalMap<Tangent>) -> MipChain<Normal<rilievo::Object>> {
    let bent = deflect_normals(mesh, map, None, &Deflect::new((1024, 512)), &Silent).unwrap();
    normal_levels(bent.normals, None, Some(&bent.covered)).unwrap().normals
}

/// What each unit may differ from the picture by the pixel, over the same texels: root of the normalised mean square error and
/// grey levels. The units for a distant viewer have one halfway vector, the picture one for each pixel; IMEM's map is coarse; the
/// published rotation is wrong, and must be seen to be.
fn bar(unit: UnitKind) -> (f64, i32) {
    match unit {
        UnitKind::Blinn | UnitKind::Peercy => (0.003, 2),
        UnitKind::E2 | UnitKind::E3 => (0.01, 3),
        UnitKind::E1 | UnitKind::Kim => (0.01, 8),
        UnitKind::E4 => (0.015, 5),
        UnitKind::E4d => (0.03, 30),
        UnitKind::Kugler => (0.08, 45),
        UnitKind::ExactZ => (0.2, 60),
        UnitKind::Published => (0.5, 150),
    }
}

#[test]
fn exact_units_draw_what_the_pixel_shows() {
    let map = waves();
    let flat = Grid::filled(1, 1, Normal::<Tangent>::Z).unwrap();
    let chain = MipChain::single(map.clone());
    for (name, mesh) in subjects() {
        let (object, surface) = (bent(&mesh, &map), bent(&mesh, &flat));
        let tangent = Detail::Tangent { normals: &chain, repeat: Vec2::ONE, materials: None };
        let by_tangent = picture(&mesh, tangent, Method::Exact).unwrap();
        let baked = Detail::Object { normals: &object, materials: None };
        let by_object = picture(&mesh, baked, Method::Exact).unwrap();
        for unit in UnitKind::ALL {
            let baked = BumpVectorMap::from_object(unit, &object, &surface).unwrap();
            let mut cases = vec![("baked", baked, &by_object)];
            // A unit that adds the twist, or is given the frame, takes the tangent-space map as it is.
            match BumpVectorMap::from_tangent(unit, &chain) {
                Ok(plain) => cases.push(("tangent", plain, &by_tangent)),
                Err(error) => assert!(unit.twist() == Twist::Baked, "{unit}: {error}"),
            }
            for (how, words, exact) in cases {
                let detail = Detail::Bump { map: &words, repeat: Vec2::ONE, materials: None };
                let drawn = picture(&mesh, detail, polar(unit)).unwrap();
                let (rnmse, levels) = differences(exact, &drawn);
                println!("{name} {unit} {how}: RNMSE {rnmse:.4}, {levels} levels");
                let (most, most_levels) = bar(unit);
                assert!(rnmse <= most && levels <= most_levels, "{name} {unit} {how}: {rnmse}, {levels}");
                if unit == UnitKind::Published {
                    assert!(rnmse > 0.1, "{name} {how}: {rnmse}");
                }
            }
        }
    }
}

#[test]
fn smooth_surfaces_need_no_map() {
    let mesh = shapes::sphere(64, 32).unwrap();
    let exact = picture(&mesh, Detail::Smooth, Method::Exact).unwrap();
    for unit in [UnitKind::E1, UnitKind::E3, UnitKind::Peercy] {
        let (rnmse, levels) = differences(&exact, &picture(&mesh, Detail::Smooth, polar(unit)).unwrap());
        assert!(rnmse <= 0.01 && levels <= 3, "{unit}: {rnmse}, {levels}");
    }
}

#[test]
fn a_map_for_another_unit_is_refused() {
    let mesh = shapes::plane(1.0).unwrap().with_tangents().unwrap();
    let words = BumpVectorMap::from_tangent(UnitKind::E1, &MipChain::single(waves())).unwrap();
    let detail = Detail::Bump { map: &words, repeat: Vec2::ONE, materials: None };
    let error = picture(&mesh, detail, polar(UnitKind::E3)).unwrap_err();
    assert!(error.to_string().contains("bump-vector map"), "{error}");
    assert!(picture(&mesh, detail, Method::Exact).is_err());
    // Without tangents the texture's frame is unknown.
    let bare = shapes::plane(1.0).unwrap();
    assert!(picture(&bare, detail, polar(UnitKind::E1)).is_err());
}

#[test]
fn units_with_tables_of_directions_refuse_near_lights() {
    let mesh = shapes::sphere(16, 8).unwrap();
    let materials = glossy();
    let lights = vec![Light::point(Vec3::new(2.0, 2.0, 2.0), LinearRgb::WHITE)];
    let camera = Camera::orbit(mesh.bounding_sphere(), 0.5, 0.4, 1.1, 0.6, 1.0).unwrap();
    let objects = vec![Object::new(&mesh, Detail::Smooth, &materials)];
    let scene = Scene { objects, lighting: Lighting::new(LinearRgb::BLACK, lights), camera };
    assert!(prepare(&scene, polar(UnitKind::E4d), TextureFilter::Nearest).is_err());
    assert!(prepare(&scene, polar(UnitKind::E4), TextureFilter::Nearest).is_ok());
}

#[test]
fn rotations_are_those_of_the_twins() {
    let mut random = testkit::Random::new(7);
    for _ in 0..50_000 {
        let mut direction = || {
            let twin = testkit::polar::Polar::upper(&mut random);
            (Polar { phi: twin.phi, theta: twin.theta }, twin)
        };
        let [(a, twin_a), (n, twin_n)] = [direction(), direction()];
        for (rotation, twin) in [
            (Rotation::Published, testkit::polar::published as fn(_, _) -> testkit::polar::Polar),
            (Rotation::ExactZ, testkit::polar::exact_z),
        ] {
            let (found, expected) = (rotation.rotate(a, n), twin(twin_a, twin_n));
            let apart = testkit::polar::Polar { phi: found.phi, theta: found.theta }.cartesian() - expected.cartesian();
            // The arc sine is steep where x is nearly 1: rounding shows as its root.
            assert!(apart.length() < 1e-6, "{rotation:?} {a:?} {n:?}: {apart}");
        }
    }
}

#[test]
fn rotations_err_by_the_known_statistics() {
    for (rotation, [mean, rms, p99, max]) in
        [(Rotation::Published, [15.8, 19.8, 48.2, 59.6]), (Rotation::ExactZ, [4.1, 4.8, 8.5, 8.6])]
    {
        let found = rotation_errors(rotation, &PixelSampling::default()).unwrap();
        let found = [found.mean, found.rms, found.p99, found.max].map(f64::to_degrees);
        for (found, expected) in found.into_iter().zip([mean, rms, p99, max]) {
            assert!((found - expected).abs() < 0.4, "{rotation:?}: {found} for {expected}");
        }
    }
}
