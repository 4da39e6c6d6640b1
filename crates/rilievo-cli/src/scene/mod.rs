//! What is rendered: objects, light, a camera, a picture. The command line and scene files both fill [`SceneSpec`];
//! whatever is drawn afterwards is drawn from it.

mod camera;
mod file;
mod light;
mod material;

use std::path::{Path, PathBuf};

use rilievo::light::Blend;
use rilievo::raster::{Method, TextureFilter};
use rilievo::{LinearRgb, Pose};

use crate::args::{
    Given, MethodArg, MethodKind, MidpointsArg, OrderArg, SamplingArg, SizeArg, TableBitsArg, Turn, UnitArg,
};
use crate::relief::ReliefArgs;

pub(crate) use camera::CameraSpec;
pub(crate) use file::{is_scene, read};
pub(crate) use light::{Lamp, LightSpec, Side, Surroundings};
pub(crate) use material::{MaterialSpec, takes_vectors};

/// Everything a picture, or an animation, is made from.
#[derive(Debug, Clone)]
pub(crate) struct SceneSpec {
    /// For messages and names of outputs.
    pub(crate) name: String,
    /// The scene file, if there is one.
    pub(crate) file: Option<PathBuf>,
    pub(crate) objects: Vec<ObjectSpec>,
    pub(crate) light: LightSpec,
    pub(crate) camera: CameraSpec,
    pub(crate) picture: PictureSpec,
}

/// One object: a surface with its maps, where it stands, what it is made of.
#[derive(Debug, Clone)]
pub(crate) struct ObjectSpec {
    /// For messages: the surface, or its place in the scene file.
    pub(crate) name: String,
    pub(crate) relief: ReliefArgs,
    /// What of `relief` was written, and how it is called there.
    pub(crate) given: Given,
    pub(crate) pose: Pose,
    pub(crate) materials: MaterialSpec,
    pub(crate) blend: Blend,
    pub(crate) double_sided: bool,
}

/// How the picture is drawn and where it goes.
#[derive(Debug, Clone)]
pub(crate) struct PictureSpec {
    pub(crate) output: Option<PathBuf>,
    pub(crate) method: MethodArg,
    pub(crate) order: OrderArg,
    pub(crate) midpoints: MidpointsArg,
    pub(crate) unit: UnitArg,
    pub(crate) table_bits: TableBitsArg,
    pub(crate) sampling: SamplingArg,
    pub(crate) size: SizeArg,
    /// Transparent without it.
    pub(crate) background: Option<LinearRgb>,
    /// Samples along each side of a pixel.
    pub(crate) samples: u32,
    /// Four samples a pixel for outlines alone.
    pub(crate) antialias: bool,
    pub(crate) frames: u32,
    pub(crate) turn: Turn,
    /// Milliseconds a frame is shown.
    pub(crate) delay: u16,
    /// Draw with the scalar reference renderer.
    pub(crate) reference: bool,
}

impl PictureSpec {
    /// The library's name of the method.
    pub(crate) fn method(&self) -> Method {
        self.method.with((self.order, self.midpoints), (self.unit.0, self.table_bits.0))
    }

    /// What the method needs of an object's normals.
    pub(crate) fn kind(&self) -> MethodKind {
        match self.method.into() {
            MethodKind::Polar(_) => MethodKind::Polar(self.unit.0),
            kind => kind,
        }
    }

    /// How a pixel gathers texels.
    pub(crate) fn filter(&self) -> TextureFilter {
        self.sampling.into()
    }

    /// Warns of what was written and plays no part in such a picture.
    pub(crate) fn warn_of_unused(&self, given: &Given) {
        if self.frames == 1 {
            given.unused(&["turn", "delay"], "one frame is no animation; ask for more frames");
        }
        if self.method != MethodArg::Quadratic {
            given.unused(&["order", "midpoints"], "they are for the quadratic method");
        } else if self.order == OrderArg::Linear {
            given.unused(&["midpoints"], "linear polynomials have no midpoints");
        }
        if self.method != MethodArg::Polar {
            given.unused(&["unit", "table_bits"], "they are for the polar method");
        }
    }
}

impl SceneSpec {
    /// Files this reads, so that none of them is written over.
    pub(crate) fn files(&self) -> Vec<&Path> {
        let own = self.file.iter().chain(&self.light.environment).map(PathBuf::as_path);
        own.chain(self.objects.iter().flat_map(|o| o.relief.files())).collect()
    }

    /// How messages call the whole.
    pub(crate) fn called(&self) -> String {
        self.file.as_ref().map_or_else(|| self.name.clone(), |file| file.display().to_string())
    }

    /// Whether any material shows the environment.
    pub(crate) fn mirrors(&self) -> bool {
        self.objects.iter().any(|o| o.materials.mirrors())
    }
}
