//! The corners of a mesh, and the vectors in them.

use glam::{Vec3, Vec4};

use crate::light::Light;
use crate::normal::Object;
use crate::raster::vectors::{Corner, Rotated, Viewer};
use crate::surface::Mesh;

/// All corners of a mesh with their frames, and for each light the vectors in them, computed once a frame.
#[derive(Debug, Clone)]
pub struct Vertices {
    lights: Vec<Light<Object>>,
    eye: Vec3,
    corners: Vec<Corner>,
    /// Light by light, the vectors of all corners.
    vectors: Vec<Vec<Rotated>>,
    /// Whether tangents are the mesh's own.
    has_tangents: bool,
}

/// A triangle, whole or cut, with the vectors of one light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitTriangle {
    /// Its corners.
    pub corners: [Corner; 3],
    /// The vectors in them.
    pub vectors: [Rotated; 3],
}

impl Vertices {
    /// For lights and an eye in object space.
    pub fn new(mesh: &Mesh, lights: &[Light<Object>], eye: Vec3) -> Self {
        let has_tangents = !mesh.tangents().is_empty();
        let corner = |i: usize| Corner {
            position: mesh.positions()[i],
            normal: mesh.normals()[i],
            tangent: mesh.tangents().get(i).copied().unwrap_or(Vec4::ZERO),
        };
        let corners: Vec<Corner> = (0..mesh.positions().len()).map(corner).collect();
        let mut vertices = Self { lights: lights.to_vec(), eye, corners, vectors: Vec::new(), has_tangents };
        if has_tangents {
            let all = |light| {
                let viewer = vertices.viewer(light);
                vertices.corners.iter().map(|c| Rotated::at(c, &viewer)).collect()
            };
            vertices.vectors = (0..lights.len()).map(all).collect();
        }
        vertices
    }

    /// How many lights there are.
    pub fn lights(&self) -> usize {
        self.lights.len()
    }

    /// Light number `light`, and the eye.
    ///
    /// # Panics
    /// If there is no such light.
    pub fn viewer(&self, light: usize) -> Viewer<impl Fn(Vec3) -> Option<Vec3> + use<>> {
        let light = self.lights[light];
        Viewer { toward: move |p| light.toward(p), eye: self.eye }
    }

    /// A triangle of the mesh, or the part of it whose corners have these weights in it, for light number `light`.
    ///
    /// A mesh without tangents gets frames that are the triangle's own, as alike as its normals let them be: enough for
    /// the mesh's own normals, which are +Z in any frame.
    ///
    /// # Panics
    /// If there is no such light or vertex.
    pub fn triangle(&self, vertices: [u32; 3], weights: &[[f64; 3]; 3], light: usize) -> LitTriangle {
        let mut whole = vertices.map(|v| self.corners[v as usize]);
        if !self.has_tangents {
            add_tangents(&mut whole);
        }
        let viewer = self.viewer(light);
        let mut lit = LitTriangle { corners: whole, vectors: [Rotated::default(); 3] };
        for (i, weights) in weights.iter().enumerate() {
            let w = weights.map(|w| w as f32);
            // Corners of the mesh are known, whichever of them this is; only new ones are mixed.
            let known = w.iter().position(|&w| w == 1.0);
            lit.corners[i] = known.map_or_else(|| Corner::mixed(&whole, w), |k| whole[k]);
            lit.vectors[i] = match known.filter(|_| self.has_tangents) {
                Some(k) => self.vectors[light][vertices[k] as usize],
                None => Rotated::at(&lit.corners[i], &viewer),
            };
        }
        lit
    }
}

/// Tangents at right angles to the normals that all come from one direction in the triangle.
fn add_tangents(corners: &mut [Corner; 3]) {
    let [a, b, c] = corners.map(|c| c.normal);
    let shared = (a + b + c).try_normalize().unwrap_or(a).any_orthonormal_vector();
    for corner in corners {
        let n = corner.normal;
        let tangent = (shared - n * n.dot(shared)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        corner.tangent = tangent.extend(1.0);
    }
}
