//! Height maps and the normals of their surface.
//! (contract; the owner of this folder replaces it)
use crate::{Edges, Grid, Normal, NormalMap, Result, Tangent};

/// Heights over a flat rectangle, with their physical scale.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    heights: Grid<f32>,
    depth: f32,
}

impl HeightMap {
    /// `heights` 0 … 1 (white is up); `depth` is the height of full white as a fraction of the map's width.
    ///
    /// # Errors
    /// x
    pub fn new(heights: Grid<f32>, depth: f32) -> Result<Self> {
        Ok(Self { heights, depth })
    }
    /// Relative heights.
    pub fn heights(&self) -> &Grid<f32> {
        &self.heights
    }
    /// Height of full white as a fraction of the width.
    pub fn depth(&self) -> f32 {
        self.depth
    }
}

/// How the slope of a texel is estimated from its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    /// Least-squares plane over the 4 nearest neighbours.
    #[default]
    Plane4,
    /// Least-squares plane over the 8 nearest neighbours.
    Plane8,
    /// Sobel 3 × 3.
    Sobel,
    /// Scharr 3 × 3.
    Scharr,
}

/// Slopes in heights of the physical scale per texel-width unit: (dh/dx to the right, dh/dy UP the picture).
pub fn slopes(map: &HeightMap, filter: Filter, edges: Edges) -> Grid<[f32; 2]> {
    let _ = (filter, edges);
    map.heights.map(|_| [0.0; 2])
}

/// Normals of the surface.
pub fn to_normals(map: &HeightMap, filter: Filter, edges: Edges) -> NormalMap<Tangent> {
    let _ = (filter, edges);
    map.heights.map(|_| Normal::Z)
}
