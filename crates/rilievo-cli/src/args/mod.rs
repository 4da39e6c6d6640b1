//! Values of the command line, spelled the same in every command.

mod choices;
mod given;
mod light;
mod maps;
mod model;
mod unit;
mod values;

pub(crate) use choices::{
    Bits, BlendArg, ConventionArg, DitherArg, EdgesArg, EffortArg, FilterArg, MaterialsInArg, MethodArg, MethodKind,
    MidpointsArg, OrderArg, SamplingArg, SpaceArg, Turn,
};
pub(crate) use given::Given;
pub(crate) use light::{LightArgs, MaterialArgs, PointLightArgs};
pub(crate) use maps::{DEFAULT_DEPTH, DEFAULT_GUTTER, HeightArgs, OntoArgs};
pub(crate) use model::{Finish, ModelArg};
pub(crate) use unit::{TableBitsArg, UnitArg};
pub(crate) use values::{CameraArg, ColorArg, SizeArg, number, pair};
