//! Methods of interpolated vectors where they have to be exact, and what they refuse.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use glam::{Vec2, Vec3};
use rilievo::light::{Light, Lighting, Material};
use rilievo::raster::scanline::draw_scan_lines;
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{Detail, Method, Object, Scene, Target, TextureFilter, bake_light_map, draw, prepare};
use rilievo::surface::{Camera, Mesh, MeshParts, shapes};
use rilievo::{Grid, LinearRgb, MipChain, Normal, NormalTable, Pose, QuantizedMap, Tangent};

const MATTE: [Material; 1] = [Material::MATTE_WHITE];
const SIZE: (u32, u32) = (96, 80);

const fn quadratic(order: Order) -> Method {
    Method::Quadratic { midpoints: Midpoints::GramSchmidt, order }
}

const METHODS: [Method; 4] = [Method::Linear, Method::Normalized, quadratic(Order::Quadratic), quadratic(Order::Auto)];

fn light_from(x: f32, y: f32, z: f32) -> Lighting<rilievo::World> {
    let toward = Normal::new(Vec3::new(x, y, z)).unwrap();
    Lighting::new(LinearRgb::gray(0.03), vec![Light::directional(toward, LinearRgb::WHITE)])
}

fn render(scene: &Scene<'_>, method: Method) -> Target {
    let mut target = Target::new(SIZE.0, SIZE.1).unwrap();
    draw(&prepare(scene, method, TextureFilter::Bilinear).unwrap(), &mut target);
    target
}

fn render_by_lines(scene: &Scene<'_>, method: Method) -> Target {
    let mut target = Target::new(SIZE.0, SIZE.1).unwrap();
    draw_scan_lines(&prepare(scene, method, TextureFilter::Bilinear).unwrap(), &mut target).unwrap();
    target
}

/// The largest difference of a channel; both have to cover the same pixels.
fn difference(a: &Target, b: &Target) -> f32 {
    let mut worst = 0.0f32;
    for (x, y) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))) {
        assert_eq!(a.depth(x, y).is_some(), b.depth(x, y).is_some(), "{x}, {y}");
        let (a, b) = (a.color(x, y), b.color(x, y));
        worst = worst.max((a.r - b.r).abs()).max((a.g - b.g).abs()).max((a.b - b.b).abs());
    }
    worst
}

/// Two squares in the plane z = 0, the texture mirrored on the right one.
fn mirrored() -> Mesh {
    let column = |i: u32| [-1.0, 0.0, 0.0, 1.0][i as usize];
    let parts = MeshParts {
        positions: (0..8).map(|i| Vec3::new(column(i % 4), 0.5 - (i / 4) as f32, 0.0)).collect(),
        normals: vec![Vec3::Z; 8],
        uvs: (0..8u32).map(|i| Vec2::new([0.0, 1.0, 1.0, 0.0][(i % 4) as usize], (i / 4) as f32)).collect(),
        triangles: vec![[0, 4, 5], [0, 5, 1], [2, 6, 7], [2, 7, 3]],
    };
    Mesh::new(parts).unwrap().with_tangents().unwrap()
}

/// Slopes of all directions.
fn slopes() -> MipChain<Normal<Tangent>> {
    let slope = |x: u32, y: u32| {
        Normal::new(Vec3::new((x as f32 * 0.9).sin() * 0.5, (y as f32 * 0.7).cos() * 0.5, 1.0)).unwrap()
    };
    MipChain::single(Grid::from_fn(16, 16, slope).unwrap())
}

/// On flat ground under a far light the vectors are constant: all methods are exact, mirrored or not, from both sides,
/// and where the near plane cuts triangles.
#[test]
fn flat_ground_under_a_far_light_is_exact() {
    let (mesh, slopes) = (mirrored(), slopes());
    let cameras = [
        Camera::new(Vec3::new(0.0, -0.6, 2.2), Vec3::ZERO, Vec3::Y, 0.6, 0.1, 10.0),
        Camera::new(Vec3::new(0.0, -0.6, -2.2), Vec3::ZERO, Vec3::Y, 0.6, 0.1, 10.0),
        // Close above the ground, along both squares, which reach behind the eye.
        Camera::new(Vec3::new(0.8, 0.0, 0.07), Vec3::new(-1.0, 0.1, 0.0), Vec3::Z, 1.0, 0.02, 10.0),
    ];
    for (i, camera) in cameras.into_iter().enumerate() {
        let detail = Detail::Tangent { normals: &slopes, repeat: Vec2::ONE, materials: None };
        let object = Object { double_sided: true, pose: Pose::IDENTITY, ..Object::new(&mesh, detail, &MATTE) };
        let lighting = light_from(-0.5, 0.4, if i == 1 { -0.8 } else { 0.8 });
        let scene = Scene { objects: vec![object], lighting, camera: camera.unwrap() };
        let exact = render(&scene, Method::Exact);
        assert!(exact.covered_pixels() > 1000, "camera {i}");
        let brightest = (0..SIZE.0 * SIZE.1).fold(0.0, |m, i| exact.color(i % SIZE.0, i / SIZE.0).g.max(m));
        assert!(brightest > 0.5, "camera {i}: {brightest}");
        for method in METHODS {
            let direct = difference(&exact, &render(&scene, method));
            let by_lines = difference(&exact, &render_by_lines(&scene, method));
            assert!(direct < 1e-4 && by_lines < 1e-4, "camera {i}, {method:?}: {direct}, {by_lines}");
        }
    }
}

#[test]
fn smooth_sphere_needs_no_tangents() {
    let mesh = shapes::sphere(24, 12).unwrap();
    let camera = Camera::orbit(mesh.bounding_sphere(), 0.3, 0.4, 1.1, 0.6, 1.2).unwrap();
    let materials = [Material::default()];
    let lights = light_from(-1.0, 0.7, 0.9);
    let scene = Scene { objects: vec![Object::new(&mesh, Detail::Smooth, &materials)], lighting: lights, camera };
    let exact = render(&scene, Method::Exact);
    let quadratic = difference(&exact, &render(&scene, quadratic(Order::Quadratic)));
    let linear = difference(&exact, &render(&scene, Method::Linear));
    assert!(quadratic < 0.02 && linear > 2.0 * quadratic, "{quadratic} and {linear}");
}

/// Two lights are the sum of each, and a lamp's light falls off by the pixel.
#[test]
fn lights_add_up_and_fall_off() {
    let mesh = mirrored();
    let camera = Camera::new(Vec3::new(0.0, 0.0, 2.2), Vec3::ZERO, Vec3::Y, 0.6, 0.1, 10.0).unwrap();
    let far = Light::directional(Normal::new(Vec3::new(0.3, 0.0, 1.0)).unwrap(), LinearRgb::WHITE);
    let lamp =
        Light::Point { position: Vec3::new(-0.5, 0.0, 4.0), color: LinearRgb::WHITE, reference_distance: Some(4.0) };
    let lit = |lights| {
        let lighting = Lighting::new(LinearRgb::BLACK, lights);
        let scene = Scene { objects: vec![Object::new(&mesh, Detail::Smooth, &MATTE)], lighting, camera };
        let picture = render(&scene, quadratic(Order::Quadratic));
        assert!(difference(&render(&scene, Method::Exact), &picture) < 0.002);
        picture.color(30, 40).g
    };
    let (one, two, both) = (lit(vec![far]), lit(vec![lamp]), lit(vec![far, lamp]));
    assert!(one > 0.3 && two > 0.3 && (one + two - both).abs() < 1e-6, "{one} + {two} = {both}");
    assert_eq!(lit(vec![]), 0.0);
}

/// A light map of an indexed map is its table, written out.
#[test]
fn static_light_map_is_what_the_table_shows() {
    let mesh = shapes::sphere(48, 24).unwrap();
    let camera = Camera::orbit(mesh.bounding_sphere(), -0.7, 0.2, 1.1, 0.6, 1.2).unwrap();
    let direction = |i: u32| Normal::new(Vec3::new((i as f32).sin(), (i as f32 * 0.7).cos(), 0.8)).unwrap();
    let table = NormalTable::new((0..64).map(direction).collect()).unwrap();
    let indices = Grid::from_fn(32, 16, |x, y| ((x * 5 + y * 11) % 64) as u16).unwrap();
    let map = QuantizedMap::new(table, MipChain::single(indices)).unwrap();
    let materials = [Material::default()];
    let object = Object { pose: Pose::turned(0.9), ..Object::new(&mesh, Detail::Indexed(&map), &materials) };
    let lighting = light_from(-1.0, 0.8, 1.0);
    let light_map = bake_light_map(&object, &lighting, camera.eye()).unwrap();
    let baked = Object { detail: Detail::Baked(&light_map), ..object.clone() };
    let scene = |object| Scene { objects: vec![object], lighting: lighting.clone(), camera };
    let by_table = render(&scene(object), Method::Table);
    assert!(by_table.covered_pixels() > 1000);
    assert_eq!(render(&scene(baked.clone()), Method::Static), by_table);
    // Other lights do not change it any more.
    let dark = Scene { lighting: Lighting::new(LinearRgb::BLACK, vec![]), ..scene(baked) };
    assert_eq!(render(&dark, Method::Static), by_table);
}

#[test]
fn what_does_not_fit_is_named_with_a_remedy() {
    let mesh = shapes::sphere(8, 4).unwrap();
    let camera = Camera::orbit(mesh.bounding_sphere(), 0.0, 0.0, 1.1, 0.6, 1.0).unwrap();
    let normals = MipChain::single(Grid::filled(1, 1, Normal::Z).unwrap());
    let refused = |detail, method| {
        let object = Object::new(&mesh, detail, &MATTE);
        let scene = Scene { objects: vec![object], lighting: light_from(0.0, 0.0, 1.0), camera };
        prepare(&scene, method, TextureFilter::Nearest).err().map(|e| e.to_string()).unwrap_or_default()
    };
    let object_space = Detail::Object { normals: &normals, materials: None };
    for method in METHODS {
        let message = refused(object_space, method);
        assert!(message.contains("tangent-space") && message.contains("exact"), "{method:?}: {message}");
    }
    assert!(refused(object_space, Method::Static).contains("bake_light_map"));
    let object = Object::new(&mesh, object_space, &MATTE);
    let light_map = bake_light_map(&object, &light_from(0.0, 0.0, 1.0), camera.eye()).unwrap();
    assert!(refused(Detail::Baked(&light_map), Method::Exact).contains("Method::Static"));
    let smooth = Object::new(&mesh, Detail::Smooth, &MATTE);
    assert!(bake_light_map(&smooth, &light_from(0.0, 0.0, 1.0), camera.eye()).is_err());
    // Scan lines are for vectors only.
    let scene = Scene { objects: vec![smooth], lighting: light_from(0.0, 0.0, 1.0), camera };
    let frame = prepare(&scene, Method::Exact, TextureFilter::Nearest).unwrap();
    let message = draw_scan_lines(&frame, &mut Target::new(8, 8).unwrap()).unwrap_err().to_string();
    assert!(message.contains("scan lines"), "{message}");
}
