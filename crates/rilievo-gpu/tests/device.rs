//! What a device is sent, what it cannot hold, and what becomes of it.
#![expect(clippy::unwrap_used, reason = "tests fail loudly")]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rilievo::light::{Light, Lighting, Material};
use rilievo::polar::{UnitKind, Width};
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{self, Detail, Object, Scene, TextureFilter};
use rilievo::surface::{Camera, Mesh, shapes};
use rilievo::{Grid, LinearRgb, MipChain, NormalTable, Object as ObjectSpace, QuantizedMap};
use rilievo_gpu::{Error, Gpu, Method, Renderer, Target};
use testkit::{Random, uniform_sphere};

fn gpu() -> Option<Gpu> {
    pollster::block_on(Gpu::headless()).map_err(|error| testkit::skip(&error.to_string())).ok()
}

/// A map of `side` texels with `entries` normals in no order.
fn indexed(entries: usize, (width, height): (u32, u32)) -> QuantizedMap<ObjectSpace> {
    let mut random = Random::new(5);
    let normals = uniform_sphere(entries, 3);
    let base = Grid::from_fn(width, height, |_, _| (random.unit() * entries as f64) as u16).unwrap();
    let indices = MipChain::build(base, |block| *block[0]);
    QuantizedMap::new(NormalTable::new(normals).unwrap(), indices).unwrap()
}

fn scene<'a>(mesh: &'a Mesh, detail: Detail<'a>, materials: &'a [Material], lights: usize) -> Scene<'a> {
    let light = |i| Light::from_angles(i as f32, 0.5, LinearRgb::gray(0.5));
    Scene {
        objects: vec![Object::new(mesh, detail, materials)],
        lighting: Lighting::new(LinearRgb::gray(0.1), (0..lights).map(light).collect()),
        camera: Camera::orbit(mesh.bounding_sphere(), 0.4, 0.3, 1.0, 0.7, 1.0).unwrap(),
    }
}

/// The one figure for which the method is there: who moves the light sends the table and nothing else.
#[test]
fn a_moved_light_sends_the_table() {
    let Some(gpu) = gpu() else { return };
    let renderer = Renderer::new(&gpu);
    let (mesh, map) = (shapes::sphere(24, 12).unwrap(), indexed(2048, (512, 256)));
    let materials = [Material::default()];
    let mut scene = scene(&mesh, Detail::Indexed(&map), &materials, 3);
    let mut sent = |method: Method| {
        let mut loaded = renderer.load(&scene, method, TextureFilter::Trilinear).unwrap();
        renderer.update(&mut loaded, &scene, (64, 64)).unwrap();
        scene.lighting.lights[0] = Light::from_angles(1.3, 0.2, LinearRgb::WHITE);
        renderer.update(&mut loaded, &scene, (64, 64)).unwrap().bytes
    };
    assert_eq!(sent(raster::Method::Table.into()), 2048 * 8);
    let texels: u64 = map.indices().levels().iter().map(|l| l.texels().len() as u64).sum();
    assert_eq!(sent(Method::Expanded), texels * 4);
    // Two texels of 32-bit floats a light.
    assert_eq!(sent(raster::Method::Exact.into()), 3 * 32);
}

#[test]
fn maps_over_the_limit_are_refused_with_the_limit() {
    let Some(shared) = gpu() else { return };
    let limit = shared.max_side();
    let renderer = Renderer::new(&shared);
    let (mesh, map) = (shapes::sphere(8, 4).unwrap(), indexed(4, (limit + 1, 1)));
    let materials = [Material::default()];
    let scene = scene(&mesh, Detail::Indexed(&map), &materials, 1);
    let error = renderer.load(&scene, raster::Method::Table.into(), TextureFilter::Nearest).err().unwrap();
    let told = error.to_string();
    assert!(matches!(error, Error::Limit { .. }), "{told}");
    assert!(told.contains(&limit.to_string()) && told.contains(&(limit + 1).to_string()), "{told}");
    let error = Target::new(&shared, (limit + 1, 4)).unwrap_err();
    assert!(matches!(error, Error::Limit { .. }), "{error}");
    assert!(matches!(Target::new(&shared, (0, 4)), Err(Error::Scene(_))));
}

#[test]
fn what_only_the_cpu_draws_is_told() {
    let Some(gpu) = gpu() else { return };
    let renderer = Renderer::new(&gpu);
    let mesh = shapes::sphere(8, 4).unwrap();
    let materials = [Material::default()];
    let refused = |scene: &Scene<'_>, method: raster::Method| {
        let error = renderer.load(scene, method.into(), TextureFilter::Nearest).err().unwrap();
        assert!(matches!(error, Error::Unsupported { .. }), "{error}");
        error.to_string()
    };
    let smooth = scene(&mesh, Detail::Smooth, &materials, 3);
    let quadratic = raster::Method::Quadratic { midpoints: Midpoints::default(), order: Order::Auto };
    assert!(refused(&smooth, quadratic).contains("3 lights"));
    let unit = raster::Method::Polar { unit: UnitKind::E4, width: Width::PAPER };
    assert!(refused(&smooth, unit).contains("e4"));
    // What is wrong on any renderer is said as the CPU says it.
    let error = renderer.load(&smooth, raster::Method::Table.into(), TextureFilter::Nearest).err().unwrap();
    assert!(matches!(error, Error::Scene(rilievo::Error::Missing { .. })), "{error}");
}

#[test]
fn another_scene_is_noticed() {
    let Some(gpu) = gpu() else { return };
    let renderer = Renderer::new(&gpu);
    let mesh = shapes::sphere(8, 4).unwrap();
    let (map, other) = (indexed(7, (16, 16)), indexed(9, (16, 16)));
    let materials = [Material::default()];
    let first = scene(&mesh, Detail::Indexed(&map), &materials, 1);
    let mut loaded = renderer.load(&first, raster::Method::Table.into(), TextureFilter::Nearest).unwrap();
    let second = scene(&mesh, Detail::Indexed(&other), &materials, 1);
    assert!(matches!(renderer.update(&mut loaded, &second, (8, 8)), Err(Error::Changed(_))));
    let none = Scene { objects: vec![], ..first.clone() };
    assert!(matches!(renderer.update(&mut loaded, &none, (8, 8)), Err(Error::Changed(_))));
    assert!(renderer.update(&mut loaded, &first, (8, 8)).is_ok());
}

#[test]
fn a_lost_device_is_an_error_and_no_end() {
    let Some(gpu) = gpu() else { return };
    let renderer = Renderer::new(&gpu);
    let mesh = shapes::sphere(8, 4).unwrap();
    let materials = [Material::default()];
    let scene = scene(&mesh, Detail::Smooth, &materials, 1);
    let method = raster::Method::Exact.into();
    let mut loaded = renderer.load(&scene, method, TextureFilter::Nearest).unwrap();
    let target = Target::new(&gpu, (32, 32)).unwrap();
    renderer.update(&mut loaded, &scene, target.size()).unwrap();
    let told = Arc::new(AtomicBool::new(false));
    let tells = Arc::clone(&told);
    gpu.on_trouble(move || tells.store(true, Ordering::Relaxed));
    gpu.device().destroy();
    renderer.draw(&loaded, &target, None);
    let error = pollster::block_on(target.read()).unwrap_err();
    assert!(matches!(error, Error::Device(_)), "{error}");
    assert!(error.to_string().contains("CPU renderer"), "{error}");
    assert!(told.load(Ordering::Relaxed), "who wants to know is told");
    assert!(matches!(renderer.update(&mut loaded, &scene, (32, 32)), Err(Error::Device(_))));
    assert!(matches!(renderer.load(&scene, method, TextureFilter::Nearest), Err(Error::Device(_))));
}
