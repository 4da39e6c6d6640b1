//! What a frame tells the shader of an object.

use crate::error::{Error, Result};
use crate::method::{Method, blend_word, detail_word, edges_word, filter_word};
use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Mat4};
use rilievo::light::{Light, Lighting, LightingModel, Material, Projection};
use rilievo::polar::{Frame, LightTables, Model, UnitKind, Width};
use rilievo::raster::{Detail, Object, Scene, TextureFilter};
use rilievo::{LinearRgb, Object as ObjectSpace};

/// The most copies of the surroundings that the shader knows.
const COPIES: usize = 5;

/// As in `shader/scene.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Uniforms {
    to_clip: [[f32; 4]; 4],
    eye: [f32; 4],
    ambient: [f32; 4],
    to_sky: [[f32; 4]; 3],
    viewport: [f32; 4],
    repeat: [f32; 4],
    lights: u32,
    levels: u32,
    base_levels: u32,
    filtering: u32,
    edges: u32,
    blend: u32,
    detail: u32,
    back: u32,
    kinds: u32,
    sky_levels: u32,
    matcap: u32,
    variant: u32,
    sky: [[u32; 4]; COPIES],
}

const _: () = assert!(size_of::<Uniforms>() == 16 * (4 + 1 + 1 + 3 + 1 + 1 + 3 + COPIES));

impl Uniforms {
    pub(crate) fn new(
        (scene, object): (&Scene<'_>, &Object<'_>),
        (method, filter): (Method, TextureFilter),
        size: (u32, u32),
        back: u32,
        sky: &[[u32; 4]],
    ) -> Result<Self> {
        let pose = &object.pose;
        let aspect = size.0 as f32 / size.1 as f32;
        let place =
            Mat4::from_scale_rotation_translation(glam::Vec3::splat(pose.scale), pose.rotation, pose.translation);
        let to_clip = scene.camera.view_projection(aspect) * place;
        let to_sky = Mat3::from_quat(scene.lighting.to_sky * pose.rotation);
        let eye = pose.point_to_object(scene.camera.eye());
        let (levels, repeat, kinds) = match object.detail {
            Detail::Smooth => (0, glam::Vec2::ONE, false),
            Detail::Tangent { normals, repeat, materials } => (normals.levels().len(), repeat, materials.is_some()),
            Detail::Object { normals, materials } => (normals.levels().len(), glam::Vec2::ONE, materials.is_some()),
            Detail::Indexed(map) => (map.indices().levels().len(), glam::Vec2::ONE, false),
            Detail::Bump { map, repeat, materials } => (map.words().levels().len(), repeat, materials.is_some()),
            Detail::Baked(levels) => (levels.levels().len(), glam::Vec2::ONE, false),
        };
        let (base_levels, base_repeat) =
            object.base_color.map_or((0, glam::Vec2::ONE), |b| (b.levels.levels().len(), b.repeat));
        let mut places = [[0; 4]; COPIES];
        if sky.len() > COPIES {
            let remedy = "use the CPU renderer";
            return Err(Error::Unsupported { what: format!("{} copies of the surroundings", sky.len()), remedy });
        }
        places[..sky.len()].copy_from_slice(sky);
        let matcap = scene.lighting.environment.as_ref().is_some_and(|e| e.projection() == Projection::Matcap);
        Ok(Self {
            to_clip: to_clip.to_cols_array_2d(),
            eye: eye.extend(1.0).to_array(),
            ambient: texel(scene.lighting.ambient, 0.0),
            to_sky: to_sky.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]),
            viewport: [size.0 as f32, size.1 as f32, 0.0, 0.0],
            repeat: [repeat.x, repeat.y, base_repeat.x, base_repeat.y],
            lights: scene.lighting.lights.len() as u32,
            levels: levels as u32,
            base_levels: base_levels as u32,
            filtering: filter_word(filter),
            edges: edges_word(object.edges),
            blend: blend_word(object.blend)?,
            detail: detail_word(object),
            back,
            kinds: kinds.into(),
            sky_levels: sky.len() as u32,
            matcap: matcap.into(),
            variant: method.variant(),
            sky: places,
        })
    }
}

fn texel(c: LinearRgb, w: f32) -> [f32; 4] {
    [c.r, c.g, c.b, w]
}

/// Two texels a light: place or direction and which of both, colour and the distance at which it is meant.
pub(crate) fn light_texels(lighting: &Lighting<ObjectSpace>) -> Vec<[f32; 4]> {
    let texels = lighting.lights.iter().map(|light| match *light {
        Light::Directional { toward, color } => [toward.vec().extend(0.0).to_array(), texel(color, -1.0)],
        Light::Point { position, color, reference_distance } => {
            [position.extend(1.0).to_array(), texel(color, reference_distance.unwrap_or(-1.0))]
        }
    });
    texels.flatten().collect()
}

/// For each material where its layers start and how many there are; then the layers, each with a head and its colours.
pub(crate) fn material_texels(materials: &[Material]) -> Result<Vec<[f32; 4]>> {
    let (mut heads, mut layers) = (Vec::new(), Vec::new());
    // Highlights in the order of the tables of polar units.
    let mut highlights = 0.0;
    for material in materials {
        heads.push([(materials.len() + layers.len()) as f32, material.layers().len() as f32, 0.0, 0.0]);
        for layer in material.layers() {
            let mut push = |kind: u32, parameters: [f32; 2], colors: &[[f32; 4]]| {
                let word = kind | (1 + colors.len() as u32) << 4;
                layers.push([word as f32, layer.weight, parameters[0], parameters[1]]);
                layers.extend_from_slice(colors);
            };
            let of = |color| [texel(color, 0.0)];
            match layer.model {
                LightingModel::Ambient { color } => push(0, [0.0; 2], &of(color)),
                LightingModel::Lambert { color } => push(1, [0.0; 2], &of(color)),
                LightingModel::Steps { color, steps } => push(2, [f32::from(steps.max(1)), 0.0], &of(color)),
                LightingModel::Cartoon { bands } => {
                    let colors: Vec<_> = bands.bands().iter().map(|&(from, color)| texel(color, from)).collect();
                    push(3, [colors.len() as f32, 0.0], &colors);
                }
                LightingModel::Phong { color, shininess } => push(4, [shininess, 0.0], &of(color)),
                LightingModel::BlinnPhong { color, shininess } => {
                    highlights += 1.0;
                    push(5, [shininess, highlights * LIGHT_ENTRIES as f32], &of(color));
                }
                LightingModel::DoubledAngle { color, shininess } => push(6, [shininess, 0.0], &of(color)),
                LightingModel::Chrome { landscape: l } => {
                    push(7, [0.0; 2], &[l.zenith, l.sky, l.ground, l.nadir].map(|c| texel(c, 0.0)));
                }
                LightingModel::Environment { color, roughness } => push(8, [roughness, 0.0], &of(color)),
                LightingModel::MetallicRoughness { base_color, metallic, roughness } => {
                    push(9, [metallic, roughness].map(|v| v.clamp(0.0, 1.0)), &of(base_color));
                }
                other => {
                    let remedy = "use another model, or the CPU renderer";
                    return Err(Error::Unsupported { what: format!("the lighting model {other:?}"), remedy });
                }
            }
        }
    }
    heads.extend(layers);
    Ok(heads)
}

/// Address bits of a polar unit's tables of light, and what that makes.
const LIGHT_BITS: u32 = 10;
const LIGHT_ENTRIES: usize = 1 << LIGHT_BITS;

/// The sine of a unit, its diffuse table, and the specular tables of all highlights, each from a row of its own.
pub(crate) fn polar_words(unit: UnitKind, width: Width, materials: &[Material]) -> Vec<u16> {
    let model = Model::new(unit, width, Frame::default());
    let mut words: Vec<u16> = model.roms().first().map(|rom| rom.words().to_vec()).unwrap_or_default();
    words.resize(words.len().max(crate::texture::ROW as usize), 0);
    let light = Width::new(LIGHT_BITS).expect("invariant: within 4 to 14");
    let tables = |exponent| LightTables::new(light, LightTables::FULL, LightTables::FULL, exponent);
    words.extend_from_slice(tables(1).roms()[0].words());
    for layer in materials.iter().flat_map(Material::layers) {
        if let LightingModel::BlinnPhong { shininess, .. } = layer.model {
            // Exponents are whole numbers in tables, as on the CPU.
            let exponent = shininess.round().clamp(1.0, 100_000.0) as u32;
            words.extend_from_slice(tables(exponent).roms()[1].words());
        }
    }
    words
}
