//! The work of a frame before a pixel is touched: vertices to the screen, triangles into tiles.

use glam::{DVec4, Vec2, Vec3, Vec4};

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16};

use super::buffer::TILE;
use super::cover::Bounds;
use super::samples::Samples;
use crate::par;
use crate::raster::clip::clip;
use crate::raster::project::{Projection, ScreenVertex};
use crate::raster::scene::Object;
use crate::simd::three;
use crate::surface::Mesh;

/// Vertices that one task projects.
const VERTICES_A_TASK: usize = 1024;
/// Triangles that one task bins, at least. Tasks do not depend on the number of threads, nor does the picture.
const TRIANGLES_A_TASK: usize = 4096;
/// Tasks at most, since each has a list for every tile.
const MOST_TASKS: usize = 64;

/// Triangles of a frame that were left out before any pixel was looked at, by the reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Skipped {
    /// Behind the eye, beyond the clipping planes or beside the picture; vertices that are no number are outside of all.
    pub outside: u64,
    /// Turned away from the eye, where back faces are not drawn.
    pub back_facing: u64,
    /// Without an area once snapped to the sub-pixel grid, or between the places that are looked at.
    pub too_small: u64,
}

impl Skipped {
    pub(super) fn add(&mut self, other: Self) {
        self.outside += other.outside;
        self.back_facing += other.back_facing;
        self.too_small += other.too_small;
    }
}

/// What a mesh knows of a point of its surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) tangent: Vec4,
    pub(super) uv: Vec2,
}

impl Vertex {
    pub(super) fn of(mesh: &Mesh, vertex: u32) -> Self {
        let i = vertex as usize;
        Self {
            position: mesh.positions()[i],
            normal: mesh.normals()[i],
            tangent: mesh.tangents().get(i).copied().unwrap_or_default(),
            uv: mesh.uvs().get(i).copied().unwrap_or_default(),
        }
    }

    /// The point of a triangle with the given weights: as interpolation over it finds it, nothing normalised.
    fn mixed(corners: &[Self; 3], weights: [f32; 3]) -> Self {
        let [a, b, c] = corners;
        let [u, v, w] = weights;
        Self {
            position: a.position * u + b.position * v + c.position * w,
            normal: a.normal * u + b.normal * v + c.normal * w,
            tangent: a.tangent * u + b.tangent * v + c.tangent * w,
            uv: a.uv * u + b.uv * v + c.uv * w,
        }
    }
}

/// A triangle that reaches the picture. Its corners run clockwise on the screen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    /// Vertices of the mesh; from [`Self::CUT`] on, corners that clipping made, of the same task.
    pub(super) corners: [u32; 3],
    /// Number of the mesh's triangle, and the highest bit for one that is seen from behind.
    source: u32,
}

impl Triangle {
    const CUT: u32 = 1 << 31;
    const BACK: u32 = 1 << 31;

    /// The mesh's triangle.
    pub(super) fn source(&self) -> u32 {
        self.source & !Self::BACK
    }

    pub(super) fn back_facing(&self) -> bool {
        self.source & Self::BACK != 0
    }

    /// Which corner that clipping made this is, if it is one.
    pub(super) fn cut(corner: u32) -> Option<usize> {
        (corner & Self::CUT != 0).then_some((corner & !Self::CUT) as usize)
    }
}

/// A corner that clipping made.
#[derive(Debug, Clone, Copy)]
pub(super) struct CutCorner {
    pub(super) screen: ScreenVertex,
    /// Its weights in the mesh's triangle.
    pub(super) weights: [f32; 3],
}

/// The triangles of one task.
#[derive(Debug, Default)]
pub(super) struct Chunk {
    pub(super) triangles: Vec<Triangle>,
    pub(super) cut: Vec<CutCorner>,
    /// As the vertices', for the corners that clipping made.
    pub(super) cut_attributes: Vec<f32>,
    /// Triangle and tile, in the order of the triangles.
    placed: Vec<[u32; 2]>,
    /// Where the triangles of each tile begin in `list`, and where the last one's end.
    starts: Vec<u32>,
    list: Vec<u32>,
    skipped: Skipped,
}

impl Chunk {
    /// The triangles that may touch a tile, in the order of the mesh.
    pub(super) fn of_tile(&self, tile: usize) -> &[u32] {
        &self.list[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }

    /// Sorts what was placed by tile, keeping the order within each.
    fn sort(&mut self, tiles: usize) {
        self.starts.clear();
        self.starts.resize(tiles + 1, 0);
        for [_, tile] in &self.placed {
            self.starts[*tile as usize + 1] += 1;
        }
        for tile in 0..tiles {
            self.starts[tile + 1] += self.starts[tile];
        }
        self.list.clear();
        self.list.resize(self.placed.len(), 0);
        for &[triangle, tile] in &self.placed {
            let next = &mut self.starts[tile as usize];
            self.list[*next as usize] = triangle;
            *next += 1;
        }
        // Each start has moved to the end of its tile, which is the next one's start.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }
}

/// One object on the screen. Kept from frame to frame, for its memory.
#[derive(Debug, Default)]
pub(super) struct Front {
    pub(super) vertices: Vec<ScreenVertex>,
    outside: Vec<u8>,
    /// Attributes of the vertices, one after the other.
    pub(super) attributes: Vec<f32>,
    pub(super) chunks: Vec<Chunk>,
}

impl Front {
    /// Whether the object may touch a tile.
    pub(super) fn touches(&self, number: usize) -> bool {
        self.chunks.iter().any(|chunk| !chunk.of_tile(number).is_empty())
    }
}

/// What a shader wants of each vertex, from the vertex and its 1/w.
pub(super) trait Attributes<const N: usize>: Fn(&Vertex, f32) -> [f32; N] + Sync + Send {}
impl<const N: usize, F: Fn(&Vertex, f32) -> [f32; N] + Sync + Send> Attributes<N> for F {}

impl Front {
    /// Projects the object's vertices and sorts its triangles into the tiles of a picture of `size`.
    pub(super) fn run<const N: usize>(
        &mut self,
        level: Level,
        object: &Object<'_>,
        projection: &Projection,
        (size, samples): ((u32, u32), Samples),
        attributes: impl Attributes<N>,
    ) -> Skipped {
        self.project(level, object.mesh, projection, &attributes);
        let triangles = object.mesh.triangles().len();
        let a_task = TRIANGLES_A_TASK.max(triangles.div_ceil(MOST_TASKS));
        let mut chunks = std::mem::take(&mut self.chunks);
        chunks.resize_with(triangles.div_ceil(a_task), Chunk::default);
        let grid = Tiles::new(size, samples);
        par::for_each_row(&mut chunks, 1, |task, chunk| {
            let range = task * a_task..((task + 1) * a_task).min(triangles);
            self.bin(&mut chunk[0], range, object, projection, &grid, &attributes);
        });
        self.chunks = chunks;
        let mut skipped = Skipped::default();
        self.chunks.iter().for_each(|chunk| skipped.add(chunk.skipped));
        skipped
    }

    fn project<const N: usize>(
        &mut self,
        level: Level,
        mesh: &Mesh,
        projection: &Projection,
        attributes: &impl Attributes<N>,
    ) {
        let positions = mesh.positions();
        self.vertices.resize(positions.len(), ScreenVertex::default());
        self.outside.resize(positions.len(), 0);
        self.attributes.resize(positions.len() * N, 0.0);
        let parts = (&mut self.vertices[..], &mut self.outside[..], &mut self.attributes[..]);
        let widths = [VERTICES_A_TASK, VERTICES_A_TASK, VERTICES_A_TASK * N];
        par::for_each_row3(parts, widths, |task, (vertices, outside, values)| {
            let first = task * VERTICES_A_TASK;
            let positions = &positions[first..first + vertices.len()];
            dispatch!(level, simd => project_all(simd, projection, positions, vertices, outside));
            for (i, (vertex, values)) in vertices.iter().zip(values.as_chunks_mut::<N>().0).enumerate() {
                *values = attributes(&Vertex::of(mesh, (first + i) as u32), vertex.inv_w);
            }
        });
    }

    fn bin<const N: usize>(
        &self,
        chunk: &mut Chunk,
        range: std::ops::Range<usize>,
        object: &Object<'_>,
        projection: &Projection,
        grid: &Tiles,
        attributes: &impl Attributes<N>,
    ) {
        let Chunk { triangles, cut, cut_attributes, placed, skipped, .. } = chunk;
        triangles.clear();
        cut.clear();
        cut_attributes.clear();
        placed.clear();
        *skipped = Skipped::default();
        let mut place = |corners: [u32; 3], screen: [ScreenVertex; 3], source: usize, skipped: &mut Skipped| {
            let area2 = area2(&screen);
            if area2 == 0 {
                skipped.too_small += 1;
                return;
            }
            // Counter-clockwise in the world is counter-clockwise to the eye.
            let back_facing = area2 > 0;
            if back_facing && !object.double_sided {
                skipped.back_facing += 1;
                return;
            }
            let Some(bounds) = Bounds::of(&screen, grid.size, grid.reach) else {
                skipped.too_small += 1;
                return;
            };
            let [a, b, c] = corners;
            let number = triangles.len() as u32;
            let (corners, behind) = if back_facing { ([a, b, c], Triangle::BACK) } else { ([a, c, b], 0) };
            triangles.push(Triangle { corners, source: source as u32 | behind });
            let tiles = |pixels: [i32; 2]| pixels[0] as u32 / TILE as u32..=pixels[1] as u32 / TILE as u32;
            for y in tiles(bounds.y) {
                placed.extend(tiles(bounds.x).map(|x| [number, y * grid.columns + x]));
            }
        };
        let mesh = object.mesh;
        for (source, &corners) in range.clone().zip(&mesh.triangles()[range]) {
            let outside = corners.map(|v| self.outside[v as usize]);
            if outside == [0; 3] {
                place(corners, corners.map(|v| self.vertices[v as usize]), source, skipped);
                continue;
            }
            let clips: [DVec4; 3] = corners.map(|v| projection.clip_position(mesh.positions()[v as usize]).as_dvec4());
            let nowhere = outside[0] & outside[1] & outside[2] != 0 || clips.iter().any(|c| c.is_nan());
            let polygon = if nowhere { Vec::new() } else { clip(clips, projection.guard_band()) };
            if polygon.is_empty() {
                skipped.outside += 1;
                continue;
            }
            let first = cut.len() as u32;
            let vertices = corners.map(|v| Vertex::of(mesh, v));
            for corner in &polygon {
                let screen = projection.snap(corner.position.as_vec4());
                let weights = corner.weights.map(|w| w as f32);
                cut.push(CutCorner { screen, weights });
                cut_attributes.extend(attributes(&Vertex::mixed(&vertices, weights), screen.inv_w));
            }
            for i in 2..polygon.len() as u32 {
                let fan = [0, i - 1, i].map(|k| first + k);
                let screen = fan.map(|k| cut[k as usize].screen);
                place(fan.map(|k| k | Triangle::CUT), screen, source, skipped);
            }
        }
        chunk.sort((grid.columns * grid.rows) as usize);
    }
}

/// The tiles of a picture.
pub(super) struct Tiles {
    size: [i32; 2],
    /// See [`Samples::reach`].
    reach: i32,
    pub(super) columns: u32,
    pub(super) rows: u32,
}

impl Tiles {
    pub(super) fn new((width, height): (u32, u32), samples: Samples) -> Self {
        let count = |side: u32| side.div_ceil(TILE as u32);
        let (size, reach) = ([width as i32, height as i32], samples.reach());
        Self { size, reach, columns: count(width), rows: count(height) }
    }
}

/// Twice the area in sub-pixels squared; positive if the corners run clockwise on the screen.
fn area2([a, b, c]: &[ScreenVertex; 3]) -> i64 {
    let (x, y) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
    x * i64::from(c.y - a.y) - y * i64::from(c.x - a.x)
}

#[inline(always)]
fn project_all<S: Simd>(
    simd: S,
    projection: &Projection,
    positions: &[Vec3],
    vertices: &mut [ScreenVertex],
    outside: &mut [u8],
) {
    let parts = positions.chunks(16).zip(vertices.chunks_mut(16)).zip(outside.chunks_mut(16));
    for ((positions, vertices), outside) in parts {
        let mut lanes = [[0.0; 16]; 3];
        for (i, position) in positions.iter().enumerate() {
            (lanes[0][i], lanes[1][i], lanes[2][i]) = (position.x, position.y, position.z);
        }
        let (found, planes) = projection.project(simd, three!(k => f32x16::load_array_ref(simd, &lanes[k])));
        vertices.copy_from_slice(&found[..vertices.len()]);
        outside.copy_from_slice(&planes[..outside.len()]);
    }
}
