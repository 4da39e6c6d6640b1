//! What is rendered or baked onto: built-in shapes and mesh files.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::Result;
use rilievo::surface::{Mesh, shapes};
use rilievo_io::Limits;

use crate::exit;
use crate::inputs;

/// A built-in shape, or a mesh file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SurfaceArg {
    Plane,
    Cube,
    Sphere { segments: u32, rings: u32 },
    Torus { segments: u32, sides: u32 },
    Vase,
    File(PathBuf),
}

/// What `SurfaceArg` reads, for help texts.
pub(crate) const SURFACE_HELP: &str = "A mesh file (OBJ, PLY, GLB; - is stdin), or a built-in shape: plane, cube, sphere[:SEGMENTSxRINGS], \
     torus[:SEGMENTSxSIDES], vase";

impl FromStr for SurfaceArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, detail) = text.split_once(':').unwrap_or((text, ""));
        let counts = |default: (u32, u32)| {
            if detail.is_empty() {
                return Ok(default);
            }
            let parsed = detail.split_once('x').map(|(a, b)| (a.parse(), b.parse()));
            match parsed {
                Some((Ok(a), Ok(b))) => Ok((a, b)),
                _ => Err(format!("'{text}': after the colon comes NxM, as in torus:16x9")),
            }
        };
        if matches!(name, "plane" | "cube" | "vase") && text.contains(':') {
            return Err(format!("'{text}': {name} has no numbers after a colon"));
        }
        Ok(match name {
            "plane" => Self::Plane,
            "cube" => Self::Cube,
            "vase" => Self::Vase,
            "sphere" => counts((64, 32)).map(|(segments, rings)| Self::Sphere { segments, rings })?,
            "torus" => counts((48, 24)).map(|(segments, sides)| Self::Torus { segments, sides })?,
            _ => Self::File(PathBuf::from(text)),
        })
    }
}

impl SurfaceArg {
    /// What a scene's object is if nothing is said.
    pub(crate) const DEFAULT: Self = Self::Sphere { segments: 64, rings: 32 };

    /// The mesh; a plane has the shape of its map.
    pub(crate) fn load(&self, (map_width, map_height): (u32, u32)) -> Result<Mesh> {
        Ok(match self {
            Self::Plane => shapes::plane(map_width as f32 / map_height as f32)?,
            Self::Cube => shapes::cube(shapes::CubeUvs::Atlas)?,
            Self::Sphere { segments, rings } => shapes::sphere(*segments, *rings)?,
            Self::Torus { segments, sides } => shapes::torus(*segments, *sides, 1.0, 0.42)?,
            Self::Vase => rilievo::sample::vase::mesh(rilievo::sample::vase::DEFAULT_SEGMENTS)?,
            Self::File(path) => load_file(path)?,
        })
    }

    /// The file it is read from, if it is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        if let Self::File(path) = self { Some(path) } else { None }
    }

    /// How often a map repeats over the texture square unless told otherwise: whole maps on each face of a cube.
    pub(crate) fn default_repeat(&self) -> [f32; 2] {
        if *self == Self::Cube { shapes::CUBE_ATLAS_REPEAT } else { [1.0, 1.0] }
    }

    /// For names of outputs.
    pub(crate) fn stem(&self) -> String {
        match self {
            Self::Plane => "plane".into(),
            Self::Cube => "cube".into(),
            Self::Sphere { .. } => "sphere".into(),
            Self::Torus { .. } => "torus".into(),
            Self::Vase => "vase".into(),
            Self::File(path) => crate::batch::stem(path),
        }
    }
}

fn load_file(path: &Path) -> Result<Mesh> {
    let source = inputs::open(path)?;
    let file = rilievo_io::decode_mesh(&source, &Limits::default())?;
    for warning in &file.warnings {
        exit::warn(source.name(), warning);
    }
    Ok(file.mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_and_files_are_told_apart() {
        let parse = |t: &str| t.parse::<SurfaceArg>();
        assert_eq!(parse("torus:16x9"), Ok(SurfaceArg::Torus { segments: 16, sides: 9 }));
        assert_eq!(parse("sphere"), Ok(SurfaceArg::Sphere { segments: 64, rings: 32 }));
        assert_eq!(parse("./cube.obj"), Ok(SurfaceArg::File("./cube.obj".into())));
        assert!(parse("torus:16").is_err() && parse("sphere:ax4").is_err() && parse("vase:3x4").is_err());
    }
}
