//! The scan-line path: the setting of the source, in scalar code.
//!
//! Edges are walked row by row and vectors by forward differences: one addition per component and pixel for linear
//! interpolation, two for quadratic. [`interpolate`] does that and the depth test alone, so that methods can be timed
//! without what they share.

mod difference;
mod outline;
mod place;
mod setup;
mod stage;

pub use setup::{Setup, set_up_denominator};
pub use stage::{Stage, interpolate};
