//! The three objects of Lee et al.: boards on a plane, bricks on a cube, a map of a world on a sphere.

use anyhow::Result;
use glam::Vec2;
use rilievo::color::Picture;
use rilievo::height::Filter;
use rilievo::light::{Light, Lighting, Material};
use rilievo::normal::normal_levels;
use rilievo::polar::{BumpVectorMap, UnitKind, Width};
use rilievo::progress::Silent;
use rilievo::raster::{self, BaseColor, Detail, Method, Object, Scene, Target, TextureFilter};
use rilievo::sample::{self, Covering};
use rilievo::surface::{Camera, Deflect, Mesh, deflect_heights, shapes};
use rilievo::{Edges, Grid, LinearRgb, MipChain, Normal, Object as ObjectSpace, Rgba8, World};

/// An object with its relief and its colours.
pub(crate) struct Specimen {
    pub(crate) name: &'static str,
    /// As keys of figures call it.
    pub(crate) key: &'static str,
    mesh: Mesh,
    /// Its normals, with the relief and without, at the same texels.
    bent: MipChain<Normal<ObjectSpace>>,
    plain: MipChain<Normal<ObjectSpace>>,
    color: MipChain<LinearRgb>,
    repeat: [f32; 2],
    materials: [Material; 1],
    /// Azimuth and elevation of the eye, in radians.
    view: [f32; 2],
}

/// A picture of a specimen.
pub(crate) struct Frame {
    /// As it is shown, in sRGB; transparent where nothing is.
    pub(crate) shown: Picture,
    /// Intensities as they are, without gamma, as the paper's renderer writes them; black where nothing is.
    pub(crate) codes: Picture,
}

impl Specimen {
    /// All three, with maps `side` texels wide on each face; the world's is half as high.
    pub(crate) fn all(side: u32) -> Result<[Self; 3]> {
        let cube = shapes::cube(shapes::CubeUvs::Atlas)?;
        let sphere = shapes::sphere(128, 64)?;
        let (boards, bricks, world) = (sample::planks(side)?, sample::bricks(side)?, sample::globe(side)?);
        let flat = [1.0, 1.0];
        let atlas = shapes::CUBE_ATLAS_REPEAT;
        Ok([
            Self::new(["boards on a plane", "plane"], shapes::plane(1.0)?, &boards, (flat, [0.45, 0.3]))?,
            Self::new(["bricks on a cube", "cube"], cube, &bricks, (atlas, [0.6, 0.45]))?,
            Self::new(["a world on a sphere", "sphere"], sphere, &world, (flat, [0.5, 0.4]))?,
        ])
    }

    fn new(
        [name, key]: [&'static str; 2],
        mesh: Mesh,
        covering: &Covering,
        (repeat, view): ([f32; 2], [f32; 2]),
    ) -> Result<Self> {
        let (width, height) = covering.color.size();
        let options = Deflect { repeat, ..Deflect::new((width * repeat[0] as u32, height * repeat[1] as u32)) };
        let levels = |map: &rilievo::height::HeightMap| -> Result<_> {
            let bent = deflect_heights(&mesh, map, None, Filter::Plane4, Edges::Wrap, &options, &Silent)?;
            Ok(normal_levels(bent.normals, None, Some(&bent.covered))?.normals)
        };
        let level = rilievo::height::HeightMap::new(Grid::filled(width, height, 0.0)?, 1.0)?;
        let (bent, plain) = (levels(&covering.height)?, levels(&level)?);
        let material = Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(0.25), 20.0);
        let color = MipChain::from_picture(&covering.color);
        Ok(Self { name, key, mesh, bent, plain, color, repeat, materials: [material], view })
    }

    /// By the conventional method: Cartesian vectors, everything in floating point at each pixel.
    pub(crate) fn conventional(&self, side: u32) -> Result<Frame> {
        self.shoot(Detail::Object { normals: &self.bent, materials: None }, Method::Exact, side)
    }

    /// By a unit with tables of `width`.
    pub(crate) fn by_unit(&self, unit: UnitKind, width: Width, side: u32) -> Result<Frame> {
        let map = BumpVectorMap::from_object(unit, &self.bent, &self.plain)?;
        let detail = Detail::Bump { map: &map, repeat: Vec2::ONE, materials: None };
        self.shoot(detail, Method::Polar { unit, width }, side)
    }

    fn shoot(&self, detail: Detail<'_>, method: Method, side: u32) -> Result<Frame> {
        let [azimuth, elevation] = self.view;
        let camera = Camera::orbit(self.mesh.bounding_sphere(), azimuth, elevation, 1.02, 0.6, 1.0)?;
        let base = BaseColor { levels: &self.color, repeat: Vec2::from_array(self.repeat) };
        let object = Object { base_color: Some(base), ..Object::new(&self.mesh, detail, &self.materials) };
        let scene = Scene { objects: vec![object], lighting: lighting(), camera };
        let mut target = Target::new(side, side)?;
        // Words of units are looked up and not averaged, so that nobody's are.
        raster::draw(&raster::prepare(&scene, method, TextureFilter::Nearest)?, &mut target);
        let code = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
        let codes = Grid::from_fn(side, side, |x, y| {
            let lit = target.depth(x, y).map_or(LinearRgb::BLACK, |_| target.color(x, y));
            Rgba8::new(code(lit.r), code(lit.g), code(lit.b), 255)
        })?;
        Ok(Frame { shown: target.resolve(1, None)?, codes })
    }
}

/// A lamp far away at the upper right of the eye, and a little light from everywhere.
fn lighting() -> Lighting<World> {
    let lamp = Light::from_angles(0.6, 0.65, LinearRgb::WHITE);
    Lighting::new(LinearRgb::gray(0.12), vec![lamp])
}
