//! Scenes that are hard in their own ways, for whatever draws them.
#![expect(clippy::unwrap_used, reason = "scenes fail loudly")]

use glam::{Quat, Vec2, Vec3};
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Bands, Blend, Landscape, Light, Lighting, LightingModel, Material};
use rilievo::normal::{NormalLevels, decode_u8, encode_u8, normal_levels};
use rilievo::polar::{BumpVectorMap, UnitKind};
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, quantize};
use rilievo::raster::{BaseColor, Detail, Method, Object, Scene, bake_light_map};
use rilievo::surface::{Camera, Deflect, Mesh, deflect_heights, deflect_normals, shapes};
use rilievo::{
    Edges, Grid, LinearRgb, MaterialMap, MipChain, Normal, NormalMap, Object as ObjectSpace, Pose, QuantizedMap, Rgba8,
    Tangent, World,
};

/// A mesh with all kinds of maps.
struct Subject {
    mesh: Mesh,
    tangent: NormalLevels<Tangent>,
    object: NormalLevels<ObjectSpace>,
    indexed: QuantizedMap<ObjectSpace>,
    color: Option<MipChain<LinearRgb>>,
    materials: Vec<Material>,
    repeat: Vec2,
    edges: Edges,
    blend: Blend,
    pose: Pose,
    double_sided: bool,
    baked: MipChain<rilievo::light::Shade>,
    /// For the units whose words are made of object-space normals, E2 and E3.
    bumps: [BumpVectorMap; 2],
}

/// Something to draw.
pub struct Stage {
    /// What it is called in messages.
    pub name: &'static str,
    /// Width and height of its picture.
    pub size: (u32, u32),
    /// Whether shades jump somewhere: a hair's breadth then decides on which side a pixel is.
    pub has_steps: bool,
    subjects: Vec<Subject>,
    lighting: Lighting<World>,
    camera: Camera,
}

impl Stage {
    /// The scene as a method needs it; `None` where the method does not take its materials.
    pub fn scene(&self, method: Method) -> Option<Scene<'_>> {
        let simple = |m: &Material| {
            m.layers().iter().all(|l| {
                use LightingModel::{Ambient, BlinnPhong, Lambert};
                matches!(l.model, Ambient { .. } | Lambert { .. } | BlinnPhong { .. })
            })
        };
        let two_vectors =
            matches!(method, Method::Linear | Method::Normalized | Method::Quadratic { .. } | Method::Polar { .. });
        if two_vectors && !self.subjects.iter().flat_map(|s| &s.materials).all(simple) {
            return None;
        }
        Some(self.scene_of(|subject| subject.object(method)))
    }

    /// The scene with index maps, whatever draws it.
    pub fn indexed_scene(&self) -> Scene<'_> {
        self.scene_of(|subject| subject.object(Method::Table))
    }

    fn scene_of<'a>(&'a self, object: impl Fn(&'a Subject) -> Object<'a>) -> Scene<'a> {
        Scene {
            objects: self.subjects.iter().map(object).collect(),
            lighting: self.lighting.clone(),
            camera: self.camera,
        }
    }
}

impl Subject {
    /// A relief of some waves on `mesh`, of `size` texels; with `kinds` materials, if not one.
    fn new(
        mesh: Mesh,
        size: (u32, u32),
        repeat: [f32; 2],
        materials: Vec<Material>,
        lighting: &Lighting<World>,
    ) -> Self {
        let mesh = mesh.with_tangents().unwrap();
        let wave = |x: u32, y: u32| {
            let (u, v) = (x as f32 / size.0 as f32, y as f32 / size.1 as f32);
            let (a, b) = (u * std::f32::consts::TAU, v * std::f32::consts::TAU);
            0.5 + 0.25 * (3.0 * a).sin() * (2.0 * b).cos() + 0.2 * (5.0 * a + 2.0 * b).sin()
        };
        let relief = HeightMap::new(Grid::from_fn(size.0, size.1, wave).unwrap(), 0.05).unwrap();
        let flat = to_normals(&relief, Filter::Plane4, Edges::Wrap).map(|&n| decode_u8::<Tangent>(encode_u8(n)));
        let options = Deflect { repeat, ..Deflect::new((256, 192)) };
        let bent = deflect_heights(&mesh, &relief, None, Filter::Plane4, Edges::Wrap, &options, &Silent).unwrap();
        let level = NormalMap::<Tangent>::filled(1, 1, Normal::Z).unwrap();
        let plain = deflect_normals(&mesh, &level, None, &Deflect::new((256, 192)), &Silent).unwrap();
        let count = materials.len();
        let map = |(w, h): (u32, u32)| -> Option<MaterialMap> {
            (count > 1).then(|| Grid::from_fn(w, h, |x, y| ((x / 24 + y / 24) as usize % count) as u8).unwrap())
        };
        let object_materials = map(bent.normals.size());
        let quantizing = Options {
            entries: 200,
            effort: Effort::Fast,
            materials: object_materials.as_ref(),
            covered: Some(&bent.covered),
            mip_levels: true,
            ..Options::default()
        };
        let indexed = quantize(&bent.normals, &quantizing, &Silent).unwrap().map;
        let object = normal_levels(bent.normals, object_materials, Some(&bent.covered)).unwrap();
        let plain = normal_levels(plain.normals, None, Some(&plain.covered)).unwrap().normals;
        let bumps =
            [UnitKind::E2, UnitKind::E3].map(|unit| BumpVectorMap::from_object(unit, &object.normals, &plain).unwrap());
        let mut subject = Self {
            tangent: normal_levels(flat, map(size), None).unwrap(),
            object,
            bumps,
            indexed,
            color: None,
            materials,
            repeat: repeat.into(),
            edges: Edges::Wrap,
            blend: Blend::Add,
            pose: Pose::IDENTITY,
            double_sided: false,
            baked: MipChain::single(Grid::filled(1, 1, rilievo::light::Shade::default()).unwrap()),
            mesh,
        };
        subject.baked = bake_light_map(&subject.object(Method::Table), lighting, Vec3::new(0.0, 1.0, 4.0)).unwrap();
        subject
    }

    fn object(&self, method: Method) -> Object<'_> {
        let detail = match method {
            Method::Table => Detail::Indexed(&self.indexed),
            Method::Static => Detail::Baked(&self.baked),
            Method::Polar { unit, .. } => Detail::Bump {
                map: self.bumps.iter().find(|map| map.unit() == unit).expect("stages have maps for E2 and E3"),
                repeat: Vec2::ONE,
                materials: self.object.materials.as_ref(),
            },
            Method::Exact if self.color.is_some() => {
                Detail::Object { normals: &self.object.normals, materials: self.object.materials.as_ref() }
            }
            _ => Detail::Tangent {
                normals: &self.tangent.normals,
                repeat: self.repeat,
                materials: self.tangent.materials.as_ref(),
            },
        };
        let mut object = Object::new(&self.mesh, detail, &self.materials);
        object.pose = self.pose;
        object.edges = self.edges;
        object.blend = self.blend;
        object.double_sided = self.double_sided;
        object.base_color = self.color.as_ref().map(|levels| BaseColor { levels, repeat: Vec2::new(2.0, 1.0) });
        object
    }
}

fn toward(x: f32, y: f32, z: f32) -> Normal<World> {
    Normal::new(Vec3::new(x, y, z)).unwrap()
}

fn lighting() -> Lighting<World> {
    let lights = vec![
        Light::directional(toward(-1.0, 0.8, 1.2), LinearRgb::new(0.8, 0.75, 0.7)),
        Light::point(Vec3::new(1.5, 2.0, 2.5), LinearRgb::new(0.2, 0.25, 0.3)),
    ];
    Lighting::new(LinearRgb::gray(0.06), lights)
}

fn glossy() -> Material {
    Material::blinn_phong(LinearRgb::new(0.7, 0.5, 0.4), LinearRgb::gray(0.4), 32.0)
}

fn stage(name: &'static str, subjects: Vec<Subject>, camera: Camera) -> Stage {
    Stage { name, size: (150, 110), has_steps: false, subjects, lighting: lighting(), camera }
}

fn around(mesh: &Mesh) -> Camera {
    Camera::orbit(mesh.bounding_sphere(), 0.5, 0.6, 1.05, 0.7, 150.0 / 110.0).unwrap()
}

/// Large triangles and a relief that repeats.
pub fn torus() -> Stage {
    let mesh = shapes::torus(12, 12, 1.0, 0.45).unwrap();
    let subject = Subject::new(mesh, (64, 64), [4.0, 2.0], vec![glossy()], &lighting());
    let camera = around(&subject.mesh);
    stage("torus", vec![subject], camera)
}

/// Triangles of a pixel or less.
pub fn fine_sphere() -> Stage {
    let mesh = shapes::sphere(160, 80).unwrap();
    let subject = Subject::new(mesh, (128, 64), [1.0, 1.0], vec![glossy()], &lighting());
    let camera = around(&subject.mesh);
    stage("fine sphere", vec![subject], camera)
}

/// The eye stands in the tube: triangles behind it, through the near plane, and far beyond the picture.
pub fn inside() -> Stage {
    let mesh = shapes::torus(24, 16, 1.0, 0.45).unwrap();
    let mut subject = Subject::new(mesh, (64, 64), [4.0, 2.0], vec![glossy()], &lighting());
    subject.double_sided = true;
    let camera = Camera::new(Vec3::new(0.0, 0.1, 1.0), Vec3::new(0.9, 0.0, 0.6), Vec3::Y, 1.4, 0.02, 5.0).unwrap();
    stage("inside", vec![subject], camera)
}

/// Materials that change within a pixel's reach, a base colour, maps whose sides are no powers of two, edges that do not wrap.
pub fn checkered() -> Stage {
    let mesh = shapes::sphere(24, 12).unwrap();
    let materials = vec![glossy(), Material::MATTE_WHITE, Material::matte(LinearRgb::new(0.1, 0.2, 0.6))];
    let mut subject = Subject::new(mesh, (90, 70), [1.0, 1.0], materials, &lighting());
    let color = |x: u32, y: u32| Rgba8::new((x * 5) as u8, (y * 7) as u8, 140, 255);
    subject.color = Some(MipChain::from_picture(&Grid::from_fn(45, 31, color).unwrap()));
    subject.edges = Edges::Mirror;
    subject.blend = Blend::Exact;
    let camera = around(&subject.mesh);
    stage("checkered", vec![subject], camera)
}

/// Objects that stand in each other, turned, scaled, seen from behind.
pub fn crowd() -> Stage {
    let light = lighting();
    let mut torus =
        Subject::new(shapes::torus(16, 10, 1.0, 0.4).unwrap(), (64, 64), [4.0, 2.0], vec![glossy()], &light);
    torus.pose = Pose { rotation: Quat::from_rotation_x(0.9), ..Pose::IDENTITY };
    let mut sphere = Subject::new(shapes::sphere(20, 10).unwrap(), (64, 32), [2.0, 1.0], vec![glossy()], &light);
    sphere.pose = Pose { scale: 0.6, translation: Vec3::new(0.3, 0.1, 0.2), ..Pose::IDENTITY };
    sphere.color = Some(MipChain::from_picture(&Grid::filled(4, 4, Rgba8::new(200, 120, 40, 255)).unwrap()));
    let mut sheet = Subject::new(shapes::plane_grid(1.3, 3, 2).unwrap(), (96, 64), [1.0, 1.0], vec![glossy()], &light);
    sheet.pose = Pose { rotation: Quat::from_rotation_y(2.6), scale: 1.2, translation: Vec3::new(-0.2, 0.0, 0.1) };
    sheet.double_sided = true;
    sheet.edges = Edges::Clamp;
    let camera = Camera::orbit((Vec3::ZERO, 1.6), -0.3, 0.4, 1.0, 0.7, 150.0 / 110.0).unwrap();
    stage("crowd", vec![torus, sphere, sheet], camera)
}

/// A sphere for every lighting model.
pub fn models() -> Vec<Stage> {
    let white = LinearRgb::gray(0.6);
    let models = [
        ("phong", LightingModel::Phong { color: white, shininess: 20.5 }),
        ("steps", LightingModel::Steps { color: white, steps: 4 }),
        ("cartoon", LightingModel::Cartoon { bands: Bands::of(white) }),
        ("doubled angle", LightingModel::DoubledAngle { color: white, shininess: 12.0 }),
        ("chrome", LightingModel::Chrome { landscape: Landscape::default() }),
        ("environment", LightingModel::Environment { color: white, roughness: 0.2 }),
        (
            "metallic-roughness",
            LightingModel::MetallicRoughness {
                base_color: LinearRgb::new(0.8, 0.5, 0.2),
                metallic: 0.7,
                roughness: 0.4,
            },
        ),
    ];
    let stage = |(name, model): (&'static str, LightingModel)| {
        let material = Material::MATTE_WHITE.with(model);
        let subject = Subject::new(shapes::sphere(24, 12).unwrap(), (64, 32), [2.0, 1.0], vec![material], &lighting());
        let camera = around(&subject.mesh);
        Stage { has_steps: matches!(name, "steps" | "cartoon" | "chrome"), ..stage(name, vec![subject], camera) }
    };
    models.into_iter().map(stage).collect()
}
