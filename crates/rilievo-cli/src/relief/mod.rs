//! From a surface and its maps, as the user names them, to what the renderer draws.

mod load;

use std::path::{Path, PathBuf};

use clap::Args;
use glam::Vec2;
use rilievo::light::Material;
use rilievo::normal::NormalLevels;
use rilievo::polar::{BumpVectorMap, Twist};
use rilievo::raster::{BaseColor, Detail};
use rilievo::sample::vase;
use rilievo::surface::Mesh;
use rilievo::{Edges, LinearRgb, MipChain, Object, QuantizedMap, Tangent};
use rilievo_io::SpaceKind;

use crate::args::{ConventionArg, EffortArg, Given, HeightArgs, MethodKind, OntoArgs, SpaceArg};
use crate::surface::{SURFACE_HELP, SurfaceArg};

pub(crate) use load::remark_overlaps;

/// Entries of the table unless told otherwise.
pub(crate) const DEFAULT_ENTRIES: u32 = 2048;
/// How many entries a table may have.
pub(crate) const ENTRIES: std::ops::RangeInclusive<u32> = 2..=65_536;

/// A surface and its maps: flags of the command line, and keys of a scene file's objects.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReliefArgs {
    #[arg(value_name = "MESH|SCENE", help = format!("{SURFACE_HELP}; or a scene file (.toml)"))]
    pub(crate) surface: SurfaceArg,
    /// A height map to emboss the surface with.
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    pub(crate) height: Option<PathBuf>,
    /// A normal map (see --space).
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    pub(crate) normals: Option<PathBuf>,
    /// A quantised map: indexed PNG or KTX2.
    #[arg(long, value_name = "MAP", group = "relief", help_heading = "Maps")]
    pub(crate) indexed: Option<PathBuf>,
    /// A base colour texture.
    #[arg(long, value_name = "PICTURE", help_heading = "Maps")]
    pub(crate) color: Option<PathBuf>,
    /// A map of material numbers, of the size of the normal map.
    #[arg(long, value_name = "MAP", help_heading = "Maps")]
    pub(crate) materials: Option<PathBuf>,
    /// The space of --normals, or of an --indexed palette made by another tool.
    #[arg(long, value_enum, default_value_t = SpaceArg::Tangent, help_heading = "Maps")]
    pub(crate) space: SpaceArg,
    /// Which way green points in --normals, or in an --indexed palette made by another tool.
    #[arg(long, value_enum, default_value_t = ConventionArg::Gl, help_heading = "Maps")]
    pub(crate) convention: ConventionArg,
    #[command(flatten, next_help_heading = "Maps")]
    pub(crate) heights: HeightArgs,
    #[command(flatten, next_help_heading = "Maps")]
    pub(crate) onto: OntoArgs,
    /// Entries of the table (method table).
    #[arg(short = 'n', long, value_name = "K", default_value_t = DEFAULT_ENTRIES, value_parser = clap::value_parser!(u32).range(2..=65536))]
    pub(crate) entries: u32,
    /// How hard the quantiser tries.
    #[arg(long, value_enum, default_value_t = EffortArg::Normal)]
    pub(crate) effort: EffortArg,
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
    Bump { map: BumpVectorMap, repeat: [f32; 2], materials: Option<MipChain<u8>> },
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
            OwnedDetail::Bump { map, repeat, materials } => {
                Detail::Bump { map, repeat: Vec2::from_array(*repeat), materials: materials.as_ref() }
            }
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
            OwnedDetail::Bump { materials, .. } => highest(materials),
        };
        usize::from(highest.unwrap_or(0)) + 1
    }
}

impl ReliefArgs {
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

    fn warn_of_unused(&self, kind: MethodKind, given: &Given) {
        let has_no_map = self.has_no_map();
        let vase = self.surface == SurfaceArg::Vase && has_no_map;
        if self.normals.is_none() && self.indexed.is_none() {
            given.unused(&["space", "convention"], "they are for normal maps and index maps");
        }
        if self.height.is_none() && !vase {
            given.unused(&["depth", "filter"], "they are for height maps");
        }
        let tangent = self.normals.is_some() && SpaceKind::from(self.space) == SpaceKind::Tangent;
        let bent = match kind {
            MethodKind::Vectors => false,
            MethodKind::Exact => self.height.is_some() || vase,
            // The mesh's own normals are, with whatever map there is.
            MethodKind::Polar(unit) => self.height.is_some() || vase || (tangent && unit.twist() == Twist::Baked),
            MethodKind::Table | MethodKind::Static => self.height.is_some() || has_no_map || tangent,
        };
        if !bent {
            given.unused(&["map_size", "gutter"], "no map is bent onto the mesh");
        }
        if self.indexed.is_some() {
            given.unused(&["entries", "effort"], "the map is quantised already");
        } else if kind != MethodKind::Table {
            given.unused(&["entries", "effort"], "only the table method needs a table");
        }
    }
}
