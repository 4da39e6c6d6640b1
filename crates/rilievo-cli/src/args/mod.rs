//! Values of the command line, spelled the same in every command.

mod choices;
mod given;
mod light;
mod maps;
mod values;

pub(crate) use choices::{
    Bits, ConventionArg, DitherArg, EdgesArg, EffortArg, FilterArg, MaterialsInArg, MethodArg, ModelArg, SamplingArg,
    SpaceArg,
};
pub(crate) use given::Given;
pub(crate) use light::{LightArgs, MaterialArgs};
pub(crate) use maps::{HeightArgs, OntoArgs};
pub(crate) use values::{CameraArg, ColorArg, SizeArg, number, pair};
