//! Values of the command line, spelled the same in every command.

mod choices;
mod given;
mod light;
mod maps;
mod model;
mod values;

pub(crate) use choices::{
    Bits, BlendArg, ConventionArg, DitherArg, EdgesArg, EffortArg, FilterArg, MaterialsInArg, MethodArg, SamplingArg,
    SpaceArg,
};
pub(crate) use given::Given;
pub(crate) use light::{LightArgs, MaterialArgs, PointLightArgs, Surroundings};
pub(crate) use maps::{HeightArgs, OntoArgs};
pub(crate) use values::{CameraArg, ColorArg, SizeArg, number, pair};
