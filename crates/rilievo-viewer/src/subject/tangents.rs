//! Normals of the texture's frame.

use std::sync::OnceLock;

use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::{Edges, Grid, MaterialMap, Tangent};

/// A height map with what lies on it.
pub(crate) struct Heights {
    /// The heights.
    pub(crate) map: HeightMap,
    /// The materials, of the same size.
    pub(crate) materials: Option<MaterialMap>,
    /// Where the heights mean something, of the same size.
    pub(crate) covered: Option<Grid<bool>>,
}

/// Normals of the texture's frame with their mip levels. Those of a height map are made when they are first asked for: the table
/// does without, and a page would have to carry six times as many bytes to its worker's master.
pub struct Tangents {
    /// Nothing if the levels are there.
    heights: Option<Heights>,
    levels: OnceLock<NormalLevels<Tangent>>,
}

impl Tangents {
    /// Levels that are there.
    pub(crate) fn of_levels(levels: NormalLevels<Tangent>) -> Self {
        Self { heights: None, levels: levels.into() }
    }

    /// Levels to be made of heights.
    ///
    /// # Errors
    /// If what lies on them has another size.
    pub(crate) fn of_heights(heights: Heights) -> rilievo::Result<Self> {
        let size = heights.map.heights();
        heights.materials.as_ref().map_or(Ok(()), |m| size.expect_same_size("the material map", m))?;
        heights.covered.as_ref().map_or(Ok(()), |c| size.expect_same_size("the coverage", c))?;
        Ok(Self { heights: Some(heights), levels: OnceLock::new() })
    }

    /// What they are made of, if it is heights: this is what goes to a page.
    #[cfg(any(target_arch = "wasm32", test))]
    pub(crate) fn heights(&self) -> Option<&Heights> {
        self.heights.as_ref()
    }

    /// The levels.
    pub fn levels(&self) -> &NormalLevels<Tangent> {
        self.levels.get_or_init(|| {
            let heights = self.heights.as_ref().expect("invariant: there are levels or heights");
            let normals = to_normals(&heights.map, Filter::Plane4, Edges::Wrap);
            normal_levels(normals, heights.materials.clone(), heights.covered.as_ref())
                .expect("invariant: the sizes were compared")
        })
    }
}
