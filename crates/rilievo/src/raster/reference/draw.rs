//! From triangles to pixels.

use glam::{DVec2, DVec4, Vec2, Vec3, Vec4};

use crate::color::LinearRgb;
use crate::fill::{SUBPIXEL_BITS, Triangle};
use crate::light::Shade;
use crate::par;
use crate::raster::clip::{Corner, clip};
use crate::raster::frame::{Frame, Shading};
use crate::raster::project::Projection;
use crate::raster::scene::{Fragment, Object, Scene};
use crate::raster::target::{Pixel, Target};
use crate::raster::texture::{Footprint, Sampling, Taps};
use crate::surface::Mesh;

/// Rows one task draws. Bands are independent, so pictures do not depend on the number of threads.
const BAND_ROWS: usize = 32;

/// Draws a prepared frame into `target`, on top of what is there.
///
/// Triangles come in the order of the objects and their meshes; of two surfaces at exactly the same depth the first
/// stays.
pub fn draw(frame: &Frame<'_>, target: &mut Target) {
    let (width, height) = target.size();
    for (object, shading) in frame.scene.objects.iter().zip(&frame.shadings) {
        let triangles = set_up(object, frame.scene, (width, height));
        let sampling = Sampling { filter: frame.filter, edges: object.edges, repeat: Vec2::ONE };
        let fields = match shading {
            Shading::Interpolated(shading) => shading.fields(&triangles),
            _ => Vec::new(),
        };
        let band_len = width as usize * BAND_ROWS;
        par::for_each_row(target.pixels.texels_mut(), band_len, |band, pixels| {
            let first_row = (band * BAND_ROWS) as u32;
            let rows = first_row..first_row + (pixels.len() / width as usize) as u32;
            for (i, triangle) in triangles.iter().enumerate() {
                triangle.shape.for_each_pixel(0..width, rows.clone(), |x, y, lambda| {
                    let pixel = &mut pixels[(y - first_row) as usize * width as usize + x as usize];
                    let depth = triangle.depth(lambda);
                    if depth < pixel.depth {
                        let fragment = triangle.fragment(object.mesh, lambda);
                        let shade = match (shading, fields.get(i)) {
                            (Shading::Interpolated(shading), Some(fields)) => {
                                shading.shade(&fragment, sampling, fields, (x, y))
                            }
                            _ => shade(shading, &fragment, sampling),
                        };
                        let color = shade.over(base_color(object, &fragment, sampling), object.blend);
                        *pixel = Pixel { color, depth };
                    }
                });
            }
        });
    }
}

/// What a shading that needs no more than the fragment makes of it.
pub(in crate::raster) fn shade(shading: &Shading<'_>, fragment: &Fragment, sampling: Sampling) -> Shade {
    match shading {
        Shading::Table(table) => table.shade(fragment, sampling),
        Shading::Exact(exact) => exact.shade(fragment, sampling),
        Shading::Static(baked) => baked.shade(fragment, sampling),
        Shading::Polar(polar) => polar.shade(fragment, sampling),
        // Vectors belong to a triangle; there are as many fields as triangles.
        Shading::Interpolated(_) => Shade::default(),
    }
}

/// The base colour under a pixel; white without a map of it.
pub(in crate::raster) fn base_color(object: &Object<'_>, fragment: &Fragment, sampling: Sampling) -> LinearRgb {
    object.base_color.map_or(LinearRgb::WHITE, |base| {
        Taps::gather(base.levels, Sampling { repeat: base.repeat, ..sampling }, &fragment.footprint)
            .iter()
            .fold(LinearRgb::BLACK, |sum, tap| sum + base.levels.levels()[tap.level][(tap.x, tap.y)] * tap.weight)
    })
}

/// A clipped, projected triangle.
pub(in crate::raster) struct ScreenTriangle {
    pub(in crate::raster) shape: Triangle,
    /// Seen from behind.
    pub(in crate::raster) back_facing: bool,
    pub(in crate::raster) corners: [Corner; 3],
    /// Change of the screen barycentrics to the next pixel to the right and below.
    lambda_dx: [f64; 3],
    lambda_dy: [f64; 3],
    /// Vertices of the triangle before clipping.
    pub(in crate::raster) vertices: [u32; 3],
}

/// Transforms, clips and projects all triangles of an object; drops what is behind, outside, or turned away.
pub(in crate::raster) fn set_up(
    object: &Object<'_>,
    scene: &Scene<'_>,
    (width, height): (u32, u32),
) -> Vec<ScreenTriangle> {
    let mesh = object.mesh;
    let projection = Projection::new(&scene.camera, &object.pose, (width, height));
    // Per vertex, not per corner: triangles that share a vertex must see it at the same bits.
    let positions: Vec<DVec4> = mesh.positions().iter().map(|&p| projection.clip_position(p).as_dvec4()).collect();
    let to_screen = |p: DVec4| {
        let vertex = projection.snap(p.as_vec4());
        DVec2::new(f64::from(vertex.x), f64::from(vertex.y)) / f64::from(1 << SUBPIXEL_BITS)
    };
    let mut out = Vec::new();
    for &vertices in mesh.triangles() {
        let polygon = clip(vertices.map(|v| positions[v as usize]), projection.guard_band());
        for i in 2..polygon.len() {
            let corners = [polygon[0], polygon[i - 1], polygon[i]];
            let screen = corners.map(|c| to_screen(c.position));
            let Some(shape) = Triangle::new(screen) else { continue };
            // Counter-clockwise in the world is counter-clockwise to the eye.
            let back_facing = shape.is_clockwise();
            if back_facing && !object.double_sided {
                continue;
            }
            let [lambda_dx, lambda_dy] = barycentric_gradients(screen);
            out.push(ScreenTriangle { shape, back_facing, corners, lambda_dx, lambda_dy, vertices });
        }
    }
    out
}

/// How the barycentric coordinates change along x and along y.
fn barycentric_gradients([a, b, c]: [DVec2; 3]) -> [[f64; 3]; 2] {
    let area2 = (b - a).perp_dot(c - a);
    let edges = [c - b, a - c, b - a];
    [edges.map(|e| -e.y / area2), edges.map(|e| e.x / area2)]
}

impl ScreenTriangle {
    /// Depth at screen barycentrics `lambda`: linear on the screen.
    pub(in crate::raster) fn depth(&self, lambda: [f64; 3]) -> f32 {
        self.corners.iter().zip(lambda).map(|(c, l)| c.position.z / c.position.w * l).sum::<f64>() as f32
    }

    /// Sums of `lambda` over the corners, each divided by its w: numerators of the perspective-correct weights of the three
    /// vertices, and their common denominator. All are linear on the screen.
    fn over_w(&self, lambda: [f64; 3]) -> ([f64; 3], f64) {
        let (mut numerators, mut denominator) = ([0.0; 3], 0.0);
        for (corner, l) in self.corners.iter().zip(lambda) {
            let share = l / corner.position.w;
            denominator += share;
            for (n, c) in numerators.iter_mut().zip(corner.weights) {
                *n += share * c;
            }
        }
        (numerators, denominator)
    }

    pub(in crate::raster) fn fragment(&self, mesh: &Mesh, lambda: [f64; 3]) -> Fragment {
        let (numerators, denominator) = self.over_w(lambda);
        let weights = numerators.map(|n| n / denominator);
        // d(n / d) = (dn − n / d · dd) / d: at the pixel itself, because a step to the next pixel may leave the triangle
        // and meet the horizon of its plane.
        let change = |lambda_change: [f64; 3]| {
            let (dn, dd) = self.over_w(lambda_change);
            [0, 1, 2].map(|k| (dn[k] - weights[k] * dd) / denominator)
        };
        let mixed = |w: [f64; 3]| w.map(|w| w as f32);
        let uv = |w: [f64; 3]| mix(mesh.uvs(), self.vertices, mixed(w), Vec2::ZERO);
        Fragment {
            footprint: Footprint {
                uv: uv(weights),
                uv_dx: uv(change(self.lambda_dx)),
                uv_dy: uv(change(self.lambda_dy)),
            },
            position: mix(mesh.positions(), self.vertices, mixed(weights), Vec3::ZERO),
            normal: mix(mesh.normals(), self.vertices, mixed(weights), Vec3::ZERO),
            tangent: mix(mesh.tangents(), self.vertices, mixed(weights), Vec4::ZERO),
            back_facing: self.back_facing,
        }
    }
}

/// Weighted sum of a vertex attribute; `absent` if the mesh does not have it.
fn mix<T>(values: &[T], vertices: [u32; 3], weights: [f32; 3], absent: T) -> T
where
    T: Copy + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    if values.is_empty() {
        return absent;
    }
    let [a, b, c] = vertices.map(|v| values[v as usize]);
    a * weights[0] + b * weights[1] + c * weights[2]
}
