//! The polar bump units on this library's side: their maps, their words, their errors.
//!
//! The units themselves are integer models in a crate that knows nothing of this one.

mod bump;
pub(crate) mod encode;
mod errors;
mod rotation;

pub use bump::{BumpFrame, BumpVectorMap};
pub(crate) use bump::{MOST_WORDS, bump_ports, words};
pub use errors::{ErrorStats, LightSampling, PixelSampling, UnitErrors, rotation_errors, unit_errors};
pub use rilievo_polar::{
    Cost, Direction, Frame, LightTables, Model, Port, Printed, Rom, Sample, StageCost, Twist, UnitCost, UnitKind, Width,
};
pub use rotation::{Polar, Rotation};
