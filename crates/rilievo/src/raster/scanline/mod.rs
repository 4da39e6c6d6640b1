//! The scan-line path: the setting of the source, in scalar code.
//!
//! Edges are walked row by row and vectors by forward differences: one addition per component and pixel for linear
//! interpolation, two for quadratic. [`interpolate`] does that and the depth test alone, so that methods can be timed
//! without what they share; [`draw_scan_lines`] makes pictures.

mod difference;
mod field;
mod outline;
mod place;
mod setup;
mod shade;
mod stage;

pub use setup::{LeftEdges, Setup, set_up_denominator};
pub use shade::draw_scan_lines;
pub use stage::{Stage, interpolate};
