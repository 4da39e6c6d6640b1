//! What the readers of all formats gather: one mesh within the limits, and warnings.

use glam::{Vec2, Vec3};
use rilievo::surface::{Mesh, MeshParts};

use super::MeshFile;
use super::polygon::triangulate;
use crate::{Error, Limits, Result};

/// A vertex as a file gives it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub(super) position: Vec3,
    pub(super) normal: Option<Vec3>,
    /// v down.
    pub(super) uv: Option<Vec2>,
}

/// Vertices and triangles so far. Missing normals are held as zero (the mesh computes them), missing coordinates as zero.
pub(super) struct Assembly<'a> {
    pub(super) name: &'a str,
    pub(super) limits: &'a Limits,
    parts: MeshParts,
    with_uv: usize,
    small_faces: usize,
    warnings: Vec<String>,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(name: &'a str, limits: &'a Limits) -> Self {
        Self { name, limits, parts: MeshParts::default(), with_uv: 0, small_faces: 0, warnings: Vec::new() }
    }

    pub(super) fn warn(&mut self, warning: impl Into<String>) {
        self.warnings.push(warning.into());
    }

    /// Damage at a place of this file.
    pub(super) fn damage(&self, place: impl Into<String>, reason: impl Into<String>) -> Error {
        Error::format(self.name, place, reason)
    }

    pub(super) fn vertices(&self) -> usize {
        self.parts.positions.len()
    }

    /// Refuses a list of `count` vertices (or of what vertices are made of), before it is made.
    pub(super) fn check_vertices(&self, count: u64) -> Result<()> {
        if count > self.limits.max_vertices.min(u32::MAX as usize) as u64 {
            return Err(Error::limits(self.name, format!("a mesh of {count} vertices"), self.limits.max_vertices));
        }
        Ok(())
    }

    fn check_triangles(&self, more: usize) -> Result<()> {
        let count = self.parts.triangles.len().saturating_add(more);
        if count > self.limits.max_triangles {
            return Err(Error::limits(self.name, format!("a mesh of {count} triangles"), self.limits.max_triangles));
        }
        Ok(())
    }

    /// Adds a vertex and gives its number.
    pub(super) fn push_vertex(&mut self, vertex: Vertex) -> Result<u32> {
        self.check_vertices(self.vertices() as u64 + 1)?;
        let number = self.vertices() as u32;
        self.parts.positions.push(vertex.position);
        self.parts.normals.push(vertex.normal.unwrap_or(Vec3::ZERO));
        self.parts.uvs.push(vertex.uv.unwrap_or(Vec2::ZERO));
        self.with_uv += usize::from(vertex.uv.is_some());
        Ok(number)
    }

    /// Adds a triangle of vertices that exist.
    pub(super) fn push_triangle(&mut self, triangle: [u32; 3]) -> Result<()> {
        self.check_triangles(1)?;
        self.parts.triangles.push(triangle);
        Ok(())
    }

    /// Adds a polygon of vertices that exist, cut into triangles; one of fewer than three corners is counted and left out.
    pub(super) fn push_polygon(&mut self, place: impl Fn() -> String, corners: &[u32]) -> Result<()> {
        match *corners {
            [a, b, c] => self.push_triangle([a, b, c]),
            [_, _, _, ..] => {
                self.check_triangles(corners.len() - 2)?;
                let positions: Vec<_> = corners.iter().map(|&i| self.parts.positions[i as usize].as_dvec3()).collect();
                let cut = triangulate(&positions).map_err(|e| {
                    let remedy = "triangulate the mesh where it was made";
                    Error::unsupported(self.name, format!("{}: {e}", place()), remedy)
                })?;
                self.parts.triangles.extend(cut.iter().map(|t| t.map(|k| corners[k])));
                Ok(())
            }
            _ => {
                self.small_faces += 1;
                Ok(())
            }
        }
    }

    /// The mesh, checked and completed.
    pub(super) fn finish(mut self) -> Result<MeshFile> {
        let vertices = self.vertices();
        if self.with_uv == 0 {
            self.parts.uvs = Vec::new();
        } else if self.with_uv < vertices {
            let without = vertices - self.with_uv;
            self.warn(format!("{without} of {vertices} vertices have no texture coordinates; (0, 0) stands for them."));
        }
        if self.small_faces > 0 {
            self.warn(format!("{} faces of fewer than three corners were left out.", self.small_faces));
        }
        let mesh = Mesh::new(self.parts).map_err(|e| Error::invalid(self.name, e))?;
        if mesh.triangles().is_empty() {
            self.warnings.push("No triangle has an area: there is nothing to be seen.".to_owned());
        } else if mesh.dropped_triangles() > 0 {
            self.warnings.push(format!("{} triangles without an area were left out.", mesh.dropped_triangles()));
        }
        Ok(MeshFile { mesh, warnings: self.warnings })
    }
}
