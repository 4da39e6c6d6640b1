//! How normals become colours on the GPU.

use crate::error::{Error, Result};
use rilievo::light::Blend;
use rilievo::polar::UnitKind;
use rilievo::raster::vectors::Midpoints;
use rilievo::raster::{Detail, Object, Scene, TextureFilter};
use rilievo::{Edges, raster};

/// The most lights that interpolated vectors light by: what crosses from the vertex to the fragment stage is limited, in
/// WebGL2 to fifteen vectors.
pub const VECTOR_LIGHTS: usize = 2;

/// A method of the CPU's renderer, or one that only a GPU has a use for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// The same as on the CPU.
    Scene(raster::Method),
    /// By table without a table: each frame the CPU looks up every texel of all mip levels and uploads the light map it gets,
    /// in 8-bit sRGB.
    ///
    /// - **Source:** Tarini et al. 2000, § 5: the way on hardware without paletted textures.
    Expanded,
}

impl From<raster::Method> for Method {
    fn from(method: raster::Method) -> Self {
        Self::Scene(method)
    }
}

/// A pair of shader stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Stages {
    Table,
    Baked,
    Exact,
    Vectors,
    Polar,
}

impl Stages {
    /// Names of the vertex and of the fragment stage.
    pub(crate) const fn entry_points(self) -> (&'static str, &'static str) {
        match self {
            Self::Table => ("vertex_textured", "fragment_table"),
            Self::Baked => ("vertex_textured", "fragment_baked"),
            Self::Exact => ("vertex_surface", "fragment_exact"),
            Self::Vectors => ("vertex_vectors", "fragment_vectors"),
            Self::Polar => ("vertex_surface", "fragment_polar"),
        }
    }

    /// Whether the vertex stage reads the mesh from textures.
    pub(crate) const fn pulls_vertices(self) -> bool {
        matches!(self, Self::Vectors)
    }
}

impl Method {
    /// The method on the CPU whose picture it is.
    pub fn on_cpu(self) -> raster::Method {
        match self {
            Self::Scene(method) => method,
            Self::Expanded => raster::Method::Table,
        }
    }

    pub(crate) fn stages(self) -> Stages {
        match self {
            Self::Expanded | Self::Scene(raster::Method::Static) => Stages::Baked,
            Self::Scene(raster::Method::Table) => Stages::Table,
            Self::Scene(raster::Method::Polar { .. }) => Stages::Polar,
            Self::Scene(raster::Method::Linear | raster::Method::Normalized | raster::Method::Quadratic { .. }) => {
                Stages::Vectors
            }
            Self::Scene(_) => Stages::Exact,
        }
    }

    /// The shader's word for it.
    pub(crate) fn variant(self) -> u32 {
        match self {
            Self::Scene(raster::Method::Normalized) => 1,
            Self::Scene(raster::Method::Quadratic { order: raster::vectors::Order::Linear, .. }) => 0,
            Self::Scene(raster::Method::Quadratic { midpoints, .. }) => 2 | midpoints_word(midpoints) << 8,
            Self::Scene(raster::Method::Polar { unit, width }) => u32::from(unit == UnitKind::E3) | width.bits() << 8,
            _ => 0,
        }
    }

    /// Refuses what the CPU would draw and the GPU does not.
    pub(crate) fn check(self, scene: &Scene<'_>) -> Result<()> {
        if let Self::Scene(raster::Method::Polar { unit, .. }) = self
            && !matches!(unit, UnitKind::E2 | UnitKind::E3)
        {
            let remedy = "the units e2 and e3 are there; the CPU renderer has all of them";
            return Err(Error::Unsupported { what: format!("the polar unit {unit}"), remedy });
        }
        let lights = scene.lighting.lights.len();
        if self.stages() == Stages::Vectors && lights > VECTOR_LIGHTS {
            let remedy = "interpolated vectors take two lights there; use fewer, the exact method, or the CPU renderer";
            return Err(Error::Unsupported { what: format!("{lights} lights by interpolated vectors"), remedy });
        }
        Ok(())
    }
}

fn midpoints_word(midpoints: Midpoints) -> u32 {
    match midpoints {
        Midpoints::NewFrames => 0,
        Midpoints::AveragedVectors => 1,
        Midpoints::GramSchmidt => 2,
    }
}

pub(crate) fn filter_word(filter: TextureFilter) -> u32 {
    match filter {
        TextureFilter::Nearest => 0,
        TextureFilter::Bilinear => 1,
        TextureFilter::Trilinear => 2,
    }
}

pub(crate) fn edges_word(edges: Edges) -> u32 {
    match edges {
        Edges::Wrap => 0,
        Edges::Clamp => 1,
        Edges::Mirror => 2,
    }
}

pub(crate) fn blend_word(blend: Blend) -> Result<u32> {
    Ok(match blend {
        Blend::Add => 0,
        Blend::Exact => 1,
        Blend::Approximate => 2,
        Blend::Material => 3,
        other => {
            let remedy = "use another blend, or the CPU renderer";
            return Err(Error::Unsupported { what: format!("the blend {other:?}"), remedy });
        }
    })
}

pub(crate) fn detail_word(object: &Object<'_>) -> u32 {
    match object.detail {
        Detail::Smooth | Detail::Baked(_) => 0,
        Detail::Tangent { .. } => 1,
        Detail::Object { .. } | Detail::Bump { .. } => 2,
        Detail::Indexed(_) => 3,
    }
}
