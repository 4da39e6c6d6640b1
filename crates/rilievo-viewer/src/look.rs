//! What the user chooses: how to draw, from where, in which light.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::sync::{Arc, OnceLock};

use rilievo::light::{Bands, Environment, Landscape, Layer, Light, Lighting, LightingModel, Material, Projection};
use rilievo::polar::{UnitKind, Width};
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{Method, TextureFilter};
use rilievo::surface::{Camera, Mesh};
use rilievo::{Grid, LinearRgb, Result, World};

/// How normals become colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Way {
    /// Index map and shade table.
    #[default]
    Table,
    /// The same without a table on the GPU: every texel looked up by the CPU, every frame.
    Expanded,
    /// Every pixel by itself.
    Exact,
    /// A light map, baked when it was chosen.
    Static,
    /// Light vectors, linear.
    Linear,
    /// Light vectors, normalised.
    Normalized,
    /// Light vectors, quadratic.
    Quadratic,
    /// A polar unit with Cartesian bump vectors.
    PolarE2,
    /// A polar unit with bump vectors as (ξ, ρ, y).
    PolarE3,
}

impl Way {
    /// All, in the order of the keys 1 to 9.
    pub const ALL: [Self; 9] = [
        Self::Table,
        Self::Exact,
        Self::Static,
        Self::Expanded,
        Self::Linear,
        Self::Normalized,
        Self::Quadratic,
        Self::PolarE2,
        Self::PolarE3,
    ];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Table => "Table",
            Self::Expanded => "Expanded",
            Self::Exact => "Exact",
            Self::Static => "Static",
            Self::Linear => "Linear",
            Self::Normalized => "Normalised",
            Self::Quadratic => "Quadratic",
            Self::PolarE2 => "Polar E2",
            Self::PolarE3 => "Polar E3",
        }
    }

    /// What it does, in a sentence.
    pub fn about(self) -> &'static str {
        match self {
            Self::Table => "Each frame only a small table of normals is lit; texels are looked up in it and filtered.",
            Self::Expanded => "The table is lit, every texel is looked up by the CPU, and the whole map is uploaded.",
            Self::Exact => "Every pixel is lit with its own filtered normal and view direction.",
            Self::Static => "Light that was baked into a map when this was chosen; choose it again to bake anew.",
            Self::Linear => "Light and half vectors of the vertices, interpolated linearly: too short in between.",
            Self::Normalized => "The same, normalised at every pixel.",
            Self::Quadratic => "Light and half vectors through the middles of the edges: no normalising at the pixel.",
            Self::PolarE2 => "A bump unit in 16-bit words: exact rotation, Cartesian bump vectors.",
            Self::PolarE3 => "A bump unit in 16-bit words: six multipliers and twelve small tables.",
        }
    }

    /// The renderers' method.
    pub fn method(self) -> Method {
        let polar = |unit| Method::Polar { unit, width: Width::PAPER };
        match self {
            Self::Table | Self::Expanded => Method::Table,
            Self::Exact => Method::Exact,
            Self::Static => Method::Static,
            Self::Linear => Method::Linear,
            Self::Normalized => Method::Normalized,
            Self::Quadratic => Method::Quadratic { midpoints: Midpoints::default(), order: Order::default() },
            Self::PolarE2 => polar(UnitKind::E2),
            Self::PolarE3 => polar(UnitKind::E3),
        }
    }

    /// The method of the GPU's renderer.
    pub fn gpu_method(self) -> rilievo_gpu::Method {
        if self == Self::Expanded { rilievo_gpu::Method::Expanded } else { self.method().into() }
    }

    /// The unit whose words it needs.
    pub fn unit(self) -> Option<UnitKind> {
        match self {
            Self::PolarE2 => Some(UnitKind::E2),
            Self::PolarE3 => Some(UnitKind::E3),
            _ => None,
        }
    }
}

/// A lighting model by name; its parameters are in [`Finish`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Model {
    /// Ambient light and Lambert's law.
    Matte,
    /// With Blinn-Phong's highlight.
    #[default]
    BlinnPhong,
    /// With Phong's.
    Phong,
    /// Lambert's law in steps.
    Steps,
    /// A few flat colours.
    Cartoon,
    /// A highlight of the doubled angle.
    DoubledAngle,
    /// A mirror in a landscape.
    Chrome,
    /// A mirror in a sky.
    Environment,
    /// glTF's metal and roughness.
    MetallicRoughness,
}

impl Model {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Matte,
        Self::BlinnPhong,
        Self::Phong,
        Self::Steps,
        Self::Cartoon,
        Self::DoubledAngle,
        Self::Chrome,
        Self::Environment,
        Self::MetallicRoughness,
    ];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Matte => "Matte",
            Self::BlinnPhong => "Blinn-Phong",
            Self::Phong => "Phong",
            Self::Steps => "Steps",
            Self::Cartoon => "Cartoon",
            Self::DoubledAngle => "Doubled angle",
            Self::Chrome => "Chrome",
            Self::Environment => "Environment",
            Self::MetallicRoughness => "Metal and roughness",
        }
    }

    /// Whether light and half vectors are all it needs.
    pub fn is_of_two_vectors(self) -> bool {
        matches!(self, Self::Matte | Self::BlinnPhong)
    }
}

/// A material as the panel shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finish {
    /// Its model.
    pub model: Model,
    /// Diffuse reflectance, linear.
    pub color: [f32; 3],
    /// Reflectance of the highlight, linear.
    pub specular: [f32; 3],
    /// Exponent of the highlight.
    pub shininess: f32,
    /// Steps of [`Model::Steps`].
    pub steps: u16,
    /// 0 is a dielectric, 1 a metal.
    pub metallic: f32,
    /// 0 is a mirror, 1 is chalk.
    pub roughness: f32,
}

impl Finish {
    /// What the panel says of a material; what it has no words for becomes Blinn-Phong.
    pub fn of(material: &Material) -> Self {
        let rgb = |c: LinearRgb| [c.r, c.g, c.b];
        let mut finish = Self {
            model: Model::Matte,
            color: [0.8; 3],
            specular: [0.0; 3],
            shininess: 32.0,
            steps: 4,
            metallic: 0.0,
            roughness: 0.4,
        };
        for Layer { model, weight } in material.layers() {
            match *model {
                LightingModel::Lambert { color } => finish.color = rgb(color * *weight),
                LightingModel::BlinnPhong { color, shininess } => {
                    finish.model = Model::BlinnPhong;
                    (finish.specular, finish.shininess) = (rgb(color * *weight), shininess);
                }
                _ => {}
            }
        }
        finish
    }

    /// The material.
    pub fn material(&self) -> Material {
        let rgb = |[r, g, b]: [f32; 3]| LinearRgb::new(r, g, b);
        let (color, specular, shininess) = (rgb(self.color), rgb(self.specular), self.shininess);
        let matte = Material::matte(color);
        let ambient = LightingModel::Ambient { color };
        match self.model {
            Model::Matte => matte,
            Model::BlinnPhong => matte.with(LightingModel::BlinnPhong { color: specular, shininess }),
            // A quarter of the exponent looks alike.
            Model::Phong => matte.with(LightingModel::Phong { color: specular, shininess: shininess * 0.25 }),
            Model::Steps => Material::new([ambient, LightingModel::Steps { color, steps: self.steps }]),
            Model::Cartoon => Material::new([LightingModel::Cartoon { bands: Bands::of(color) }]),
            Model::DoubledAngle => {
                matte.with(LightingModel::DoubledAngle { color: specular, shininess: shininess * 0.25 })
            }
            Model::Chrome => Material::new([LightingModel::Chrome { landscape: Landscape::default().times(color) }]),
            Model::Environment => Material::new([LightingModel::Environment { color, roughness: self.roughness }]),
            Model::MetallicRoughness => {
                let (metallic, roughness) = (self.metallic, self.roughness);
                Material::new([LightingModel::MetallicRoughness { base_color: color, metallic, roughness }])
            }
        }
    }
}

/// Where the eye is: on an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Counter-clockwise from +Z, seen from above.
    pub azimuth_rad: f32,
    /// Up from the horizon.
    pub elevation_rad: f32,
    /// In multiples of the distance at which the object fits.
    pub distance: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { azimuth_rad: 0.45, elevation_rad: 0.25, distance: 1.05 }
    }
}

impl Orbit {
    /// Field of view, up and down.
    const FOV_Y_RAD: f32 = 0.6;

    /// Moves the eye.
    pub fn turn(&mut self, azimuth_rad: f32, elevation_rad: f32) {
        self.azimuth_rad = (self.azimuth_rad + azimuth_rad).rem_euclid(TAU);
        self.elevation_rad = (self.elevation_rad + elevation_rad).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Comes nearer by a factor.
    pub fn zoom(&mut self, factor: f32) {
        self.distance = (self.distance * factor).clamp(0.2, 8.0);
    }

    /// The camera for a picture of a size.
    ///
    /// # Errors
    /// As [`Camera::orbit`].
    pub fn camera(&self, mesh: &Mesh, (width, height): (u32, u32)) -> Result<Camera> {
        let (center, radius) = mesh.bounding_sphere();
        let aspect = width as f32 / height as f32;
        let sphere = (center, radius.max(1e-6));
        Camera::orbit(sphere, self.azimuth_rad, self.elevation_rad, self.distance, Self::FOV_Y_RAD, aspect)
    }
}

/// The light, as the panel shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// From the front (+Z) to the right.
    pub azimuth_rad: f32,
    /// Up from the horizon.
    pub elevation_rad: f32,
    /// Linear.
    pub color: [f32; 3],
    /// How much comes from everywhere, of white.
    pub ambient: f32,
}

impl Default for Lamp {
    fn default() -> Self {
        Self { azimuth_rad: -0.6, elevation_rad: 0.7, color: [0.9, 0.87, 0.82], ambient: 0.08 }
    }
}

impl Lamp {
    /// Moves the light.
    pub fn turn(&mut self, azimuth_rad: f32, elevation_rad: f32) {
        self.azimuth_rad = (self.azimuth_rad + azimuth_rad).rem_euclid(TAU);
        self.elevation_rad = (self.elevation_rad + elevation_rad).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// All light; with the built-in sky if a material mirrors it.
    pub fn lighting(&self, sky: bool) -> Lighting<World> {
        let [r, g, b] = self.color;
        let light = Light::from_angles(self.azimuth_rad, self.elevation_rad, LinearRgb::new(r, g, b));
        let mut lighting = Lighting::new(LinearRgb::gray(self.ambient), vec![light]);
        lighting.environment = if sky { built_in_sky() } else { None };
        lighting
    }
}

/// A sky over a plain with a bright window in it, so that mirrors have something to show.
fn built_in_sky() -> Option<Arc<Environment>> {
    static SKY: OnceLock<Option<Arc<Environment>>> = OnceLock::new();
    SKY.get_or_init(|| {
        let land = Landscape::default();
        let mix = |a: LinearRgb, b: LinearRgb, t: f32| a * (1.0 - t) + b * t;
        let at = |x: u32, y: u32| {
            let (longitude, height) = (x as f32 / 256.0 * TAU, 1.0 - (y as f32 + 0.5) / 64.0);
            let color =
                if height > 0.0 { mix(land.sky, land.zenith, height) } else { mix(land.ground, land.nadir, -height) };
            let window = (longitude - 2.2).abs() < 0.35 && (0.25..0.65).contains(&height);
            if window { LinearRgb::gray(4.0) } else { color }
        };
        let picture = Grid::from_fn(256, 128, at).ok()?;
        Environment::new(Projection::Equirectangular, &picture).ok().map(Arc::new)
    })
    .clone()
}

/// All that a picture depends on but the subject.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// How it is drawn.
    pub way: Way,
    /// What it is compared with, and how much of the picture that has, from the right.
    pub other: Option<(Way, f32)>,
    /// How texels are gathered.
    pub filter: TextureFilter,
    /// What each material is like.
    pub finishes: Vec<Finish>,
    /// Where the eye is.
    pub orbit: Orbit,
    /// Where the light is.
    pub lamp: Lamp,
    /// Whether the base colour is shown.
    pub colored: bool,
}

impl Look {
    /// Whether a way takes these materials.
    pub fn suits(&self, way: Way) -> bool {
        let picky = matches!(way, Way::Linear | Way::Normalized | Way::Quadratic | Way::PolarE2 | Way::PolarE3);
        !picky || self.finishes.iter().all(|f| f.model.is_of_two_vectors())
    }

    /// Whether a material mirrors a sky.
    pub fn mirrors(&self) -> bool {
        self.finishes.iter().any(|f| matches!(f.model, Model::Environment | Model::MetallicRoughness))
    }
}
