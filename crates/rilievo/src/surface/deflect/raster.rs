//! A mesh drawn in its texture space.

use glam::DVec2;

use super::{Deflect, Deflected};
use crate::error::{Error, Result};
use crate::fill::{MAX_COORDINATE, Triangle};
use crate::grid::Grid;
use crate::normal::spread_normals;
use crate::normal::{Normal, Object};
use crate::par;
use crate::progress::Progress;
use crate::surface::Mesh;

/// The most repetitions of the texture one triangle may touch.
const MAX_TILES: f64 = 64.0;

/// Rows that one thread draws at a time.
const BAND_ROWS: usize = 64;

/// The centre of a texel on a triangle.
pub(super) struct Point {
    /// Index of the triangle.
    pub(super) triangle: usize,
    /// Its vertices.
    pub(super) vertices: [usize; 3],
    /// Barycentric coordinates for them.
    pub(super) weights: [f64; 3],
    /// Where the point lies, in texels of the result, not wrapped: texture coordinates × size.
    pub(super) position: DVec2,
}

impl Point {
    /// The value that is `f(vertex)` at the vertices.
    pub(super) fn interpolate<T>(&self, f: impl Fn(usize) -> T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        let [a, b, c] = self.vertices;
        let [wa, wb, wc] = self.weights;
        f(a) * wa + f(b) * wb + f(c) * wc
    }
}

/// Fails unless every triangle can be drawn in a map of `size`.
///
/// # Errors
/// [`Error::Missing`] without texture coordinates, [`Error::Parameter`] for triangles that span too many repetitions of
/// the texture.
pub(super) fn check_uvs(mesh: &Mesh, size: (u32, u32)) -> Result<()> {
    if mesh.uvs().is_empty() {
        let remedy = "unwrap the mesh, or give one with texture coordinates";
        return Err(Error::Missing { what: "texture coordinates", remedy });
    }
    let most = DVec2::new(MAX_COORDINATE / f64::from(size.0), MAX_COORDINATE / f64::from(size.1)).floor();
    for (index, t) in mesh.triangles().iter().enumerate() {
        let (low, high) = tiles(mesh, *t);
        let span = high - low + 1.0;
        if span.x * span.y > MAX_TILES || span.cmpgt(most).any() {
            let value = format_args!("{} × {} in triangle {index}", span.x, span.y);
            let expected = format_args!(
                "at most {MAX_TILES} for one triangle, and {} × {} at this size of map; subdivide it",
                most.x, most.y
            );
            return Err(Error::parameter("repetitions of the texture", value, expected));
        }
    }
    Ok(())
}

/// The first and the last repetition of the texture that triangle `t` touches.
fn tiles(mesh: &Mesh, t: [u32; 3]) -> (DVec2, DVec2) {
    let [a, b, c] = t.map(|v| mesh.uvs()[v as usize].as_dvec2());
    (a.min(b).min(c).floor(), a.max(b).max(c).floor())
}

#[derive(Clone, Copy)]
struct Texel {
    normal: Normal<Object>,
    /// How many triangles claim it; more than two are counted as two.
    claims: u8,
}

/// Draws the mesh in its texture space, one normal from `shade` for each texel centre on a triangle where `in_source`
/// says that the source has something to give.
pub(super) fn rasterise(
    mesh: &Mesh,
    options: &Deflect,
    progress: &dyn Progress,
    in_source: impl Fn(&Point) -> bool + Sync + Send,
    shade: impl Fn(&Point) -> Normal<Object> + Sync + Send,
) -> Result<Deflected> {
    let (width, height) = options.size;
    let mut texels = Grid::filled(width, height, Texel { normal: Normal::Z, claims: 0 })?;
    progress.begin("deflect", height.into());
    // Each band runs through all triangles in their order: no lists to hold in memory, the same result for any number
    // of threads. The test by rows is cheap beside the drawing.
    par::for_each_row(texels.texels_mut(), BAND_ROWS * width as usize, |band, texels| {
        let first = (band * BAND_ROWS) as u32;
        let rows = texels.len() / width as usize;
        draw_band(mesh, options.size, first..first + rows as u32, |x, y, point| {
            if !in_source(&point) {
                return;
            }
            let texel = &mut texels[(y - first) as usize * width as usize + x as usize];
            if texel.claims == 0 {
                texel.normal = shade(&point);
            }
            texel.claims = (texel.claims + 1).min(2);
        });
        progress.advance(rows as u64);
    });
    let overlaps = texels.texels().iter().filter(|t| t.claims > 1).count() as u64;
    let covered = texels.map(|t| t.claims > 0);
    let mut normals = texels.map(|t| t.normal);
    spread_normals(&mut normals, &covered, options.gutter);
    Ok(Deflected { normals, covered, overlaps })
}

/// Calls `visit(x, y, point)` for each texel of some rows that a triangle owns, triangle by triangle.
fn draw_band(
    mesh: &Mesh,
    (width, height): (u32, u32),
    rows: std::ops::Range<u32>,
    mut visit: impl FnMut(u32, u32, Point),
) {
    let size = DVec2::new(width.into(), height.into());
    for (index, t) in mesh.triangles().iter().enumerate() {
        let uvs = t.map(|v| mesh.uvs()[v as usize].as_dvec2());
        let (low, high) = tiles(mesh, *t);
        for tile_v in 0..=(high.y - low.y) as u32 {
            let tile_v = low.y + f64::from(tile_v);
            let ys = uvs.map(|uv| (uv.y - tile_v) * size.y);
            // A margin of a row is more than snapping can move a corner.
            let above = ys.iter().all(|&y| y < f64::from(rows.start) - 1.0);
            if above || ys.iter().all(|&y| y > f64::from(rows.end) + 1.0) {
                continue;
            }
            for tile_u in 0..=(high.x - low.x) as u32 {
                let tile = DVec2::new(low.x + f64::from(tile_u), tile_v);
                let Some(triangle) = Triangle::new(uvs.map(|uv| (uv - tile) * size)) else { continue };
                triangle.for_each_pixel(0..width, rows.clone(), |x, y, weights| {
                    let position = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) + tile * size;
                    visit(x, y, Point { triangle: index, vertices: t.map(|v| v as usize), weights, position });
                });
            }
        }
    }
}
