//! What is drawn.

use glam::{Vec2, Vec3, Vec4};

use crate::color::LinearRgb;
use crate::grid::Edges;
use crate::indexed::QuantizedMap;
use crate::light::{Blend, Layer, Lighting, LightingModel, Material, Shade};
use crate::mip::MipChain;
use crate::normal::{Normal, Object as ObjectSpace, Tangent, World};
use crate::polar::{BumpVectorMap, UnitKind, Width};
use crate::pose::Pose;
use crate::raster::texture::Footprint;
use crate::raster::vectors::{Midpoints, Order};
use crate::surface::{Camera, Mesh};

/// Where the fine normals of an object come from.
#[derive(Debug, Clone, Copy)]
pub enum Detail<'a> {
    /// The mesh's own interpolated normals.
    Smooth,
    /// A tangent-space normal map, bent onto the mesh's MikkTSpace frames pixel by pixel.
    Tangent {
        /// The normals, with their mip levels.
        normals: &'a MipChain<Normal<Tangent>>,
        /// How often the map repeats over the mesh's texture square, along u and v.
        repeat: Vec2,
        /// A material per texel, of the same levels; material 0 without it.
        materials: Option<&'a MipChain<u8>>,
    },
    /// An object-space normal map.
    Object {
        /// The normals, with their mip levels.
        normals: &'a MipChain<Normal<ObjectSpace>>,
        /// A material per texel, of the same levels; material 0 without it.
        materials: Option<&'a MipChain<u8>>,
    },
    /// A quantised object-space map: what [`Method::Table`] needs.
    Indexed(&'a QuantizedMap<ObjectSpace>),
    /// A normal map in the words of a polar unit: what [`Method::Polar`] needs, unless the surface is smooth.
    Bump {
        /// The words, with their mip levels.
        map: &'a BumpVectorMap,
        /// How often the map repeats over the mesh's texture square, along u and v.
        repeat: Vec2,
        /// A material per texel, of the same levels; material 0 without it.
        materials: Option<&'a MipChain<u8>>,
    },
    /// No normals any more but light: what [`Method::Static`] draws, made by [`crate::raster::bake_light_map`].
    Baked(&'a MipChain<Shade>),
}

/// A base colour texture.
#[derive(Debug, Clone, Copy)]
pub struct BaseColor<'a> {
    /// Linear light, with mip levels.
    pub levels: &'a MipChain<LinearRgb>,
    /// How often it repeats over the mesh's texture square, along u and v.
    pub repeat: Vec2,
}

/// A mesh with everything that decides its look.
#[derive(Debug, Clone)]
pub struct Object<'a> {
    /// The geometry; needs texture coordinates if there is a map, tangents if that map is tangent-space.
    pub mesh: &'a Mesh,
    /// Where it stands.
    pub pose: Pose,
    /// Its fine normals.
    pub detail: Detail<'a>,
    /// Its base colour; white without it.
    pub base_color: Option<BaseColor<'a>>,
    /// Material `m` of the map is `materials[m]`.
    pub materials: &'a [Material],
    /// What lies beyond the texture square for all its maps; glTF's default sampler wraps.
    ///
    /// Wrapped maps meet their opposite border there. Any other choice keeps each copy of a map to itself, as it was
    /// bent by [`crate::surface::deflect_heights`] with the same edges.
    pub edges: Edges,
    /// How light and base colour meet.
    pub blend: Blend,
    /// Whether back faces are drawn too, with their normals reversed, as glTF has it.
    pub double_sided: bool,
}

impl<'a> Object<'a> {
    /// An object at the origin of the world, without a base colour, its maps wrapped, light added up, back faces hidden.
    pub fn new(mesh: &'a Mesh, detail: Detail<'a>, materials: &'a [Material]) -> Self {
        let (pose, blend) = (Pose::IDENTITY, Blend::default());
        Self { mesh, pose, detail, base_color: None, materials, edges: Edges::Wrap, blend, double_sided: false }
    }
}

impl Object<'_> {
    /// The largest exponent of a highlight among the materials; 0 without highlights.
    pub(super) fn highest_shininess(&self) -> f32 {
        let exponent = |layer: &Layer| match layer.model {
            LightingModel::BlinnPhong { shininess, .. } if layer.weight != 0.0 => shininess,
            _ => 0.0,
        };
        self.materials.iter().flat_map(Material::layers).map(exponent).fold(0.0, f32::max)
    }
}

/// Objects, lights and a camera.
#[derive(Debug, Clone)]
pub struct Scene<'a> {
    /// What is drawn.
    pub objects: Vec<Object<'a>>,
    /// All light.
    pub lighting: Lighting<World>,
    /// Who looks.
    pub camera: Camera,
}

/// How normals become colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Method {
    /// Index map and shade table: light and view directions are constant over an object.
    #[default]
    Table,
    /// Normal, frame and view direction of every pixel, all normalised: the reference for the other methods.
    Exact,
    /// A light map that was baked once: lights stand still. The baseline of what a textured picture costs.
    Static,
    /// Light and half vectors of the vertices, interpolated linearly over the screen: too short between them, so that
    /// highlights break up on large triangles.
    ///
    /// This and the other methods of interpolated vectors take tangent-space maps or the mesh's own normals, and
    /// materials of ambient, Lambert and Blinn-Phong layers.
    Linear,
    /// The same vectors, normalised in every pixel.
    Normalized,
    /// The vectors interpolated quadratically, through samples at vertices and edge midpoints: of about unit length
    /// without being normalised.
    Quadratic {
        /// How the samples between the vertices are made.
        midpoints: Midpoints,
        /// Whether triangles may be linear.
        order: Order,
    },
    /// An integer model of a bump unit, to the bit: texels are looked up, lit by the unit, and the light is filtered.
    ///
    /// Takes a [`Detail::Bump`] map made for the unit or the mesh's own normals, and materials of ambient, Lambert and
    /// Blinn-Phong layers, whose exponents are rounded to whole numbers.
    Polar {
        /// Which unit.
        unit: UnitKind,
        /// Address bits of its tables.
        width: Width,
    },
}

/// What the mesh says of a pixel, in object space, interpolated and not normalised.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragment {
    pub(super) footprint: Footprint,
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) tangent: Vec4,
    /// Seen from behind: the true normal is the negative of whatever the mesh and its map say.
    pub(super) back_facing: bool,
}
