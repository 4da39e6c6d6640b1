//! The fast renderer: tiles of 64 × 64 pixels, blocks of 4 × 4, sixteen lanes.
//!
//! A frame runs in two steps. The `front` projects vertices sixteen at a time and sorts triangles into tiles; then each tile
//! is drawn by itself, depth and colour in the nearest cache, and copied to the picture once. Within a tile it is first found out
//! which triangle is seen where (`visible`): row by row of blocks, which may have pixels inside, which lie inside altogether
//! (`cover`), which are hidden. Then each block of sixteen pixels is shaded (`batch`) by the method's room in `shade`, once, whatever
//! triangles meet in it: hidden pixels cost no light, and fine meshes leave no lanes idle.
//!
//! One source serves every instruction set; which one is chosen once for each tile. Coverage is that of the reference to the
//! pixel, by the same snapped vertices and the same whole numbers; colours are within a tolerance that
//! `dev/testkit/tests/renderers` states.
//!
//! - **Determinism:** class C; on one machine the same bits for any number of threads.

mod batch;
mod buffer;
mod cover;
mod front;
mod group;
mod maps;
mod planes;
mod samples;
mod shade;
mod texture;
mod visible;

pub use front::Skipped;
pub use samples::Samples;

use fearless_simd::Level;
use glam::Vec2;

use self::batch::{Batch, Shaded};
use self::buffer::{TILE, Tile, word};
use self::front::{Front, Tiles};
use self::maps::{Map, Maps, detail_map, materials_map};
use self::shade::{
    Base, Exact, Filtered, Finish, General, Glossy, Nearest, NormalTexture, Pixelwise, Relief, Shades, Static, Terms,
    Vectors,
};
use self::texture::Look;
use self::visible::Owners;
use crate::color::{LinearRgb, Picture, Rgba8};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::light::{Material, Prepared};
use crate::par;
use crate::raster::frame::{Shading, shading};
use crate::raster::project::{MAX_PICTURE_SIDE, Projection};
use crate::raster::scene::{Detail, Method, Object, Scene};
use crate::raster::texture::{Sampling, TextureFilter};

/// The longest side of a picture that [`Renderer::draw`] takes, in pixels.
pub const MAX_SIDE: u32 = MAX_PICTURE_SIDE;

/// What a frame is drawn with.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// How normals become colours.
    pub method: Method,
    /// How a pixel gathers texels.
    pub filter: TextureFilter,
    /// How many places of a pixel are looked at.
    pub samples: Samples,
    /// What shows where nothing is drawn; transparent without it.
    pub background: Option<LinearRgb>,
}

/// What came of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Drawn {
    /// Pixels that something was drawn on.
    pub covered_pixels: u64,
    /// Triangles that were left out.
    pub skipped: Skipped,
}

/// Draws frames, and keeps between them what need not be made anew: maps in the form that lanes read, memory.
#[derive(Debug)]
pub struct Renderer<'a> {
    maps: Maps<'a>,
    fronts: Vec<Front>,
    level: Level,
}

impl Default for Renderer<'_> {
    fn default() -> Self {
        Self { maps: Maps::default(), fronts: Vec::new(), level: Level::new() }
    }
}

impl<'a> Renderer<'a> {
    /// A renderer that has seen nothing yet; it uses the best instruction set of the machine.
    pub fn new() -> Self {
        Self::default()
    }

    /// A renderer on a given instruction set: to compare them.
    pub fn with_level(level: Level) -> Self {
        Self { level, ..Self::default() }
    }

    /// Draws `scene` over all of `picture`.
    ///
    /// Triangles come in the order of the objects and their meshes; of two surfaces at exactly the same depth the first
    /// stays.
    ///
    /// # Errors
    /// As [`crate::raster::prepare`], and [`Error::Parameter`] for a picture with a side above [`MAX_SIDE`].
    pub fn draw(&mut self, scene: &Scene<'a>, options: &Options, picture: &mut Picture) -> Result<Drawn> {
        let size = picture.size();
        if size.0.max(size.1) > MAX_PICTURE_SIDE {
            let given = format_args!("{} × {}", size.0, size.1).to_string();
            return Err(Error::parameter("picture size", given, format_args!("at most {MAX_PICTURE_SIDE} a side")));
        }
        for object in &scene.objects {
            self.maps.read(object, options.filter);
        }
        self.fronts.resize_with(scene.objects.len(), Front::default);
        let mut drawn = Drawn::default();
        let (maps, level) = (&self.maps, self.level);
        let mut batches: Vec<Box<dyn Batch + '_>> = Vec::with_capacity(scene.objects.len());
        for (object, front) in scene.objects.iter().zip(&mut self.fronts) {
            let projection = Projection::new(&scene.camera, &object.pose, size);
            let place = Place { level, object, projection, size: (size, options.samples), front };
            batches.push(choose(scene, options, maps, place, &mut drawn.skipped)?);
        }
        let background = word(options.background.map_or(Rgba8::default(), LinearRgb::to_srgb));
        drawn.covered_pixels = draw_tiles(&batches, level, (background, options.samples), picture);
        Ok(drawn)
    }
}

fn draw_tiles(
    batches: &[Box<dyn Batch + '_>],
    level: Level,
    (background, samples): (u32, Samples),
    picture: &mut Picture,
) -> u64 {
    let tiles = Tiles::new(picture.size(), samples);
    let width = picture.width() as usize;
    let covered = std::sync::atomic::AtomicU64::new(0);
    par::for_each_row(picture.texels_mut(), width * TILE, |row, pixels| {
        let mut sum = 0;
        let (mut tile, mut owners, mut ranges) = (Tile::new(samples), Owners::new(), Vec::new());
        for column in 0..tiles.columns {
            let origin = [column as usize * TILE, row * TILE];
            let number = row * tiles.columns as usize + column as usize;
            let mut touching = batches.iter().filter(|batch| batch.front().touches(number)).peekable();
            if touching.peek().is_none() {
                for row in pixels.chunks_mut(width) {
                    let row: &mut [u32] = bytemuck::cast_slice_mut(&mut row[origin[0]..(origin[0] + TILE).min(width)]);
                    row.fill(background);
                }
                continue;
            }
            tile.clear(level, background);
            owners.clear();
            ranges.clear();
            for batch in touching {
                let first = owners.len();
                batch.front().cover(level, &mut tile, &mut owners, number, origin.map(|o| o as i32));
                ranges.push((batch, first..owners.len()));
            }
            for (batch, range) in &ranges {
                if !range.is_empty() {
                    batch.shade(level, &mut tile, &owners[range.clone()], range.start as u32 + 1);
                }
            }
            sum += tile.copy_to(level, pixels, width, origin[0]);
        }
        covered.fetch_add(sum, std::sync::atomic::Ordering::Relaxed);
    });
    covered.into_inner()
}

/// Where an object goes.
struct Place<'f, 'o> {
    level: Level,
    object: &'o Object<'o>,
    projection: Projection,
    size: ((u32, u32), Samples),
    front: &'f mut Front,
}

impl<'f> Place<'f, '_> {
    /// Projects and bins the object for a shader.
    fn with<'s, Sh: batch::Shader<N> + 's, const N: usize>(
        self,
        shader: Sh,
        skipped: &mut Skipped,
    ) -> Box<dyn Batch + 's>
    where
        'f: 's,
    {
        let found =
            self.front.run(self.level, self.object, &self.projection, self.size, |v, w| shader.attributes(v, w));
        skipped.add(found);
        Box::new(Shaded { front: &*self.front, shader })
    }
}

/// Lanes look a block of pixels up once for each material; where there are more, pixels are shaded one by one.
const MOST_MATERIALS: usize = 16;

/// The shader of an object: one with lanes where there is one, the reference pixel by pixel otherwise.
fn choose<'s>(
    scene: &'s Scene<'_>,
    options: &Options,
    maps: &'s Maps<'_>,
    place: Place<'s, 's>,
    skipped: &mut Skipped,
) -> Result<Box<dyn Batch + 's>> {
    let object = place.object;
    let look = |repeat| Look { filter: options.filter, edges: object.edges, repeat };
    let read = |map: &Map<'_>| maps.find(map, options.filter).expect("invariant: all maps of the scene were read");
    let base = object.base_color.map(|base| Base { texture: read(&Map::Colors(base.levels)), look: look(base.repeat) });
    let finish = Finish { base, blend: object.blend };
    let with_levels = options.filter == TextureFilter::Trilinear;
    let shading = shading(scene, object, options.method)?;
    let material_numbers = materials_map(&object.detail).map(|map| read(&map));
    let normals = |texture, look| NormalTexture { texture, look, materials: material_numbers };
    let map = detail_map(&object.detail).map(|map| read(&map));
    match (shading, map) {
        (Shading::Table(table), Some(indices)) => {
            let (front, back) = (table.front(), table.back());
            if options.filter == TextureFilter::Nearest && base.is_none() {
                return Ok(place.with(Nearest::new(indices, look(Vec2::ONE), front, back, object.blend), skipped));
            }
            Ok(place.with(
                Filtered {
                    indices,
                    look: look(Vec2::ONE),
                    shades: Shades::new(front, back, base.is_none().then_some(object.blend)),
                    finish,
                },
                skipped,
            ))
        }
        (Shading::Exact(exact), map) => {
            let relief = match (object.detail, map) {
                (Detail::Smooth, _) => Some((Relief::Smooth, &object.materials[..1])),
                (Detail::Tangent { repeat, .. }, Some(t)) => {
                    Some((Relief::Tangent(normals(t, look(repeat))), used(object)))
                }
                (Detail::Object { .. }, Some(t)) => Some((Relief::Object(normals(t, look(Vec2::ONE))), used(object))),
                (Detail::Indexed(map), Some(t)) => {
                    let table = map.table();
                    let words = table.normals().iter().zip(0..=u16::MAX).flat_map(|(normal, i)| {
                        let [x, y, z] = normal.vec().to_array().map(f32::to_bits);
                        [x, y, z, u32::from(table.material_of(i))]
                    });
                    Some((Relief::Indexed(t, look(Vec2::ONE), words.collect()), object.materials))
                }
                _ => None,
            };
            let relief = relief.filter(|(_, materials)| materials.len() <= MOST_MATERIALS);
            let Some((relief, materials)) = relief else {
                return Ok(pixelwise(Shading::Exact(exact), place, options, skipped));
            };
            let (lighting, eye) = (exact.lighting(), exact.eye());
            if let [only] = materials
                && let Some(answer) = Glossy::new(only, lighting, eye)
            {
                let answers = vec![answer];
                return Ok(place.with(Exact { relief, answers, eye, finish, with_levels }, skipped));
            }
            let answer = |material| General { material: Prepared::new(material, lighting), eye };
            let answers = materials.iter().map(answer).collect();
            Ok(place.with(Exact { relief, answers, eye, finish, with_levels }, skipped))
        }
        (Shading::Interpolated(interpolated), map) => {
            let relief = match (object.detail, map) {
                (Detail::Tangent { repeat, .. }, Some(t)) => Some(normals(t, look(repeat))),
                _ => None,
            };
            let materials = if relief.is_some() { used(object) } else { &object.materials[..1] };
            let terms: Option<Vec<Terms>> = materials.iter().map(|m| Terms::new(m, interpolated.lighting())).collect();
            match terms.filter(|terms| terms.len() <= MOST_MATERIALS) {
                Some(terms) => {
                    let vertices = interpolated.vertices();
                    let (mesh, shading) = (object.mesh, interpolated);
                    if terms.len() == 1 {
                        let one: Vectors<'_, false> =
                            Vectors { relief, shading, vertices, mesh, terms, finish, with_levels };
                        return Ok(place.with(one, skipped));
                    }
                    let many: Vectors<'_, true> =
                        Vectors { relief, shading, vertices, mesh, terms, finish, with_levels };
                    Ok(place.with(many, skipped))
                }
                None => Ok(pixelwise(Shading::Interpolated(interpolated), place, options, skipped)),
            }
        }
        (Shading::Static(_), Some(shades)) => Ok(place.with(Static { shades, look: look(Vec2::ONE), finish }, skipped)),
        (shading, _) => Ok(pixelwise(shading, place, options, skipped)),
    }
}

/// The materials that the texels of an object's map may name.
fn used<'a>(object: &Object<'a>) -> &'a [Material] {
    if materials_map(&object.detail).is_some() { object.materials } else { &object.materials[..1] }
}

fn pixelwise<'s>(
    shading: Shading<'s>,
    place: Place<'s, 's>,
    options: &Options,
    skipped: &mut Skipped,
) -> Box<dyn Batch + 's> {
    let object = place.object;
    let sampling = Sampling { filter: options.filter, edges: object.edges, repeat: Vec2::ONE };
    let vertices = match &shading {
        Shading::Interpolated(interpolated) => Some(interpolated.vertices()),
        _ => None,
    };
    place.with(Pixelwise { object, shading, sampling, vertices }, skipped)
}

/// An empty picture to draw into.
///
/// # Errors
/// [`Error::Size`] for an impossible size.
pub fn empty_picture(width: u32, height: u32) -> Result<Picture> {
    Grid::filled(width, height, Rgba8::default())
}
