//! Built-in shapes, with analytic normals and textures that lie upright and unmirrored on them.
//!
//! On all of them u runs to the right and v down as seen from outside, front faces are counter-clockwise, and a seam
//! of the texture is a pair of vertices with bit-identical positions and normals. Sizes are in object units.

mod cube;

use glam::{DVec3, Vec2, Vec3};

pub use cube::{CUBE_ATLAS_MARGIN, CUBE_ATLAS_REPEAT, CubeUvs, cube};

use super::{Mesh, MeshParts};
use crate::error::{Error, Result};

/// The most cells a built-in shape may be divided into.
const MAX_CELLS: u64 = 1 << 24;

/// A rectangle in x, y facing +Z: width 1, height 1 / `aspect`, centred, two triangles.
///
/// # Errors
/// [`Error::Parameter`] if `aspect` (width / height) is not a positive number.
pub fn plane(aspect: f32) -> Result<Mesh> {
    plane_grid(aspect, 1, 1)
}

/// The rectangle of [`plane`] divided into `columns` × `rows` cells of two triangles.
///
/// # Errors
/// [`Error::Parameter`] if `aspect` is not a positive number, or there are no cells or too many.
pub fn plane_grid(aspect: f32, columns: u32, rows: u32) -> Result<Mesh> {
    let height = 1.0 / aspect;
    if !(aspect > 0.0 && aspect.is_finite() && height.is_finite()) {
        return Err(Error::parameter("aspect", aspect, "width / height, a positive number"));
    }
    check_cells(("columns", columns, 1), ("rows", rows, 1))?;
    let mut parts = MeshParts::default();
    lattice(&mut parts, columns, rows, |u, v| Vertex {
        position: Vec3::new(u - 0.5, (0.5 - v) * height, 0.0),
        normal: Vec3::Z,
        uv: Vec2::new(u, v),
    });
    Mesh::new(parts)
}

/// The unit sphere by latitude and longitude: `segments` around, `rings` from pole to pole.
///
/// A world map lies on it as on a globe: north is +Y, longitude 0 (u = ½) faces +Z, east is to the right. A pole has
/// one vertex for each segment, in the middle of it in u: each triangle there then shows its own slice of the top row,
/// as evenly as triangles can. ([`Mesh::with_tangents`] bounds how many triangles may meet there.)
///
/// # Errors
/// [`Error::Parameter`] for fewer than 3 segments or 2 rings, or too many of them.
pub fn sphere(segments: u32, rings: u32) -> Result<Mesh> {
    check_cells(("segments", segments, 3), ("rings", rings, 2))?;
    let around = Circle::new(segments, 0.5);
    // Latitudes are half a circle: rings from π/2 at the top (v = 0) to −π/2.
    let down = Circle::new(2 * rings, 0.25);
    let mut parts = MeshParts::default();
    let mut push = |segment: u32, ring: u32, u: f64| {
        let (sin_lat, cos_lat) = match ring {
            0 => (1.0, 0.0),
            r if r == rings => (-1.0, 0.0),
            r => down.sin_cos_falling(r),
        };
        let (sin_lon, cos_lon) = around.sin_cos_rising(segment);
        let n = DVec3::new(cos_lat * sin_lon, sin_lat, cos_lat * cos_lon).as_vec3();
        parts.positions.push(n);
        parts.normals.push(n);
        parts.uvs.push(Vec2::new(u as f32, (f64::from(ring) / f64::from(rings)) as f32));
    };
    let at = |segment: u32, half: f64| (f64::from(segment) + half) / f64::from(segments);
    (0..segments).for_each(|s| push(s, 0, at(s, 0.5)));
    for ring in 1..rings {
        (0..=segments).for_each(|s| push(s, ring, at(s, 0.0)));
    }
    (0..segments).for_each(|s| push(s, rings, at(s, 0.5)));

    let row = segments + 1;
    let last = segments + (rings - 2) * row;
    for s in 0..segments {
        parts.triangles.push([s, segments + s, segments + s + 1]);
    }
    for ring in 1..rings - 1 {
        let first = segments + (ring - 1) * row;
        (0..segments).for_each(|s| push_quad(&mut parts.triangles, first + s, row));
    }
    for s in 0..segments {
        parts.triangles.push([last + s, last + row + s, last + s + 1]);
    }
    Mesh::new(parts)
}

/// A torus about the Y axis: `segments` around the axis, `sides` around the tube, 2 · segments · sides triangles.
///
/// Longitude runs as on [`sphere`]; v = ½ is the outer equator, v = ¼ the top, and the seam in v lies on the inside.
///
/// # Errors
/// [`Error::Parameter`] for fewer than 3 segments or sides, too many of them, or not 0 < `minor_radius` < `major_radius`.
pub fn torus(segments: u32, sides: u32, major_radius: f32, minor_radius: f32) -> Result<Mesh> {
    check_cells(("segments", segments, 3), ("sides", sides, 3))?;
    if !(minor_radius > 0.0 && minor_radius < major_radius && major_radius.is_finite()) {
        let given = format_args!("{major_radius} and {minor_radius}");
        return Err(Error::parameter("torus radii", given, "0 < minor < major"));
    }
    let (around, tube) = (Circle::new(segments, 0.5), Circle::new(sides, 0.5));
    let (major, minor) = (f64::from(major_radius), f64::from(minor_radius));
    let mut parts = MeshParts::default();
    lattice_by_index(&mut parts, segments, sides, |s, t| {
        let (sin_lon, cos_lon) = around.sin_cos_rising(s);
        let (sin_tube, cos_tube) = tube.sin_cos_falling(t);
        let out = DVec3::new(sin_lon, 0.0, cos_lon);
        let normal = cos_tube * out + DVec3::new(0.0, sin_tube, 0.0);
        Vertex {
            position: (major * out + minor * normal).as_vec3(),
            normal: normal.as_vec3(),
            uv: Vec2::new(ratio(s, segments), ratio(t, sides)),
        }
    });
    Mesh::new(parts)
}

struct Vertex {
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
}

/// A circle in equal steps, from an angle of zero at `zero` (a fraction of the whole).
struct Circle {
    steps: u32,
    zero: f64,
}

impl Circle {
    fn new(steps: u32, zero: f64) -> Self {
        Self { steps, zero }
    }

    /// Sine and cosine of an angle that grows with `step`. The last step is the first again, bit for bit.
    fn sin_cos_rising(&self, step: u32) -> (f64, f64) {
        let turn = f64::from(step % self.steps) / f64::from(self.steps) - self.zero;
        (turn * std::f64::consts::TAU).sin_cos()
    }

    /// The same with an angle that falls.
    fn sin_cos_falling(&self, step: u32) -> (f64, f64) {
        let (sin, cos) = self.sin_cos_rising(step);
        (-sin, cos)
    }
}

fn ratio(i: u32, n: u32) -> f32 {
    (f64::from(i) / f64::from(n)) as f32
}

/// Refuses counts below their minimum and shapes of too many cells.
fn check_cells(columns: (&'static str, u32, u32), rows: (&'static str, u32, u32)) -> Result<()> {
    for (name, value, least) in [columns, rows] {
        if value < least {
            return Err(Error::parameter(name, value, format_args!("at least {least}")));
        }
    }
    if u64::from(columns.1) * u64::from(rows.1) > MAX_CELLS {
        let expected = format_args!("at most {MAX_CELLS} in all ({} × {})", columns.0, rows.0);
        return Err(Error::parameter(columns.0, format_args!("{} × {}", columns.1, rows.1), expected));
    }
    Ok(())
}

/// Appends a rectangle of `columns` × `rows` cells whose vertex at (u, v) is `f(u, v)`.
fn lattice(parts: &mut MeshParts, columns: u32, rows: u32, f: impl Fn(f32, f32) -> Vertex) {
    lattice_by_index(parts, columns, rows, |i, j| f(ratio(i, columns), ratio(j, rows)));
}

/// Appends a rectangle of cells whose vertex in column i and row j is `f(i, j)`.
fn lattice_by_index(parts: &mut MeshParts, columns: u32, rows: u32, f: impl Fn(u32, u32) -> Vertex) {
    let base = parts.positions.len() as u32;
    for j in 0..=rows {
        for i in 0..=columns {
            let vertex = f(i, j);
            parts.positions.push(vertex.position);
            parts.normals.push(vertex.normal);
            parts.uvs.push(vertex.uv);
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            push_quad(&mut parts.triangles, base + j * (columns + 1) + i, columns + 1);
        }
    }
}

/// The cell whose top left vertex is `corner`, in rows of `row` vertices, as two counter-clockwise triangles.
fn push_quad(triangles: &mut Vec<[u32; 3]>, corner: u32, row: u32) {
    triangles.push([corner, corner + row, corner + row + 1]);
    triangles.push([corner, corner + row + 1, corner + 1]);
}

#[cfg(test)]
mod tests;
