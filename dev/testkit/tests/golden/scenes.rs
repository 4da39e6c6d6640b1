//! The scenes. Light comes from the left, above and in front: left and upper flanks of what is raised are bright.

use glam::{Vec2, Vec3};
use rilievo::color::Picture;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Blend, Light, Lighting, Material, ShadeTable, relight};
use rilievo::normal::normal_levels;
use rilievo::normal::{DitherU8, encode_map_u8};
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, Quantized, quantize};
use rilievo::raster::{BaseColor, Detail, Method, Object, Scene, Target, TextureFilter, draw, prepare};
use rilievo::sample::vase as sample;
use rilievo::surface::{Camera, Deflect, Deflected, Mesh, MeshParts, deflect_heights, shapes};
use rilievo::{
    Edges, Grid, LinearRgb, MaterialMap, MipChain, Normal, Object as ObjectSpace, QuantizedMap, Rgba8, Space, Tangent,
};

use crate::relief;

/// Pictures are rendered at this multiple of their size and averaged, so that silhouettes are smooth.
const SUPERSAMPLE: u32 = 2;
const BACKGROUND: LinearRgb = LinearRgb::gray(0.2);

/// Which method draws a scene that has two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shading {
    Exact,
    Table,
}

fn lighting<S: Space>() -> Lighting<S> {
    let direction = Normal::new(Vec3::new(-1.0, 0.8, 1.2)).unwrap();
    Lighting::new(LinearRgb::gray(0.06), vec![Light::directional(direction, LinearRgb::WHITE)])
}

fn camera(mesh: &Mesh, azimuth_deg: f32, elevation_deg: f32) -> Camera {
    let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    Camera::orbit(mesh.bounding_sphere(), azimuth, elevation, 1.03, 0.6, 1.0).unwrap()
}

fn object<'a>(mesh: &'a Mesh, detail: Detail<'a>, materials: &'a [Material]) -> Object<'a> {
    Object::new(mesh, detail, materials)
}

fn render(object: Object<'_>, camera: Camera, method: Method, (width, height): (u32, u32)) -> Picture {
    let scene = Scene { objects: vec![object], lighting: lighting(), camera };
    let mut target = Target::new(width * SUPERSAMPLE, height * SUPERSAMPLE).unwrap();
    draw(&prepare(&scene, method, TextureFilter::Trilinear).unwrap(), &mut target);
    target.resolve(SUPERSAMPLE, Some(BACKGROUND)).unwrap()
}

fn bend(mesh: &Mesh, heights: Grid<f32>, depth: f32, size: (u32, u32), repeat: [f32; 2]) -> Deflected {
    let map = HeightMap::new(heights, depth).unwrap();
    let options = Deflect { size, gutter: 4, repeat };
    deflect_heights(mesh, &map, None, Filter::Plane4, Edges::Wrap, &options, &Silent).unwrap()
}

fn table_of(map: &Deflected, entries: u32, materials: Option<&MaterialMap>) -> QuantizedMap<ObjectSpace> {
    let options = Options {
        entries,
        effort: Effort::Fast,
        materials,
        covered: Some(&map.covered),
        mip_levels: true,
        ..Options::default()
    };
    quantize(&map.normals, &options, &Silent).unwrap().map
}

/// The mesh's own normals, per pixel.
pub(crate) fn smooth_sphere() -> Picture {
    let mesh = shapes::sphere(32, 16).unwrap();
    let materials = [Material::default()];
    render(object(&mesh, Detail::Smooth, &materials), camera(&mesh, 0.0, 15.0), Method::Exact, (128, 128))
}

/// A low-poly torus with a relief: bumps hide the facets, not the outline.
pub(crate) fn torus(shading: Shading) -> Picture {
    let mesh = shapes::torus(16, 9, 1.0, 0.42).unwrap();
    let bent = bend(&mesh, relief::letter_and_dome(64), 0.03, (512, 192), [8.0, 3.0]);
    let materials = [Material::default()];
    let camera = camera(&mesh, 0.0, 35.0);
    match shading {
        Shading::Exact => {
            let normals = normal_levels(bent.normals, None, Some(&bent.covered)).unwrap().normals;
            let detail = Detail::Object { normals: &normals, materials: None };
            render(object(&mesh, detail, &materials), camera, Method::Exact, (144, 128))
        }
        Shading::Table => {
            let map = table_of(&bent, 256, None);
            render(object(&mesh, Detail::Indexed(&map), &materials), camera, Method::Table, (144, 128))
        }
    }
}

/// Two materials, a colour map, and one table for all of it.
pub(crate) fn vase() -> Picture {
    let maps = sample::maps(256).unwrap();
    let mesh = sample::mesh(sample::DEFAULT_SEGMENTS).unwrap();
    let size = maps.height.heights().size();
    let options = Deflect { gutter: 4, ..Deflect::new(size) };
    let bent = deflect_heights(&mesh, &maps.height, None, Filter::Plane4, Edges::Wrap, &options, &Silent).unwrap();
    let map = table_of(&bent, 256, Some(&maps.materials));
    let color = MipChain::from_picture(&maps.color);
    let materials = sample::materials_over_color();
    let base_color = Some(BaseColor { levels: &color, repeat: Vec2::ONE });
    let object = Object { base_color, ..object(&mesh, Detail::Indexed(&map), &materials) };
    render(object, camera(&mesh, 0.0, 10.0), Method::Table, (96, 112))
}

/// Eight-bit codes of a map that does not tile: wrapped on the left, clamped on the right.
pub(crate) fn normals_wrap_and_clamp() -> Picture {
    let map = HeightMap::new(relief::letter_on_ramp(64), 0.2).unwrap();
    let codes = [Edges::Wrap, Edges::Clamp]
        .map(|edges| encode_map_u8(&to_normals(&map, Filter::Scharr, edges), DitherU8::None));
    let pixel = |x: u32, y: u32| {
        let [r, g, b] = codes[(x / 64) as usize][(x % 64, y)];
        Rgba8::new(r, g, b, 255)
    };
    Grid::from_fn(128, 64, pixel).unwrap()
}

/// A flat map in 64 entries, with two materials.
fn flat() -> Quantized<Tangent> {
    let heights = relief::letter_and_dome(96);
    let materials = heights.map(|&h| u8::from(h > 0.5));
    let normals = to_normals(&HeightMap::new(heights, 0.06).unwrap(), Filter::Plane4, Edges::Wrap);
    let options = Options { entries: 64, materials: Some(&materials), ..Options::default() };
    quantize(&normals, &options, &Silent).unwrap()
}

/// The table and the indices of the flat map.
pub(crate) fn flat_map() -> QuantizedMap<Tangent> {
    flat().map
}

/// The flat map lit by its table: the raised parts are of a red, glossy material.
pub(crate) fn flat_relit() -> Picture {
    let map = flat().map;
    let red = Material::blinn_phong(LinearRgb::new(0.7, 0.1, 0.05), LinearRgb::gray(0.4), 30.0);
    let materials = [Material::MATTE_WHITE, red];
    let shades = ShadeTable::new(map.table(), &materials, &lighting(), Normal::Z, Vec3::ZERO).unwrap();
    relight(&map, &shades, None, Blend::Add).unwrap()
}

fn cube_of(width: u32) -> (Mesh, QuantizedMap<ObjectSpace>) {
    let mesh = shapes::cube(shapes::CubeUvs::Atlas).unwrap();
    let bent = bend(&mesh, relief::letter_and_dome(64), 0.05, (width, width / 3 * 2), shapes::CUBE_ATLAS_REPEAT);
    let map = table_of(&bent, 256, None);
    (mesh, map)
}

/// Table and indices of the cube's atlas; no libm takes part in them.
pub(crate) fn cube_map() -> QuantizedMap<ObjectSpace> {
    let (_, map) = cube_of(96);
    // A PNG holds one level.
    QuantizedMap::new(map.table().clone(), MipChain::single(map.base().clone())).unwrap()
}

/// The letter once on each face.
pub(crate) fn cube() -> Picture {
    let (mesh, map) = cube_of(384);
    let materials = [Material::default()];
    render(object(&mesh, Detail::Indexed(&map), &materials), camera(&mesh, -30.0, 30.0), Method::Table, (128, 128))
}

/// Two squares side by side with one tangent-space map; the texture is mirrored on the right one.
///
/// The letter is mirrored there, but stays raised and lit from the left: that is what the sign of the tangent is for.
pub(crate) fn mirrored_tangent() -> Picture {
    let column = |i: u32| [-1.0, 0.0, 0.0, 1.0][i as usize];
    let parts = MeshParts {
        positions: (0..8).map(|i| Vec3::new(column(i % 4), 0.5 - (i / 4) as f32, 0.0)).collect(),
        normals: vec![Vec3::Z; 8],
        uvs: (0..8u32).map(|i| Vec2::new([0.0, 1.0, 1.0, 0.0][(i % 4) as usize], (i / 4) as f32)).collect(),
        triangles: vec![[0, 4, 5], [0, 5, 1], [2, 6, 7], [2, 7, 3]],
    };
    let mesh = Mesh::new(parts).unwrap().with_tangents().unwrap();
    let map = HeightMap::new(relief::letter_and_dome(64), 0.05).unwrap();
    let normals = normal_levels(to_normals(&map, Filter::Plane4, Edges::Wrap), None, None).unwrap().normals;
    let materials = [Material::default()];
    let detail = Detail::Tangent { normals: &normals, repeat: Vec2::ONE, materials: None };
    let camera = Camera::new(Vec3::new(0.0, -0.5, 2.4), Vec3::ZERO, Vec3::Y, 0.5, 0.1, 10.0).unwrap();
    render(object(&mesh, detail, &materials), camera, Method::Exact, (160, 96))
}

/// A plane towards the horizon: without mip levels the far half would be noise.
pub(crate) fn grazing_trilinear() -> Picture {
    let mesh = shapes::plane(1.0).unwrap();
    let bent = bend(&mesh, relief::letter_and_dome(32), 0.05, (512, 512), [16.0, 16.0]);
    let map = table_of(&bent, 256, None);
    let materials = [Material::default()];
    let camera = Camera::new(Vec3::new(0.0, -0.62, 0.14), Vec3::new(0.0, 0.0, -0.04), Vec3::Z, 0.7, 0.02, 5.0);
    render(object(&mesh, Detail::Indexed(&map), &materials), camera.unwrap(), Method::Table, (160, 96))
}
