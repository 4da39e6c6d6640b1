//! Shading by an integer model of a bump unit: each texel's words, each light's inner products, the light's tables.

use glam::Vec3;
use rilievo_polar::{Bump, Direction, Frame as UnitFrame, LightTables, Model, Twist, UnitKind, Width};

use crate::color::LinearRgb;
use crate::error::{Error, Result};
use crate::light::{Layer, Light, Lighting, LightingModel, Material, Shade};
use crate::normal::Object as ObjectSpace;
use crate::polar::encode::{Geometry, angle, azimuth, meridian_frame, polar_angle, upright};
use crate::polar::{BumpFrame, MOST_WORDS, bump_ports, words};
use crate::raster::reference::interpolated::{ambient, supported};
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::{Sampling, Taps};

/// Address bits of the light's tables: the most the paper has, as highlights need them.
const LIGHT_BITS: u32 = 10;
/// The most ports a unit has.
const MOST_PORTS: usize = 18;

/// One object under a unit.
pub(in crate::raster) struct Polar<'a> {
    unit: UnitKind,
    object: &'a Object<'a>,
    lighting: Lighting<ObjectSpace>,
    eye: Vec3,
    /// One for each light if the unit holds vectors in tables, one for all otherwise.
    models: Vec<Model>,
    /// For each material, one for each of its highlights; a diffuse table in each case.
    tables: Vec<Vec<LightTables>>,
    /// Where the words of the map go.
    bumps: Vec<(usize, Bump)>,
    /// What a smooth surface fetches.
    flat: [u16; MOST_WORDS],
}

impl<'a> Polar<'a> {
    /// For an eye at `eye` in object space.
    ///
    /// # Errors
    /// [`Error::Missing`] if the map is not of the unit's words, a material needs other vectors than L' and H', or a unit for
    /// distant lights is given a point light.
    pub(in crate::raster) fn new(
        (unit, width): (UnitKind, Width),
        object: &'a Object<'a>,
        lighting: Lighting<ObjectSpace>,
        eye: Vec3,
    ) -> Result<Self> {
        let fits = match object.detail {
            Detail::Smooth => true,
            Detail::Bump { map, .. } => map.unit() == unit,
            _ => false,
        };
        if !fits {
            let remedy = "a polar unit needs a bump-vector map made for it, or the mesh's own normals";
            return Err(Error::Missing { what: "bump-vector map", remedy });
        }
        if !object.materials.iter().all(supported) {
            let remedy = "polar units light ambient, Lambert and Blinn-Phong layers; use the exact method for others";
            return Err(Error::Missing { what: "materials of light and half vectors", remedy });
        }
        let models = if unit.is_distant() {
            let middle = object.mesh.bounding_sphere().0;
            let view = (eye - middle).normalize_or(Vec3::Z);
            lighting.lights.iter().map(|light| distant(unit, width, light, view)).collect::<Result<_>>()?
        } else {
            vec![Model::new(unit, width, UnitFrame::default())]
        };
        let tables = object.materials.iter().map(light_tables).collect();
        let bumps = bump_ports(unit).collect();
        let flat = words(unit, Vec3::Z);
        Ok(Self { unit, object, lighting, eye, models, tables, bumps, flat })
    }

    /// Each texel's own shade, then their mean: words of angles cannot be averaged.
    pub(in crate::raster) fn shade(&self, fragment: &Fragment, sampling: Sampling) -> Shade {
        let pixel = self.pixel(fragment);
        let Detail::Bump { map, repeat, materials } = self.object.detail else {
            return self.lit(&pixel, self.flat, 0);
        };
        let levels = map.words();
        let sampling = Sampling { repeat, ..sampling };
        Taps::gather(levels, sampling, &fragment.footprint).iter().fold(Shade::default(), |sum, tap| {
            let at = (tap.x, tap.y);
            let material = materials.map_or(0, |m| m.levels()[tap.level][at]);
            sum.add_weighted(self.lit(&pixel, levels.levels()[tap.level][at], material), tap.weight)
        })
    }

    /// What all texels of a pixel have in common.
    fn pixel(&self, fragment: &Fragment) -> Pixel {
        let normal = upright(fragment.normal).normalize_or(Vec3::Z);
        let view = upright(self.eye - fragment.position).normalize_or(normal);
        let [along, across, _] = meridian_frame(normal);
        let sign = if fragment.tangent.w < 0.0 { -1.0 } else { 1.0 };
        let in_texture = matches!(self.object.detail, Detail::Bump { map, .. } if map.frame() == BumpFrame::Texture);
        let (tangent, twist) = if in_texture {
            let tangent = upright(fragment.tangent.truncate()).reject_from_normalized(normal).normalize_or(along);
            (tangent, angle(tangent.dot(across).atan2(tangent.dot(along))))
        } else {
            (along, 0)
        };
        let bitangent = normal.cross(tangent) * if in_texture { sign } else { 1.0 };
        let ports = self.unit.ports();
        let lights = self.lighting.lights.iter().map(|light| {
            let Some(direction) = light.toward(fragment.position) else {
                // The point itself is the light: no direction, no light.
                return Given { words: [0; MOST_PORTS], color: LinearRgb::BLACK };
            };
            let direction = upright(direction);
            let half = (direction + view).normalize_or(normal);
            let geometry = Geometry { light: direction, half, tangent, bitangent, normal };
            let mut words = [0; MOST_PORTS];
            for (word, port) in words.iter_mut().zip(ports) {
                *word = geometry.word(*port).unwrap_or(0);
            }
            Given { words, color: light.color_at(fragment.position) }
        });
        Pixel {
            lights: lights.collect(),
            twist: if self.unit.twist() == Twist::Added { twist } else { 0 },
            mirrored: in_texture && sign < 0.0,
            back_facing: fragment.back_facing,
        }
    }

    /// A pixel with the words of one texel.
    fn lit(&self, pixel: &Pixel, bump: [u16; MOST_WORDS], material: u8) -> Shade {
        let material = usize::from(material);
        let mut shade = ambient(&self.object.materials[material], self.lighting.ambient);
        let ports = self.unit.ports().len();
        for (i, light) in pixel.lights.iter().enumerate() {
            let mut words = light.words;
            for (&(port, kind), word) in self.bumps.iter().zip(bump) {
                words[port] = pixel.turned(kind, word);
            }
            let model = self.models.get(i).unwrap_or(&self.models[0]);
            let products = model.products(&words[..ports]);
            let products = if pixel.back_facing { products.map(|p| -p) } else { products };
            self.add_light(&mut shade, material, light.color, products);
        }
        shade
    }

    /// Adds what the material makes of one light.
    fn add_light(&self, shade: &mut Shade, material: usize, light: LinearRgb, products: [i16; 2]) {
        if products[0] <= 0 {
            return;
        }
        let share = |word: u16| f32::from(word) / f32::from(LightTables::FULL);
        let mut highlights = self.tables[material].iter();
        let diffuse = self.tables[material].first().map(|tables| tables.look_up(products)[0]);
        for layer in self.object.materials[material].layers() {
            match layer.model {
                LightingModel::Lambert { color } => {
                    shade.diffuse += light * color * (share(diffuse.unwrap_or(0)) * layer.weight);
                }
                LightingModel::BlinnPhong { color, .. } => {
                    let specular = highlights.next().map_or(0, |tables| tables.look_up(products)[1]);
                    shade.specular += light * color * (share(specular) * layer.weight);
                }
                _ => {}
            }
        }
    }
}

/// A pixel before it looks at the map.
struct Pixel {
    lights: Vec<Given>,
    /// α, from the meridian to the texture's first axis.
    twist: u16,
    /// The texture's second axis goes the other way round.
    mirrored: bool,
    back_facing: bool,
}

/// The words of a light, and its colour there.
struct Given {
    words: [u16; MOST_PORTS],
    color: LinearRgb,
}

impl Pixel {
    /// φ' counted from the meridian: the adder before the unit.
    fn turned(&self, kind: Bump, word: u16) -> u16 {
        match kind {
            Bump::Azimuth if self.mirrored => self.twist.wrapping_sub(word),
            Bump::Azimuth => self.twist.wrapping_add(word),
            _ => word,
        }
    }
}

/// The unit for a light that is far away.
fn distant(unit: UnitKind, width: Width, light: &Light<ObjectSpace>, view: Vec3) -> Result<Model> {
    let Light::Directional { toward, .. } = light else {
        let remedy = "this unit holds directions of light in tables; use directional lights, or another unit";
        return Err(Error::Missing { what: "distant lights", remedy });
    };
    let towards = toward.vec();
    let half = (towards + view).normalize_or(view);
    let [light, half] = [towards, half].map(upright).map(|v| Direction { azimuth: azimuth(v), polar: polar_angle(v) });
    Ok(Model::new(unit, width, UnitFrame { light, half }))
}

/// The tables of a material's highlights; exponents are whole numbers in tables.
fn light_tables(material: &Material) -> Vec<LightTables> {
    let width = Width::new(LIGHT_BITS).expect("invariant: within 4 to 14");
    let table = |exponent| LightTables::new(width, LightTables::FULL, LightTables::FULL, exponent);
    let exponent = |layer: &Layer| match layer.model {
        LightingModel::BlinnPhong { shininess, .. } => Some(shininess.round().clamp(1.0, 100_000.0) as u32),
        _ => None,
    };
    let tables: Vec<_> = material.layers().iter().filter_map(exponent).map(table).collect();
    if tables.is_empty() { vec![table(1)] } else { tables }
}
