//! How height maps are read, and how maps are bent onto meshes.

use anyhow::Result;
use clap::Args;
use rilievo::Edges;
use rilievo::height::Filter;
use rilievo::surface::Deflect;

use super::{EdgesArg, FilterArg, SizeArg, pair};
use crate::surface::SurfaceArg;

/// Widest object-space map that is made unless the user asks for more.
const DEFAULT_MAX_WIDTH: f32 = 4096.0;

/// Height of full white unless told otherwise, as a fraction of the map's width.
pub(crate) const DEFAULT_DEPTH: f32 = 0.05;
/// Texels that charts are grown by unless told otherwise.
pub(crate) const DEFAULT_GUTTER: u32 = 8;

/// The scale and slopes of height maps.
#[derive(Debug, Clone, Args)]
pub(crate) struct HeightArgs {
    /// Height of full white, as a fraction of the map's width; negative if white is deep. The vase has its own.
    #[arg(long, value_name = "D", default_value_t = DEFAULT_DEPTH, allow_hyphen_values = true)]
    pub(crate) depth: f32,
    /// How slopes are estimated.
    #[arg(long, value_enum, default_value_t = FilterArg::Plane4)]
    pub(crate) filter: FilterArg,
    /// What lies beyond the border of the map.
    #[arg(long, value_enum, default_value_t = EdgesArg::Wrap)]
    pub(crate) edges: EdgesArg,
}

impl HeightArgs {
    pub(crate) fn filter(&self) -> Filter {
        self.filter.into()
    }

    pub(crate) fn edges(&self) -> Edges {
        self.edges.into()
    }
}

/// Object-space maps made on a mesh.
#[derive(Debug, Clone, Args)]
pub(crate) struct OntoArgs {
    /// How often the map repeats over the mesh's texture square [default: 1,1; cube: 3,2, a whole map on each face].
    #[arg(long, value_name = "U,V", value_parser = pair)]
    pub(crate) repeat: Option<[f32; 2]>,
    /// Size of the object-space map [default: the source's size times --repeat, at most 4096 wide].
    #[arg(long, value_name = "WxH")]
    pub(crate) map_size: Option<SizeArg>,
    /// Texels that charts are grown by, so that filtering does not bleed.
    #[arg(long, value_name = "TEXELS", default_value_t = DEFAULT_GUTTER)]
    pub(crate) gutter: u32,
}

impl OntoArgs {
    /// How often maps repeat on this surface.
    pub(crate) fn repeat(&self, onto: &SurfaceArg) -> [f32; 2] {
        self.repeat.unwrap_or_else(|| onto.default_repeat())
    }

    /// The options for a source map of this size.
    pub(crate) fn options(&self, onto: &SurfaceArg, (width, height): (u32, u32)) -> Result<Deflect> {
        let repeat = self.repeat(onto);
        let size = self.map_size.map_or_else(
            || {
                let (w, h) = (width as f32 * repeat[0], height as f32 * repeat[1]);
                let shrink = (DEFAULT_MAX_WIDTH.max(width as f32) / w).min(1.0);
                let side = |s: f32| (s * shrink).round().max(1.0) as u32;
                (side(w), side(h))
            },
            |s| (s.width, s.height),
        );
        Ok(Deflect { size, gutter: self.gutter, repeat })
    }
}
