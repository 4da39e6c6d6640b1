//! From a surface and its maps, as the user names them, to what the renderer draws.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use glam::Vec2;
use rilievo::height::HeightMap;
use rilievo::light::Material;
use rilievo::normal::{NormalLevels, NormalMap, normal_levels};
use rilievo::quantize::{self, Effort, Options};
use rilievo::raster::{BaseColor, Detail, Method};
use rilievo::sample::vase;
use rilievo::surface::{Deflected, Mesh, deflect_heights, deflect_normals};
use rilievo::{Edges, Grid, LinearRgb, MaterialMap, MipChain, Object, QuantizedMap, Tangent};
use rilievo_io::{AnyIndexed, ImportAs, SpaceKind};

use crate::args::{ConventionArg, EffortArg, Given, HeightArgs, OntoArgs, SpaceArg};
use crate::exit::usage;
use crate::progress::Bars;
use crate::surface::{SURFACE_HELP, SurfaceArg};
use crate::{exit, inputs};

/// Width of the maps of the built-in vase.
const VASE_WIDTH: u32 = 2048;

/// A surface and its maps.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReliefArgs {
    #[arg(value_name = "MESH", help = SURFACE_HELP)]
    pub(crate) surface: SurfaceArg,
    /// A height map to emboss the surface with.
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    height: Option<PathBuf>,
    /// A normal map (see --space).
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    normals: Option<PathBuf>,
    /// A quantised map: indexed PNG or KTX2.
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    indexed: Option<PathBuf>,
    /// A base colour texture.
    #[arg(long, value_name = "PICTURE", help_heading = "Maps")]
    color: Option<PathBuf>,
    /// A map of material numbers, of the size of the normal map.
    #[arg(long, value_name = "MAP", help_heading = "Maps")]
    materials: Option<PathBuf>,
    /// The space of --normals, or of an --indexed palette made by another tool.
    #[arg(long, value_enum, default_value_t = SpaceArg::Tangent, help_heading = "Maps")]
    space: SpaceArg,
    /// Which way green points in --normals, or in an --indexed palette made by another tool.
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl, help_heading = "Maps")]
    convention: ConventionArg,
    #[command(flatten, next_help_heading = "Maps")]
    heights: HeightArgs,
    #[command(flatten, next_help_heading = "Maps")]
    onto: OntoArgs,
    /// Entries of the table (method table).
    #[arg(short = 'n', long, value_name = "K", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(2..=65536))]
    entries: u32,
    /// How hard the quantiser tries.
    #[arg(long, value_enum, default_value_t = EffortArg::Normal)]
    effort: EffortArg,
}

/// Everything the renderer needs of an object, owned.
pub(crate) struct Relief {
    pub(crate) mesh: Mesh,
    detail: OwnedDetail,
    base_color: Option<(MipChain<LinearRgb>, [f32; 2])>,
    pub(crate) default_materials: DefaultMaterials,
    /// How the table was made, if it was made here.
    pub(crate) quantized: Option<QuantizedReport>,
}

/// Error and time of a quantisation.
pub(crate) struct QuantizedReport {
    pub(crate) entries: usize,
    pub(crate) error: rilievo::measure::AngleStats,
    pub(crate) seconds: f64,
}

/// The materials that go with a surface if the user says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DefaultMaterials {
    Plain,
    Vase,
}

impl DefaultMaterials {
    /// The default of material `number`.
    pub(crate) fn material(self, number: usize) -> Material {
        match self {
            Self::Vase => vase::materials_over_color().get(number).cloned().unwrap_or_default(),
            Self::Plain => Material::default(),
        }
    }
}

enum OwnedDetail {
    Smooth,
    Tangent { levels: NormalLevels<Tangent>, repeat: [f32; 2] },
    Object { levels: NormalLevels<Object> },
    Indexed(Box<QuantizedMap<Object>>),
}

impl Relief {
    /// The detail as the renderer takes it.
    pub(crate) fn detail(&self) -> Detail<'_> {
        match &self.detail {
            OwnedDetail::Smooth => Detail::Smooth,
            OwnedDetail::Tangent { levels, repeat } => Detail::Tangent {
                normals: &levels.normals,
                repeat: Vec2::from_array(*repeat),
                materials: levels.materials.as_ref(),
            },
            OwnedDetail::Object { levels } => {
                Detail::Object { normals: &levels.normals, materials: levels.materials.as_ref() }
            }
            OwnedDetail::Indexed(map) => Detail::Indexed(map),
        }
    }

    /// The base colour as the renderer takes it.
    pub(crate) fn base_color(&self) -> Option<BaseColor<'_>> {
        self.base_color.as_ref().map(|(levels, repeat)| BaseColor { levels, repeat: Vec2::from_array(*repeat) })
    }

    /// How many materials the maps name.
    pub(crate) fn material_count(&self) -> usize {
        let highest = |m: &Option<MipChain<u8>>| m.as_ref().and_then(|m| m.base().texels().iter().max().copied());
        let highest = match &self.detail {
            OwnedDetail::Smooth => None,
            OwnedDetail::Tangent { levels, .. } => highest(&levels.materials),
            OwnedDetail::Object { levels } => highest(&levels.materials),
            OwnedDetail::Indexed(map) => map.table().spans().last().map(|s| s.material),
        };
        usize::from(highest.unwrap_or(0)) + 1
    }
}

/// What was read, before it is bent, quantised or filtered.
enum Source {
    Nothing,
    /// Normals of the object, where they are true, and materials.
    Object {
        normals: NormalMap<Object>,
        covered: Option<Grid<bool>>,
    },
    Tangent {
        normals: NormalMap<Tangent>,
        covered: Option<Grid<bool>>,
    },
    Indexed(AnyIndexed),
}

impl ReliefArgs {
    /// Reads, bends and quantises what `method` needs.
    pub(crate) fn load(&self, method: Method, given: &Given) -> Result<Relief> {
        self.warn_of_unused(method, given);
        let progress = Bars::new(self.surface.stem());
        let samples =
            (self.surface == SurfaceArg::Vase).then(|| progress.step("drawing the maps", || vase::maps(VASE_WIDTH)));
        let samples = samples.transpose()?;
        let own_relief = self.has_no_map();
        if samples.is_some() && own_relief && (given.has("repeat") || given.has("map_size")) {
            return Err(usage(
                "the vase's own maps fit each other as they are; --repeat and --map-size are for maps you give",
            ));
        }
        let mut materials: Option<MaterialMap> = self.materials.as_deref().map(inputs::materials).transpose()?;
        if own_relief && materials.is_none() {
            materials = samples.as_ref().map(|s| s.materials.clone());
        }
        let (mesh, source) = self.load_source(method, given, samples.as_ref(), &progress)?;
        let repeat = self.onto.repeat(&self.surface);
        let color = match (&self.color, &samples) {
            (Some(path), _) => Some(inputs::picture(path)?),
            (None, Some(samples)) => Some(samples.color.clone()),
            (None, None) => None,
        };
        let base_color = color.map(|picture| (MipChain::from_picture(&picture), repeat));
        let (detail, quantized) = self.finish(method, &mesh, source, materials, repeat, &progress)?;
        let default_materials = if samples.is_some() { DefaultMaterials::Vase } else { DefaultMaterials::Plain };
        Ok(Relief { mesh, detail, base_color, default_materials, quantized })
    }

    /// Files this reads.
    pub(crate) fn files(&self) -> Vec<&Path> {
        let maps = [&self.height, &self.normals, &self.indexed, &self.color, &self.materials];
        maps.into_iter().filter_map(Option::as_deref).chain(self.surface.path()).collect()
    }

    /// What maps continue with beyond the texture square. A map that repeats over it has no edge there.
    pub(crate) fn edges(&self) -> Edges {
        if self.onto.repeat(&self.surface) == [1.0, 1.0] { self.heights.edges() } else { Edges::Wrap }
    }

    fn has_no_map(&self) -> bool {
        self.height.is_none() && self.normals.is_none() && self.indexed.is_none()
    }

    fn warn_of_unused(&self, method: Method, given: &Given) {
        let vase = self.surface == SurfaceArg::Vase && self.has_no_map();
        if self.normals.is_none() && self.indexed.is_none() {
            given.unused(&["space", "convention"], "they are for --normals and --indexed");
        }
        if self.height.is_none() && !vase {
            given.unused(&["depth", "filter"], "they are for --height");
        }
        let object_space = SpaceKind::from(self.space) == SpaceKind::Object;
        let bent =
            self.height.is_some() || vase || (self.normals.is_some() && !object_space && method == Method::Table);
        if !bent {
            given.unused(&["map_size", "gutter"], "no map is bent onto the mesh");
        }
        if self.indexed.is_some() {
            given.unused(&["entries", "effort"], "the map is quantised already");
        } else if method == Method::Exact {
            given.unused(&["entries", "effort"], "the exact method needs no table");
        }
    }

    fn load_source(
        &self,
        method: Method,
        given: &Given,
        samples: Option<&vase::VaseMaps>,
        progress: &Bars,
    ) -> Result<(Mesh, Source)> {
        if let Some(path) = &self.height {
            let (map, covered) = inputs::height_map(path, self.heights.depth)?;
            let mesh = self.surface.load(map.heights().size())?;
            let options = self.onto.options(&self.surface, map.heights().size())?;
            let (filter, edges) = (self.heights.filter(), self.heights.edges());
            let bent_map = deflect_heights(&mesh, &map, covered.as_ref(), filter, edges, &options, progress)?;
            return Ok((mesh, bent(bent_map)));
        }
        if let Some(path) = &self.normals {
            if SpaceKind::from(self.space) == SpaceKind::Object {
                let image = inputs::normals::<Object>(path, self.convention.into(), false)?;
                let mesh = self.surface.load(image.normals.size())?;
                return Ok((mesh, Source::Object { normals: image.normals, covered: image.covered }));
            }
            let image = inputs::normals::<Tangent>(path, self.convention.into(), false)?;
            let mesh = self.surface.load(image.normals.size())?.with_tangents();
            let mesh = mesh.with_context(|| self.surface.stem())?;
            if method == Method::Exact {
                return Ok((mesh, Source::Tangent { normals: image.normals, covered: image.covered }));
            }
            let options = self.onto.options(&self.surface, image.normals.size())?;
            let deflected = deflect_normals(&mesh, &image.normals, image.covered.as_ref(), &options, progress)?;
            return Ok((mesh, bent(deflected)));
        }
        if let Some(path) = &self.indexed {
            let source = inputs::open(path)?;
            // For palettes made by other tools; our own files know.
            let import = ImportAs {
                space: given.has("space").then(|| self.space.into()),
                convention: given.has("convention").then(|| self.convention.into()),
            };
            let map = inputs::indexed(&source, &import)?.map;
            return Ok((self.surface.load(map.size())?, Source::Indexed(map)));
        }
        if let Some(samples) = samples {
            let mesh = self.surface.load((1, 1))?;
            let options = self.onto.options(&self.surface, samples.height.heights().size())?;
            let depth = if given.has("depth") { self.heights.depth } else { samples.height.depth() };
            let map = HeightMap::new(samples.height.heights().clone(), depth)?;
            let (filter, edges) = (self.heights.filter(), self.heights.edges());
            let deflected = deflect_heights(&mesh, &map, None, filter, edges, &options, progress)?;
            return Ok((mesh, bent(deflected)));
        }
        Ok((self.surface.load((1, 1))?, Source::Nothing))
    }

    fn finish(
        &self,
        method: Method,
        mesh: &Mesh,
        source: Source,
        materials: Option<MaterialMap>,
        repeat: [f32; 2],
        progress: &Bars,
    ) -> Result<(OwnedDetail, Option<QuantizedReport>)> {
        if materials.is_some() && matches!(source, Source::Nothing | Source::Indexed(_)) {
            return Err(usage("--materials goes with --height or --normals; an indexed map has its own materials"));
        }
        match source {
            Source::Nothing if method == Method::Table => {
                Err(usage("the table method needs a map: give --height, --normals or --indexed, or use --method exact"))
            }
            Source::Nothing => Ok((OwnedDetail::Smooth, None)),
            Source::Indexed(AnyIndexed::Object(map)) => Ok((OwnedDetail::Indexed(Box::new(map)), None)),
            Source::Indexed(AnyIndexed::Tangent(map)) => {
                let flat = mesh.clone().with_tangents()?.constant_frame();
                let frame = flat.ok_or_else(|| {
                    usage(
                        "a tangent-space index map can only lie on a flat surface; make an object-space map for this \
                         mesh with `rilievo normal --from normal --onto MESH` and quantise that",
                    )
                })?;
                Ok((OwnedDetail::Indexed(Box::new(map.map_normals(|n| frame.to_object(n)))), None))
            }
            Source::Tangent { normals, covered } => {
                let materials = fitted(materials, normals.size(), "normal map")?;
                Ok((
                    OwnedDetail::Tangent { levels: normal_levels(normals, materials, covered.as_ref())?, repeat },
                    None,
                ))
            }
            Source::Object { normals, covered } if method == Method::Table => {
                let materials = fitted(materials, normals.size(), "object-space map")?;
                let options = Options {
                    entries: self.entries,
                    effort: Effort::from(self.effort),
                    materials: materials.as_ref(),
                    covered: covered.as_ref(),
                    mip_levels: true,
                    ..Options::default()
                };
                let started = Instant::now();
                let quantized = quantize::quantize(&normals, &options, progress)?;
                let seconds = started.elapsed().as_secs_f64();
                let entries = quantized.map.table().len();
                let report = QuantizedReport { entries, error: quantized.error, seconds };
                Ok((OwnedDetail::Indexed(Box::new(quantized.map)), Some(report)))
            }
            Source::Object { normals, covered } => {
                let materials = fitted(materials, normals.size(), "object-space map")?;
                Ok((OwnedDetail::Object { levels: normal_levels(normals, materials, covered.as_ref())? }, None))
            }
        }
    }
}

fn bent(deflected: Deflected) -> Source {
    remark_overlaps(&deflected);
    Source::Object { normals: deflected.normals, covered: Some(deflected.covered) }
}

/// Tells of texels that belong to several triangles.
pub(crate) fn remark_overlaps(deflected: &Deflected) {
    if deflected.overlaps > 0 {
        let message = format!(
            "{} texels belong to several triangles (mirrored or overlapping UVs); an object-space map can only serve one",
            deflected.overlaps
        );
        exit::warn("texture coordinates", &message);
    }
}

/// A material map of the size of the map it goes with.
fn fitted(materials: Option<MaterialMap>, size: (u32, u32), what: &str) -> Result<Option<MaterialMap>> {
    let Some(map) = materials else { return Ok(None) };
    if map.size() == size {
        return Ok(Some(map));
    }
    let ((w, h), (mw, mh)) = (size, map.size());
    Err(usage(format!(
        "the material map is {mw} x {mh}, but the {what} is {w} x {h}; give both the same size (see --map-size)"
    )))
}
