//! What every renderer draws: a torus with a rough tangent-space normal map, lit from the upper left, in three views.

use anyhow::{Context, Result};
use glam::{Mat4, Vec2, Vec3};
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::indexed::QuantizedMap;
use rilievo::light::{Blend, Light, Lighting, Material, ShadeTable};
use rilievo::normal::{decode_u8, encode_u8};
use rilievo::progress::Silent;
use rilievo::quantize::{Options, quantize};
use rilievo::surface::{Camera, Deflect, Mesh, deflect_normals, shapes};
use rilievo::{Edges, Grid, LinearRgb, MipChain, Normal, Object, Rgba8, Space, Tangent};
use std::sync::OnceLock;

/// Width and height of the pictures.
pub(super) const SIDE: u32 = 1024;
/// Width and height of all maps.
pub(super) const MAP_SIDE: u32 = 1024;
/// Entries of the table of normals: the paper's choice.
pub(super) const ENTRIES: u32 = 2048;
/// How often the normal map repeats around the axis and around the tube.
pub(super) const REPEAT: Vec2 = Vec2::new(4.0, 2.0);
/// The highlight's exponent; the peers' shaders have it by five squarings.
const SHININESS: f32 = 32.0;
const DIFFUSE: LinearRgb = LinearRgb::new(0.75, 0.45, 0.3);
const SPECULAR: LinearRgb = LinearRgb::gray(0.5);
/// Light from everywhere, and that of the lamp.
const AMBIENT: f32 = 0.08;
const LIGHT: f32 = 0.92;
/// Height of the relief as a fraction of the map's width: slopes up to 45° and more.
const DEPTH: f32 = 0.04;
/// Where the camera stands, azimuth and elevation in radians.
const VIEWS: [[f32; 2]; 3] = [[0.4, 0.7], [1.9, 0.25], [4.0, 1.2]];

/// How many views there are.
pub(super) const VIEW_COUNT: usize = VIEWS.len();

/// Which torus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Size {
    /// 12 × 12 cells.
    T288,
    /// 187 × 187 cells: triangles of a few pixels.
    T70k,
}

impl Size {
    pub(super) const ALL: [Self; 2] = [Self::T288, Self::T70k];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::T288 => "288",
            Self::T70k => "70k",
        }
    }

    fn cells(self) -> u32 {
        match self {
            Self::T288 => 12,
            Self::T70k => 187,
        }
    }
}

/// The maps, the same on both tori. All share one parametrisation, and the torus has one surface.
pub(super) struct Maps {
    /// What the GPU gets, byte for byte.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "no one else has a GPU to fill"))]
    pub(super) codes: Grid<[u8; 3]>,
    /// What those bytes stand for.
    pub(super) normals: MipChain<Normal<Tangent>>,
}

/// A torus and its maps.
pub(super) struct Subject {
    pub(super) mesh: Mesh,
    pub(super) maps: Maps,
    pub(super) materials: [Material; 1],
    /// Only made for those who ask: seconds of work.
    indexed: OnceLock<QuantizedMap<Object>>,
}

/// From where it is seen and lit.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub(super) camera: Camera,
    /// Where the light is. It does not fall off.
    pub(super) light: Vec3,
}

impl Subject {
    /// The one of this size; made when first asked for, and shared by all who draw in this process.
    pub(super) fn get(size: Size) -> Result<&'static Self> {
        static MADE: [OnceLock<Subject>; Size::ALL.len()] = [const { OnceLock::new() }; Size::ALL.len()];
        let place = &MADE[size as usize];
        if place.get().is_none() {
            // Whoever else was quicker made the same.
            drop(place.set(Self::new(size)?));
        }
        place.get().context("the subject was not kept")
    }

    fn new(size: Size) -> Result<Self> {
        let mesh = shapes::torus(size.cells(), size.cells(), 1.0, 0.45)?.with_tangents()?;
        let height = HeightMap::new(crate::inputs::rough(MAP_SIDE)?, DEPTH)?;
        let codes = to_normals(&height, Filter::Plane4, Edges::Wrap).map(|&n| encode_u8(n));
        let normals = MipChain::single(codes.map(|&c| decode_u8(c)));
        let materials = [Material::blinn_phong(DIFFUSE, SPECULAR, SHININESS)];
        Ok(Self { mesh, maps: Maps { codes, normals }, materials, indexed: OnceLock::new() })
    }

    /// The object-space map of the whole torus, quantised.
    pub(super) fn indexed(&self) -> Result<&QuantizedMap<Object>> {
        if self.indexed.get().is_none() {
            let deflect = Deflect { repeat: REPEAT.to_array(), ..Deflect::new((MAP_SIDE, MAP_SIDE)) };
            let object = deflect_normals(&self.mesh, self.maps.normals.base(), None, &deflect, &Silent)?;
            let options = Options { entries: ENTRIES, covered: Some(&object.covered), ..Options::default() };
            let map = quantize(&object.normals, &options, &Silent)?.map;
            drop(self.indexed.set(map));
        }
        self.indexed.get().context("the map was not kept")
    }

    /// The table lit for a view, as colours of a picture.
    pub(super) fn lit_table(&self, view: &View) -> Result<Vec<Rgba8>> {
        // The torus stands at the origin of the world, and its space is the world's.
        let eye = Normal::new_or(view.camera.eye(), Normal::Z);
        let table = self.indexed()?.table();
        Ok(ShadeTable::new(table, &self.materials, &view.lighting(), eye, Vec3::ZERO)?.to_srgb(Blend::Add))
    }
}

impl View {
    /// One of the three.
    pub(super) fn new(number: usize) -> Result<Self> {
        let [azimuth, elevation] = *VIEWS.get(number).context("there is no such view")?;
        let camera = Camera::orbit((Vec3::ZERO, 1.45), azimuth, elevation, 1.0, 0.9, 1.0)?;
        // To the left of the eye and above it.
        let forward = -camera.eye().normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let light = camera.eye() - 2.0 * right + 3.0 * right.cross(forward);
        Ok(Self { camera, light })
    }

    /// The same, lit from behind: most of what is seen is dark.
    pub(super) fn dark(self) -> Self {
        Self { light: -self.light, ..self }
    }

    pub(super) fn lighting<S: Space>(&self) -> Lighting<S> {
        Lighting::new(LinearRgb::gray(AMBIENT), vec![Light::point(self.light, LinearRgb::gray(LIGHT))])
    }

    /// Object space to clip space.
    pub(super) fn view_projection(&self) -> Mat4 {
        self.camera.view_projection(1.0)
    }
}

/// What a shader multiplies ambient light, cosine and highlight by.
pub(super) fn light_colors() -> [[f32; 4]; 3] {
    let over = |c: LinearRgb, light: f32| [c.r * light, c.g * light, c.b * light, 0.0];
    [over(DIFFUSE, AMBIENT), over(DIFFUSE, LIGHT), over(SPECULAR, LIGHT)]
}
