//! Maps bent onto meshes: a tangent-space normal map or a height map becomes an object-space normal map.
//!
//! The mesh is drawn in its texture space with interpolated normals and frames, and each texel's normal is tilted there
//! ("deflected") by the map. The result needs no frames any more: one table of normals then serves the whole object.
//!
//! Source: Tarini, Cignoni, Rocchini, Scopigno 2000, "Real time, accurate, multi-featured rendering of bump mapped
//! surfaces", § 4.1.

mod bilinear;
mod gradient;
mod raster;

use glam::{DVec2, DVec3};

use super::{Frame, Mesh};
use crate::error::{Error, Result};
use crate::grid::{Edges, Grid, check_size};
use crate::height::{Filter, HeightMap, slopes};
use crate::normal::{Normal, NormalMap, Object, Tangent};
use crate::progress::Progress;

use bilinear::Bilinear;
use gradient::SurfaceMetric;
use raster::Point;

/// The widest gutter that can be asked for, in texels.
pub const MAX_GUTTER: u32 = 1024;

/// How a map is bent onto a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deflect {
    /// Width and height of the object-space map, in texels.
    ///
    /// The source map is sampled bilinearly: choose at least its size times `repeat`, or it aliases.
    pub size: (u32, u32),
    /// How far covered texels spread beyond the borders of the triangles, in texels, so that filtering does not bleed.
    pub gutter: u32,
    /// How often the source map repeats over the unit square of texture coordinates, across and down.
    pub repeat: [f32; 2],
}

impl Deflect {
    /// A map of `size` texels with a gutter of 8, the source map lying on it once.
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, gutter: 8, repeat: [1.0, 1.0] }
    }

    fn check(&self) -> Result<()> {
        check_size(self.size.0.into(), self.size.1.into())?;
        if self.gutter > MAX_GUTTER {
            return Err(Error::parameter("gutter", self.gutter, format_args!("at most {MAX_GUTTER} texels")));
        }
        // Beyond 65 536 copies a texel of the result would span whole copies of any map.
        let fits = |r: f32| r > 0.0 && r <= 65_536.0;
        if !self.repeat.iter().all(|&r| fits(r)) {
            let [across, down] = self.repeat;
            return Err(Error::parameter(
                "repeat",
                format_args!("{across} × {down}"),
                "two numbers above 0, at most 65536",
            ));
        }
        Ok(())
    }
}

/// An object-space normal map made on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Deflected {
    /// The normals. Texels of the gutter have the normal of the nearest covered texel, the rest +Z.
    pub normals: NormalMap<Object>,
    /// Which texels have their centre on a triangle (true), and which are gutter or nothing. Where the source is not
    /// covered there is nothing.
    pub covered: Grid<bool>,
    /// How many texels more than one triangle claims, because texture coordinates overlap. Of these the first triangle
    /// of the mesh has its way.
    pub overlaps: u64,
}

/// Bends a tangent-space normal map onto a mesh, by interpolated MikkTSpace frames.
///
/// `n' = normalize(n.x T + n.y B + n.z N)` with T and N interpolated and not normalised, `B = ± N × T`: the convention
/// that makers of tangent-space maps bake against. The map repeats; outside 0 … 1, texture coordinates wrap.
///
/// `covered` says which texels of the map mean something, all without it: where the nearest one does not, the result is
/// not covered either.
///
/// - **Space:** in: tangent, +Y up; out: object.
/// - **Determinism:** the same bits for any number of threads.
/// - **Source:** Tarini 2000, § 4.1; frames: Mikkelsen 2008, "Simulation of wrinkled surfaces revisited".
///
/// # Errors
/// [`Error::Missing`] if the mesh has no texture coordinates; [`Error::Parameter`] or [`Error::Size`] for options out of
/// range, or triangles that span too many repetitions of the texture; [`Error::SizeMismatch`] if `covered` is not of the
/// map's size; errors of [`Mesh::with_tangents`].
pub fn deflect_normals(
    mesh: &Mesh,
    map: &NormalMap<Tangent>,
    covered: Option<&Grid<bool>>,
    options: &Deflect,
    progress: &dyn Progress,
) -> Result<Deflected> {
    options.check()?;
    raster::check_uvs(mesh, options.size)?;
    expect_fits(covered, map)?;
    let owned;
    let mesh = if mesh.tangents().is_empty() {
        owned = mesh.clone().with_tangents()?;
        &owned
    } else {
        mesh
    };
    let sampler = Bilinear::new(options, map.size(), Edges::Wrap);
    let shade = |point: &Point| {
        let normal = point.interpolate(|v| mesh.normals()[v].as_dvec3()).as_vec3();
        let tangent = point.interpolate(|v| mesh.tangents()[v].truncate().as_dvec3()).as_vec3();
        // Mikkelsen's tangents never change their sign within a triangle.
        let sign = mesh.tangents()[point.vertices[0]].w;
        let mean = sampler.sample(point, |x, y| map[(x, y)].vec().as_dvec3());
        Frame::from_mikk(normal, tangent.extend(sign)).to_object(Normal::new_or(mean.as_vec3(), Normal::Z))
    };
    let in_source = |point: &Point| covered.is_none_or(|c| c[sampler.nearest(point)]);
    raster::rasterise(mesh, options, progress, in_source, shade)
}

/// Bends a height map onto a mesh, by the surface gradient.
///
/// `n' = normalize(N − g)`, where g is the gradient of the height along the surface: the tangential vector with
/// `g · ∂P/∂u = ∂h/∂u` and `g · ∂P/∂v = ∂h/∂v`. Stretched, sheared and mirrored textures thus get their true slopes,
/// which a tangent-space map cannot know. `covered` is as for [`deflect_normals`].
///
/// - **Units:** full white stands for `depth` × W, where W is the length of the map's width on the mesh: the mean of
///   `|∂P/∂u| / repeat` over the area of the mesh, in object units. On a flat plane of the map's aspect the result is
///   exactly the flat map's normals ([`crate::height::to_normals`]).
/// - **Edges:** `edges` says what lies beyond the edges of one copy of the map; the copies repeat in any case.
/// - **Degenerate frames** (a pole, triangles without area in the texture) leave the interpolated normal as it is.
/// - **Determinism:** the same bits for any number of threads.
/// - **Source:** Blinn 1978, "Simulation of wrinkled surfaces", without the terms in h itself; Mikkelsen 2020, "Surface
///   gradient-based bump mapping framework", § 2. Deviation: ∂P/∂u and ∂P/∂v are averaged at the vertices, so that
///   triangles do not show.
///
/// # Errors
/// As [`deflect_normals`], and [`Error::Parameter`] if no triangle has an area in the texture.
pub fn deflect_heights(
    mesh: &Mesh,
    map: &HeightMap,
    covered: Option<&Grid<bool>>,
    filter: Filter,
    edges: Edges,
    options: &Deflect,
    progress: &dyn Progress,
) -> Result<Deflected> {
    options.check()?;
    raster::check_uvs(mesh, options.size)?;
    expect_fits(covered, map.heights())?;
    let metric = SurfaceMetric::new(mesh)?;
    let slopes = slopes(map, filter, edges);
    let sampler = Bilinear::new(options, slopes.size(), edges);
    // A slope is height over length, both in widths of the map. On the mesh a width is W = mean |∂P/∂u| / repeat.x long,
    // and a unit of u holds repeat.x widths; a unit of v holds repeat.y heights of (rows / columns) widths each.
    let repeat = DVec2::new(options.repeat[0].into(), options.repeat[1].into());
    let per_u = metric.mean_u_length();
    let per_v = per_u / repeat.x * repeat.y * f64::from(slopes.height()) / f64::from(slopes.width());
    let shade = |point: &Point| {
        let normal = point.interpolate(|v| mesh.normals()[v].as_dvec3());
        let geometric = Normal::new_or(normal.as_vec3(), Normal::Z);
        let [right, up] = sampler.sample(point, |x, y| DVec2::from(slopes[(x, y)].map(f64::from))).to_array();
        let gradient = metric.gradient(point, geometric.vec().as_dvec3(), right * per_u, -up * per_v);
        gradient.map_or(geometric, |g: DVec3| Normal::new_or((geometric.vec().as_dvec3() - g).as_vec3(), geometric))
    };
    let in_source = |point: &Point| covered.is_none_or(|c| c[sampler.nearest(point)]);
    raster::rasterise(mesh, options, progress, in_source, shade)
}

fn expect_fits<T>(covered: Option<&Grid<bool>>, map: &Grid<T>) -> Result<()> {
    covered.map_or(Ok(()), |covered| map.expect_same_size("the coverage of the map", covered))
}

#[cfg(test)]
mod tests;
