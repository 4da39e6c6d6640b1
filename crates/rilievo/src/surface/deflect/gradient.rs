//! How the surface runs under its texture: ∂P/∂u and ∂P/∂v, and gradients along the surface from them.

use glam::DVec3;

use super::{Mesh, Point};
use crate::error::{Error, Result};

/// A triangle flatter than this in the texture (area over its longest side squared) has no frame: its coordinates are
/// f32, and what is left of its area is rounding.
const FLAT: f64 = 1e-6;

/// ∂P/∂u and ∂P/∂v in object units per unit of texture coordinates, averaged over the triangles at each vertex.
pub(super) struct SurfaceMetric {
    /// For each vertex, apart for triangles that show the texture as it is and mirrored: at the seam of a mirrored
    /// texture the two cancel.
    vertices: Vec<[[DVec3; 2]; 2]>,
    /// For each triangle, which of the two it takes.
    mirrored: Vec<bool>,
    mean_u_length: f64,
}

impl SurfaceMetric {
    /// Of a mesh with texture coordinates.
    ///
    /// # Errors
    /// [`Error::Parameter`] if no triangle has an area in the texture.
    pub(super) fn new(mesh: &Mesh) -> Result<Self> {
        let mut sums = vec![[([DVec3::ZERO; 2], 0.0f64); 2]; mesh.positions().len()];
        let mut mirrored = Vec::with_capacity(mesh.triangles().len());
        let (mut length_area, mut total_area) = (0.0f64, 0.0f64);
        for t in mesh.triangles() {
            let derivatives = derivatives(mesh, *t);
            mirrored.push(derivatives.as_ref().is_some_and(|d| d.mirrored));
            let Some(Derivatives { p_u, p_v, area, mirrored }) = derivatives else { continue };
            length_area += p_u.length() * area;
            total_area += area;
            for &v in t {
                let ([u, v], weight) = &mut sums[v as usize][usize::from(mirrored)];
                *u += p_u * area;
                *v += p_v * area;
                *weight += area;
            }
        }
        if total_area <= 0.0 {
            let expected = "triangles that cover an area of the texture";
            return Err(Error::parameter("texture coordinates", "without any area", expected));
        }
        // A vertex without a frame keeps zeros, and `gradient` refuses those.
        let mean = |([u, v], area): ([DVec3; 2], f64)| if area > 0.0 { [u / area, v / area] } else { [u, v] };
        let vertices = sums.into_iter().map(|sides| sides.map(mean)).collect();
        Ok(Self { vertices, mirrored, mean_u_length: length_area / total_area })
    }

    /// The mean of |∂P/∂u| over the area of the mesh.
    pub(super) fn mean_u_length(&self) -> f64 {
        self.mean_u_length
    }

    /// The vector in the plane of unit normal `n` with g · ∂P/∂u = `h_u` and g · ∂P/∂v = `h_v`; `None` if the frame is
    /// degenerate.
    pub(super) fn gradient(&self, point: &Point, n: DVec3, h_u: f64, h_v: f64) -> Option<DVec3> {
        let side = usize::from(self.mirrored[point.triangle]);
        let tangential = |axis: usize| {
            let p = point.interpolate(|v| self.vertices[v][side][axis]);
            p - n * n.dot(p)
        };
        let (p_u, p_v) = (tangential(0), tangential(1));
        let area = n.dot(p_u.cross(p_v));
        if area.abs() <= FLAT * p_u.length() * p_v.length() {
            return None;
        }
        let g = (p_v.cross(n) * h_u + n.cross(p_u) * h_v) / area;
        g.is_finite().then_some(g)
    }
}

struct Derivatives {
    p_u: DVec3,
    p_v: DVec3,
    area: f64,
    mirrored: bool,
}

/// The constant derivatives of one triangle; `None` if it has no area, on the mesh or in the texture.
fn derivatives(mesh: &Mesh, t: [u32; 3]) -> Option<Derivatives> {
    let [p0, p1, p2] = t.map(|v| mesh.positions()[v as usize].as_dvec3());
    let [uv0, uv1, uv2] = t.map(|v| mesh.uvs()[v as usize].as_dvec2());
    let (e1, e2) = (p1 - p0, p2 - p0);
    let (d1, d2) = (uv1 - uv0, uv2 - uv0);
    let det = d1.perp_dot(d2);
    let longest = d1.length_squared().max(d2.length_squared()).max((uv2 - uv1).length_squared());
    let area = e1.cross(e2).length() * 0.5;
    if det.abs() <= FLAT * longest || area <= 0.0 {
        return None;
    }
    let p_u = (e1 * d2.y - e2 * d1.y) / det;
    let p_v = (e2 * d1.x - e1 * d2.x) / det;
    // v runs down: a texture that is not mirrored turns clockwise in (u, v) on a counter-clockwise face.
    Some(Derivatives { p_u, p_v, area, mirrored: det > 0.0 })
}
