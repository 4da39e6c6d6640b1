//! The reference renderer against geometry that is known without it.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use glam::{DVec3, Vec2, Vec3};
use rilievo::light::{Light, Lighting, Material};
use rilievo::raster::{BaseColor, Detail, Method, Object, Scene, Target, TextureFilter, draw, prepare};
use rilievo::surface::{Camera, Mesh, MeshParts, shapes};
use rilievo::{Edges, Grid, LinearRgb, MipChain, Normal, NormalTable, Pose, QuantizedMap};

const MATTE: [Material; 1] = [Material::MATTE_WHITE];

fn light_from(direction: Vec3) -> Lighting<rilievo::World> {
    Lighting::new(LinearRgb::gray(0.02), vec![Light::directional(Normal::new(direction).unwrap(), LinearRgb::WHITE)])
}

fn smooth(mesh: &Mesh) -> Object<'_> {
    Object::new(mesh, Detail::Smooth, &MATTE)
}

fn render(scene: &Scene<'_>, method: Method, filter: TextureFilter, size: (u32, u32)) -> Target {
    let mut target = Target::new(size.0, size.1).unwrap();
    draw(&prepare(scene, method, filter).unwrap(), &mut target);
    target
}

fn camera_for(mesh: &Mesh, azimuth: f32, elevation: f32) -> Camera {
    Camera::orbit(mesh.bounding_sphere(), azimuth, elevation, 1.1, 0.6, 1.0).unwrap()
}

/// Where the ray through the centre of pixel (x, y) goes, from the camera's matrix.
fn ray(camera: &Camera, (width, height): (u32, u32), x: u32, y: u32) -> DVec3 {
    let inverse = camera.view_projection(width as f32 / height as f32).as_dmat4().inverse();
    let ndc = DVec3::new(
        (f64::from(x) + 0.5) / f64::from(width) * 2.0 - 1.0,
        1.0 - (f64::from(y) + 0.5) / f64::from(height) * 2.0,
        0.5,
    );
    (inverse.project_point3(ndc) - camera.eye().as_dvec3()).normalize()
}

#[test]
fn a_sphere_covers_its_disk_without_holes_and_is_lit_from_the_left() {
    let mesh = shapes::sphere(96, 48).unwrap();
    let camera = camera_for(&mesh, 0.4, 0.3);
    let size = (160, 160);
    // World −X turned with the camera: left as the camera sees it.
    let left = Vec3::new(-0.4f32.cos(), 0.0, 0.4f32.sin());
    let scene = Scene { objects: vec![smooth(&mesh)], lighting: light_from(left), camera };
    let target = render(&scene, Method::Exact, TextureFilter::Nearest, size);
    for y in 0..size.1 {
        for x in 0..size.0 {
            let (eye, d) = (camera.eye().as_dvec3(), ray(&camera, size, x, y));
            // Distance of the ray from the centre: the polyhedron lies between radius cos(π/48)² and 1.
            let miss = (eye - d * eye.dot(d)).length();
            if miss < 0.99 {
                assert!(target.depth(x, y).is_some(), "hole at {x}, {y}");
            } else if miss > 1.001 {
                assert!(target.depth(x, y).is_none(), "spill at {x}, {y}");
            }
        }
    }
    let (lit, dark) = (target.color(40, 80).r, target.color(120, 80).r);
    assert!(lit > 0.3 && dark < 0.02, "left {lit}, right {dark}");
}

#[test]
fn texture_coordinates_are_perspective_correct() {
    let mesh = shapes::plane(1.0).unwrap();
    let camera = Camera::new(Vec3::new(0.3, -0.9, 0.5), Vec3::ZERO, Vec3::Z, 0.9, 0.05, 10.0).unwrap();
    // A texture that says where it is: red = u, green = v.
    let texels =
        Grid::from_fn(256, 256, |x, y| LinearRgb::new((x as f32 + 0.5) / 256.0, (y as f32 + 0.5) / 256.0, 0.0));
    let levels = MipChain::single(texels.unwrap());
    let white = [Material::matte(LinearRgb::WHITE)];
    let object = Object {
        base_color: Some(BaseColor { levels: &levels, repeat: Vec2::ONE }),
        materials: &white,
        ..smooth(&mesh)
    };
    let lighting = Lighting::new(LinearRgb::WHITE, vec![]);
    let scene = Scene { objects: vec![object], lighting, camera };
    let size = (200, 150);
    let target = render(&scene, Method::Exact, TextureFilter::Bilinear, size);
    let (mut worst, mut seen) = (0.0f64, 0);
    for y in 0..size.1 {
        for x in 0..size.0 {
            let (eye, d) = (camera.eye().as_dvec3(), ray(&camera, size, x, y));
            let hit = eye - d * (eye.z / d.z);
            let (u, v) = (hit.x + 0.5, 0.5 - hit.y);
            // Away from the border, where the texture repeats.
            if target.depth(x, y).is_some() && (0.01..0.99).contains(&u) && (0.01..0.99).contains(&v) {
                let c = target.color(x, y);
                worst = worst.max((f64::from(c.r) - u).abs()).max((f64::from(c.g) - v).abs());
                seen += 1;
            }
        }
    }
    assert!(seen > 3000, "{seen}");
    // Corners snap to 1/256 of a pixel; a pixel near the horizon spans much of the plane.
    assert!(worst < 2e-4, "{worst}");
}

/// A map whose halves are of one colour each: at the rim of a plane a clamped one must not show the other half.
#[test]
fn clamped_maps_do_not_bleed_at_the_rim() {
    let mesh = shapes::plane(1.0).unwrap();
    let camera = Camera::new(Vec3::new(0.0, 0.0, 1.7), Vec3::ZERO, Vec3::Y, 0.7, 0.05, 10.0).unwrap();
    let half = |x: u32, _| if x < 4 { LinearRgb::new(1.0, 0.0, 0.0) } else { LinearRgb::new(0.0, 0.0, 1.0) };
    let levels = MipChain::single(Grid::from_fn(8, 8, half).unwrap());
    let size = (101, 101);
    for repeat in [1.0, 3.0] {
        let bled = |edges| {
            let base_color = Some(BaseColor { levels: &levels, repeat: Vec2::new(repeat, 1.0) });
            let object = Object { base_color, edges, ..smooth(&mesh) };
            let lighting = Lighting::new(LinearRgb::WHITE, vec![]);
            let scene = Scene { objects: vec![object], lighting, camera };
            let target = render(&scene, Method::Exact, TextureFilter::Bilinear, size);
            let covered = |x: &u32| target.depth(*x, 50).is_some();
            let (left, right) = ((0..101).find(covered).unwrap(), (0..101).rev().find(covered).unwrap());
            assert!(right - left > 60, "{left} … {right}");
            target.color(left, 50).b + target.color(right, 50).r
        };
        assert_eq!(bled(Edges::Clamp), 0.0);
        assert!(bled(Edges::Wrap) > 0.3, "the test sees nothing");
    }
}

#[test]
fn nearer_surfaces_win_in_either_order() {
    let (near, far) = (shapes::sphere(32, 16).unwrap(), shapes::cube(shapes::CubeUvs::EachFace).unwrap());
    let camera = Camera::new(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO, Vec3::Y, 0.6, 0.1, 20.0).unwrap();
    let behind = Pose { translation: Vec3::new(0.3, 0.0, -1.0), scale: 2.0, ..Pose::IDENTITY };
    let objects = vec![smooth(&near), Object { pose: behind, ..smooth(&far) }];
    let scene = |objects| Scene { objects, lighting: light_from(Vec3::new(-1.0, 1.0, 2.0)), camera };
    let one = render(&scene(objects.clone()), Method::Exact, TextureFilter::Nearest, (96, 96));
    let two = render(&scene(objects.into_iter().rev().collect()), Method::Exact, TextureFilter::Nearest, (96, 96));
    assert_eq!(one, two);
}

#[test]
fn from_inside_the_near_plane_cuts_but_leaves_no_hole() {
    let mesh = shapes::sphere(24, 12).unwrap();
    let camera = Camera::new(Vec3::new(0.2, 0.1, 0.0), Vec3::Z, Vec3::Y, 1.2, 0.05, 5.0).unwrap();
    let object = Object { double_sided: true, ..smooth(&mesh) };
    let scene = Scene { objects: vec![object], lighting: light_from(Vec3::Y), camera };
    let target = render(&scene, Method::Exact, TextureFilter::Nearest, (80, 60));
    assert_eq!(target.covered_pixels(), 80 * 60);
    // Seen from inside, all faces are back faces.
    let scene = Scene { objects: vec![smooth(&mesh)], ..scene };
    assert_eq!(render(&scene, Method::Exact, TextureFilter::Nearest, (80, 60)).covered_pixels(), 0);
}

/// From behind, a plane is lit by what shines on its back, whatever its normals come from.
#[test]
fn back_faces_are_lit_from_behind() {
    let mesh = shapes::plane(1.0).unwrap().with_tangents().unwrap();
    let tilted = Normal::new(Vec3::new(0.3, -0.2, 0.9)).unwrap();
    let object_space = MipChain::single(Grid::filled(1, 1, tilted).unwrap());
    let tangent_space = MipChain::single(Grid::filled(1, 1, tilted.relabel()).unwrap());
    let indices = MipChain::single(Grid::filled(1, 1, 0u16).unwrap());
    let map = QuantizedMap::new(NormalTable::new(vec![tilted]).unwrap(), indices).unwrap();
    let camera = Camera::new(Vec3::NEG_Z * 2.0, Vec3::ZERO, Vec3::Y, 0.7, 0.05, 10.0).unwrap();
    let details = [
        (Method::Table, Detail::Indexed(&map)),
        (Method::Exact, Detail::Indexed(&map)),
        (Method::Exact, Detail::Smooth),
        (Method::Exact, Detail::Object { normals: &object_space, materials: None }),
        (Method::Exact, Detail::Tangent { normals: &tangent_space, repeat: Vec2::ONE, materials: None }),
    ];
    for (method, detail) in details {
        let middle = |direction, double_sided| {
            let object = Object { detail, double_sided, ..smooth(&mesh) };
            let scene = Scene { objects: vec![object], lighting: light_from(direction), camera };
            let target = render(&scene, method, TextureFilter::Bilinear, (33, 33));
            target.depth(16, 16).map(|_| target.color(16, 16).g)
        };
        let normal = if matches!(detail, Detail::Smooth) { Vec3::Z } else { tilted.vec() };
        let ambient = middle(Vec3::Z, true).unwrap();
        assert!(ambient < 0.03, "{method:?}, {detail:?}: {ambient} by a light in front");
        let lit = middle(Vec3::NEG_Z, true).unwrap() - ambient;
        // White, Lambert: the cosine.
        let expected = normal.z * 0.8;
        assert!((lit - expected).abs() < 1e-5, "{method:?}, {detail:?}: {lit}, not {expected}, by a light behind");
        assert_eq!(middle(Vec3::NEG_Z, false), None);
    }
}

#[test]
fn triangles_beyond_the_guard_band_are_cut_not_lost() {
    let far = 1e6;
    let parts = MeshParts {
        positions: vec![Vec3::new(-far, -far, -2.0), Vec3::new(far, -far, -2.0), Vec3::new(0.0, far, -2.0)],
        triangles: vec![[0, 1, 2]],
        ..MeshParts::default()
    };
    let mesh = Mesh::new(parts).unwrap();
    let camera = Camera::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 0.8, 0.1, 1e7).unwrap();
    let scene = Scene { objects: vec![smooth(&mesh)], lighting: light_from(Vec3::Z), camera };
    let target = render(&scene, Method::Exact, TextureFilter::Nearest, (64, 64));
    assert_eq!(target.covered_pixels(), 64 * 64);
    let depths: Vec<f32> = (0..64).filter_map(|i| target.depth(i, i)).collect();
    assert!(depths.windows(2).all(|d| (d[0] - d[1]).abs() < 1e-3), "a plane facing the eye has one depth");
}

/// With one table entry per texel, all lights far away and no highlight, the table is exact.
#[test]
fn table_equals_exact_where_it_should() {
    let mesh = shapes::sphere(48, 24).unwrap();
    let camera = camera_for(&mesh, -0.7, 0.2);
    let (w, h) = (32, 16);
    let direction = |x: u32, y: u32| {
        let v = Vec3::new((x as f32 * 0.7).sin(), (y as f32 * 0.5).cos(), (x as f32 * 0.3 + y as f32).cos());
        Normal::new(v).unwrap()
    };
    let normals: Vec<_> = (0..h).flat_map(|y| (0..w).map(move |x| direction(x, y))).collect();
    let indices = Grid::from_fn(w, h, |x, y| (y * w + x) as u16).unwrap();
    let map = QuantizedMap::new(NormalTable::new(normals.clone()).unwrap(), MipChain::single(indices)).unwrap();
    let full = MipChain::single(Grid::new(w, h, normals).unwrap());
    let lighting = light_from(Vec3::new(-1.0, 0.8, 1.0));
    let scene = |detail| {
        let object = Object { detail, pose: Pose::turned(0.9), ..smooth(&mesh) };
        Scene { objects: vec![object], lighting: lighting.clone(), camera }
    };
    let table = render(&scene(Detail::Indexed(&map)), Method::Table, TextureFilter::Nearest, (128, 128));
    let exact = Detail::Object { normals: &full, materials: None };
    let exact = render(&scene(exact), Method::Exact, TextureFilter::Nearest, (128, 128));
    assert!(table.covered_pixels() > 5000);
    let worst = (0..128 * 128).fold(0.0f32, |worst, i| {
        let (a, b) = (table.color(i % 128, i / 128), exact.color(i % 128, i / 128));
        worst.max((a.r - b.r).abs()).max((a.g - b.g).abs()).max((a.b - b.b).abs())
    });
    // Normalising a unit vector again moves it by an ulp.
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn what_is_missing_is_named() {
    let mesh = shapes::sphere(8, 4).unwrap();
    let camera = camera_for(&mesh, 0.0, 0.0);
    let scene = Scene { objects: vec![smooth(&mesh)], lighting: light_from(Vec3::Z), camera };
    let refused = prepare(&scene, Method::Table, TextureFilter::Nearest).err().unwrap();
    assert!(refused.to_string().contains("index map"), "{refused}");
    let normals = MipChain::single(Grid::filled(1, 1, Normal::Z).unwrap());
    let materials = MipChain::single(Grid::filled(1, 1, 3u8).unwrap());
    let detail = Detail::Object { normals: &normals, materials: Some(&materials) };
    let scene = Scene { objects: vec![Object { detail, ..smooth(&mesh) }], ..scene };
    let refused = prepare(&scene, Method::Exact, TextureFilter::Nearest).err().unwrap();
    assert!(refused.to_string().contains("material"), "{refused}");
}
