//! Height maps and the normals of their surface.
//!
//! Source: Tarini, Cignoni, Rocchini, Scopigno 2000, "Real time, accurate, multi-featured rendering of bump mapped
//! surfaces", §4.1: the plane of least squares through a texel and its q neighbours. Every filter here is such a plane,
//! weighted: that is what Sobel and Scharr are too, and it says what to do where neighbours are missing.

mod lanes;
mod packed;
mod plane;

pub use packed::pack_normals;

use plane::PlaneFit;

use crate::error::{Error, Result};
use crate::grid::{Edges, Grid};
use crate::normal::{Normal, NormalMap, Tangent};
use crate::par;

/// The largest height, relative or scaled to texels, that a [`HeightMap`] accepts. Squares of slopes stay finite.
pub const MAX_HEIGHT: f32 = 1e18;

/// Heights over a flat rectangle, with their physical scale.
///
/// Texels are squares with side 1 / width; the map is one unit wide.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    heights: Grid<f32>,
    depth: f32,
}

impl HeightMap {
    /// Relative `heights`, white (1) up: integer files give 0 … 1, float files anything finite.
    ///
    /// `depth` is how far height 1 lies above height 0, as a fraction of the map's width. A negative depth engraves:
    /// white is down (which is how depth maps, white = deep, are read).
    ///
    /// # Errors
    /// [`Error::NotFinite`] for a height and [`Error::Parameter`] for a depth that is NaN or infinite;
    /// [`Error::Parameter`] for a relief beyond [`MAX_HEIGHT`] (often the "no data" value of a terrain file).
    pub fn new(heights: Grid<f32>, depth: f32) -> Result<Self> {
        if !depth.is_finite() {
            return Err(Error::parameter("depth", depth, "a finite number"));
        }
        if let Some(index) = heights.texels().iter().position(|h| !h.is_finite()) {
            return Err(Error::NotFinite { what: "height", index });
        }
        let largest = heights.texels().iter().fold(0.0f32, |m, h| m.max(h.abs()));
        // In f64: the product itself must not overflow.
        let in_texels = f64::from(largest) * f64::from(depth.abs()) * f64::from(heights.width());
        if in_texels.max(largest.into()) > MAX_HEIGHT.into() {
            let expected = format!("at most {MAX_HEIGHT:e}, also after scaling by depth × width");
            return Err(Error::parameter("largest height", largest, expected));
        }
        Ok(Self { heights, depth })
    }

    /// Relative heights.
    pub fn heights(&self) -> &Grid<f32> {
        &self.heights
    }

    /// How far height 1 lies above height 0, as a fraction of the map's width.
    pub fn depth(&self) -> f32 {
        self.depth
    }
}

/// How the slope of a texel is estimated from its neighbours: the weights of a plane of least squares.
///
/// In the interior the four differ in how much they smooth across the direction of the slope. `Plane4` does not
/// smooth at all and keeps the finest relief; `Scharr` is the most isotropic of the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// The texel and its 4 nearest neighbours, equally weighted (q = 4).
    #[default]
    Plane4,
    /// The texel and its 8 nearest neighbours, equally weighted (q = 8; Prewitt's weights).
    Plane8,
    /// Weights (1 2 1) × (1 2 1).
    Sobel,
    /// Weights (3 10 3) × (3 10 3).
    Scharr,
}

/// Slopes of the relief: (dh/dx to the right, dh/dy UP the picture).
///
/// - **Shape:** one pair per texel, row-major, same size as `map`.
/// - **Units:** heights and distances both in widths of the map, so slope 1 is 45°.
/// - **Edges:** beyond a clamped border there is nothing: the plane is fitted to the texels that exist, so that a ramp
///   keeps its slope up to the border. A direction without any neighbour (1 × n) has slope 0.
/// - **Determinism:** class A: f32 in a fixed order, the same bits for any thread count and instruction set.
pub fn slopes(map: &HeightMap, filter: Filter, edges: Edges) -> Grid<[f32; 2]> {
    let fit = PlaneFit::new(map, filter, edges);
    let mut out = map.heights.map(|_| [0.0; 2]);
    let width = map.heights.width() as usize;
    par::for_each_row(out.texels_mut(), width, |y, row| fit.row(y, |x, slope| row[x] = slope));
    out
}

/// Normals of the relief, `normalize(−dh/dx, −dh/dy, 1)`; see [`slopes`].
///
/// - **Space:** tangent; +X right, +Y up the picture, +Z out of it.
/// - **Accuracy:** of the arithmetic, about 10⁻⁶ rad against f64 (`tests/height_oracle.rs`); against exact normals of
///   smooth reliefs see `tests/height_analytic.rs`.
///
/// ```
/// use rilievo::height::{Filter, HeightMap, to_normals};
/// use rilievo::{Edges, Grid};
///
/// // Rises to the right by a quarter of the width over the whole width: a slope of 1/4.
/// let ramp = Grid::from_fn(64, 32, |x, _| x as f32 / 64.0)?;
/// let normals = to_normals(&HeightMap::new(ramp, 0.25)?, Filter::Plane4, Edges::Clamp);
/// for n in normals.texels() {
///     assert!((n.vec().x / n.vec().z + 0.25).abs() < 1e-5);
/// }
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn to_normals(map: &HeightMap, filter: Filter, edges: Edges) -> NormalMap<Tangent> {
    let fit = PlaneFit::new(map, filter, edges);
    let mut out = map.heights.map(|_| Normal::Z);
    let width = map.heights.width() as usize;
    par::for_each_row(out.texels_mut(), width, |y, row| {
        fit.row(y, |x, [dx, dy]| row[x] = Normal::from_slopes(dx, dy));
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(width: u32, heights: &[f32]) -> Grid<f32> {
        Grid::new(width, heights.len() as u32 / width, heights.to_vec()).unwrap()
    }

    #[test]
    fn new_refuses_what_is_not_finite_or_far_too_high() {
        let refused = |h: f32, depth: f32| HeightMap::new(grid(2, &[0.0, h]), depth).unwrap_err();
        assert_eq!(refused(f32::NAN, 1.0), Error::NotFinite { what: "height", index: 1 });
        assert_eq!(refused(f32::NEG_INFINITY, 1.0), Error::NotFinite { what: "height", index: 1 });
        assert!(matches!(refused(0.0, f32::NAN), Error::Parameter { name: "depth", .. }));
        assert!(matches!(refused(f32::MIN, 1e-30), Error::Parameter { name: "largest height", .. }));
        assert!(matches!(refused(1e10, 1e10), Error::Parameter { name: "largest height", .. }));
        assert!(HeightMap::new(grid(2, &[1e18, -1e18]), 0.5).is_ok());
    }

    #[test]
    fn steepest_relief_still_has_normals() {
        for depth in [0.25, -0.25] {
            let map = HeightMap::new(grid(3, &[1e18, -1e18, 1e18, -1e18, 1e18, -1e18]), depth).unwrap();
            for filter in [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr] {
                for edges in [Edges::Wrap, Edges::Clamp, Edges::Mirror] {
                    for n in to_normals(&map, filter, edges).texels() {
                        assert!((n.vec().length() - 1.0).abs() < 1e-6, "{filter:?} {edges:?} {n:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn white_is_up_and_y_points_up_the_picture() {
        // Brighter to the right and to the top: the normal leans left and down.
        let map = HeightMap::new(grid(3, &[2.0, 3.0, 4.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0]), 1.0).unwrap();
        for filter in [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr] {
            for slope in slopes(&map, filter, Edges::Clamp).texels() {
                assert!((slope[0] - 3.0).abs() < 1e-5 && (slope[1] - 3.0).abs() < 1e-5, "{filter:?} {slope:?}");
            }
            let n = to_normals(&map, filter, Edges::Clamp)[(1, 1)].vec();
            assert!(n.x < 0.0 && n.y < 0.0 && n.z > 0.0);
        }
    }

    #[test]
    fn negative_depth_engraves() {
        let heights = grid(3, &[0.0, 0.5, 1.0]);
        let up = slopes(&HeightMap::new(heights.clone(), 0.1).unwrap(), Filter::Plane4, Edges::Clamp);
        let down = slopes(&HeightMap::new(heights, -0.1).unwrap(), Filter::Plane4, Edges::Clamp);
        assert_eq!(up.map(|s| -s[0]), down.map(|s| s[0]));
    }

    #[test]
    fn flat_is_exactly_z_with_any_height_and_size() {
        for (w, h) in [(1, 1), (1, 4), (5, 1), (2, 2), (3, 5)] {
            let map = HeightMap::new(Grid::filled(w, h, 0.7).unwrap(), 3.0).unwrap();
            for filter in [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr] {
                for edges in [Edges::Wrap, Edges::Clamp, Edges::Mirror] {
                    assert!(to_normals(&map, filter, edges).texels().iter().all(|n| *n == Normal::Z));
                }
            }
        }
    }

    #[test]
    fn a_line_of_texels_slopes_along_itself_only() {
        let column = HeightMap::new(grid(1, &[0.0, 1.0, 4.0]), 1.0).unwrap();
        // Downwards the heights rise, so up the picture they fall; one step is the map's whole width.
        assert_eq!(slopes(&column, Filter::Sobel, Edges::Clamp).texels(), [[0.0, -1.0], [0.0, -2.0], [0.0, -3.0]]);
        let row = HeightMap::new(grid(3, &[0.0, 1.0, 4.0]), 1.0).unwrap();
        assert_eq!(slopes(&row, Filter::Plane4, Edges::Clamp).texels(), [[3.0, 0.0], [6.0, 0.0], [9.0, 0.0]]);
        assert_eq!(slopes(&row, Filter::Plane4, Edges::Wrap).texels(), [[-4.5, 0.0], [6.0, 0.0], [-1.5, 0.0]]);
        assert_eq!(slopes(&row, Filter::Plane4, Edges::Mirror).texels(), [[1.5, 0.0], [6.0, 0.0], [4.5, 0.0]]);
    }
}
