//! The scene in euc, a software rasteriser in Rust: scalar, a closure for a pixel.

use super::renderer::{Job, Renderer, Sampling, Shading, unpack};
use super::scene::{self, MAP_SIDE, REPEAT, SIDE, Size, Subject, View};
use anyhow::{Result, bail};
use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingEnabled, Triangles};
use euc::{Interpolate, Pipeline, Target};
use glam::{Mat4, Vec2, Vec3};
use rilievo::Rgba8;
use rilievo::color::Picture;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A subject with what euc wants of it: three vertices for each triangle.
struct Loaded {
    subject: &'static Subject,
    corners: Vec<u32>,
    /// The normal map's bytes as vectors, decoded beforehand as a CPU program would.
    normals: Vec<Vec3>,
}

pub(super) struct Euc {
    subjects: HashMap<Size, Loaded>,
    color: Buffer2d<u32>,
    depth: Buffer2d<f32>,
}

impl Loaded {
    fn new(size: Size) -> Result<Self> {
        let subject = Subject::get(size)?;
        let corners = subject.mesh.triangles().as_flattened().to_vec();
        let normals = subject.maps.normals.base().texels().iter().map(|n| n.vec()).collect();
        Ok(Self { subject, corners, normals })
    }
}

impl Euc {
    pub(super) fn new() -> Self {
        let size = [SIDE as usize; 2];
        Self { subjects: HashMap::new(), color: Buffer2d::new(size, 0), depth: Buffer2d::new(size, 1.0) }
    }
}

/// The smallest power of the highlight's base that is no denormal number; as in the GPU's shader.
const LEAST: f32 = 0.0652;

struct Exact<'a> {
    loaded: &'a Loaded,
    to_clip: Mat4,
    eye: Vec3,
    light: Vec3,
    colors: [Vec3; 3],
    encode: &'a [u8; ENCODE_STEPS + 1],
}

/// What euc interpolates.
#[derive(Clone)]
struct Framed {
    uv: Vec2,
    position: Vec3,
    tangent: Vec3,
    bitangent: Vec3,
    normal: Vec3,
}

impl Framed {
    fn mix(&self, o: &Self, f: impl Fn(Vec3, Vec3) -> Vec3) -> Self {
        Self {
            uv: f(self.uv.extend(0.0), o.uv.extend(0.0)).truncate(),
            position: f(self.position, o.position),
            tangent: f(self.tangent, o.tangent),
            bitangent: f(self.bitangent, o.bitangent),
            normal: f(self.normal, o.normal),
        }
    }
}

impl Interpolate for Framed {
    fn lerp2(a: Self, b: Self, x: f32, y: f32) -> Self {
        a.mix(&b, |a, b| a * x + b * y)
    }

    fn lerp3(a: Self, b: Self, c: Self, x: f32, y: f32, z: f32) -> Self {
        a.mix(&b, |a, b| a * x + b * y).mix(&c, |ab, c| ab + c * z)
    }
}

impl Pipeline for Exact<'_> {
    type Vertex = u32;
    type VsOut = Framed;
    type Pixel = u32;

    #[inline(always)]
    fn vert(&self, &i: &u32) -> ([f32; 4], Framed) {
        let (mesh, i) = (&self.loaded.subject.mesh, i as usize);
        let (position, normal, tangent) = (mesh.positions()[i], mesh.normals()[i], mesh.tangents()[i]);
        let bitangent = normal.cross(tangent.truncate()) * tangent.w;
        let uv = mesh.uvs()[i] * REPEAT;
        let clip = (self.to_clip * position.extend(1.0)).to_array();
        (clip, Framed { uv, position, tangent: tangent.truncate(), bitangent, normal })
    }

    #[inline(always)]
    fn frag(&self, v: &Framed) -> u32 {
        let m = self.loaded.normals[texel(v.uv)];
        let n = (v.tangent * m.x + v.bitangent * m.y + v.normal * m.z).normalize();
        let l = (self.light - v.position).normalize();
        let h = (l + (self.eye - v.position).normalize()).normalize();
        let cosine = n.dot(l);
        let s = n.dot(h).max(LEAST);
        let s = s * s;
        let s = s * s;
        let s = s * s;
        let s = s * s;
        let highlight = if cosine > 0.0 { s * s } else { 0.0 };
        let [ambient, diffuse, specular] = self.colors;
        let light = ambient + cosine.max(0.0) * diffuse + highlight * specular;
        let [r, g, b] = (light * ENCODE_STEPS as f32).to_array().map(|c| self.encode[(c as usize).min(ENCODE_STEPS)]);
        u32::from_le_bytes([r, g, b, 255])
    }
}

struct ByTable<'a> {
    loaded: &'a Loaded,
    to_clip: Mat4,
    indices: &'a [u16],
    colors: &'a [u32],
}

/// Texture coordinates; the trait is euc's and so is `Vec2` not.
#[derive(Clone)]
struct Uv(Vec2);

impl Interpolate for Uv {
    fn lerp2(a: Self, b: Self, x: f32, y: f32) -> Self {
        Self(a.0 * x + b.0 * y)
    }

    fn lerp3(a: Self, b: Self, c: Self, x: f32, y: f32, z: f32) -> Self {
        Self(a.0 * x + b.0 * y + c.0 * z)
    }
}

impl Pipeline for ByTable<'_> {
    type Vertex = u32;
    type VsOut = Uv;
    type Pixel = u32;

    #[inline(always)]
    fn vert(&self, &i: &u32) -> ([f32; 4], Uv) {
        let (mesh, i) = (&self.loaded.subject.mesh, i as usize);
        ((self.to_clip * mesh.positions()[i].extend(1.0)).to_array(), Uv(mesh.uvs()[i]))
    }

    #[inline(always)]
    fn frag(&self, v: &Uv) -> u32 {
        self.colors[usize::from(self.indices[texel(v.0)])]
    }
}

/// The nearest texel of a wrapped map; its side is a power of two.
#[inline(always)]
fn texel(uv: Vec2) -> usize {
    let side = MAP_SIDE as i32;
    let wrapped = |c: f32| ((c * side as f32).floor() as i32 & (side - 1)) as usize;
    wrapped(uv.y) * side as usize + wrapped(uv.x)
}

/// Steps of the table that encodes to sRGB; the first of them spans less than two codes.
const ENCODE_STEPS: usize = 4096;

fn encode_table() -> Box<[u8; ENCODE_STEPS + 1]> {
    let code = |i: usize| {
        let linear = (i as f32 + 0.5) / ENCODE_STEPS as f32;
        (rilievo::color::srgb_encode(linear.min(1.0)) * 255.0 + 0.5) as u8
    };
    Box::new(std::array::from_fn(code))
}

impl Renderer for Euc {
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()> {
        if job.sampling != Sampling::Nearest {
            bail!("only nearest texels were written for euc");
        }
        let loaded = match self.subjects.entry(job.size) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Loaded::new(job.size)?),
        };
        let view = View::new(view)?;
        let view = if job.dark { view.dark() } else { view };
        let to_clip = view.view_projection();
        let (color, depth) = (&mut self.color, &mut self.depth);
        match job.shading {
            Shading::Exact => {
                let encode = encode_table();
                let colors = scene::light_colors().map(|[r, g, b, _]| Vec3::new(r, g, b));
                let (eye, light) = (view.camera.eye(), view.light);
                let pipeline = Exact { loaded, to_clip, eye, light, colors, encode: &encode };
                draw_with(&pipeline, &loaded.corners, color, depth, frames);
            }
            Shading::Table => {
                let colors: Vec<u32> = loaded
                    .subject
                    .lit_table(&view)?
                    .iter()
                    .map(|&Rgba8 { r, g, b, a }| u32::from_le_bytes([r, g, b, a]))
                    .collect();
                let indices = loaded.subject.indexed()?.base().texels();
                let pipeline = ByTable { loaded, to_clip, indices, colors: &colors };
                draw_with(&pipeline, &loaded.corners, color, depth, frames);
            }
            Shading::Normalized | Shading::Quadratic | Shading::Flat => {
                bail!("{:?} was not written for euc", job.shading)
            }
        }
        Ok(())
    }

    fn picture(&mut self) -> Result<Picture> {
        unpack(SIDE, self.color.as_ref())
    }
}

fn draw_with<P: Pipeline<Vertex = u32, Pixel = u32>>(
    pipeline: &P,
    corners: &[u32],
    color: &mut Buffer2d<u32>,
    depth: &mut Buffer2d<f32>,
    frames: usize,
) {
    for _ in 0..frames {
        color.clear(0);
        depth.clear(1.0);
        pipeline.draw::<Triangles<'_, _, BackfaceCullingEnabled>, _>(corners, color, Some(depth));
    }
}
