//! Bit-exact integer models of bump-mapping units: polar ones, published and exact, and those they are compared with.
//!
//! A unit takes 16-bit words that say where the light, the halfway vector and the normal of a pixel point and how the bump-vector
//! map bends the normal, and gives `N'·L'` and `N'·H'`. Angles are binary (a turn is 2¹⁶), values are Q2.14; no floating-point number
//! is anywhere, in the data paths or in the making of their tables. Every stage's width, rounding and overflow stands in the table
//! at the top of its unit's file.
//!
//! A unit is written once, over a few operators, and can be run or counted: [`Model::products`] and [`Model::cost`] read the
//! same structure.
//!
//! ```
//! use rilievo_polar::{Frame, LightTables, Model, UnitKind, Width};
//!
//! let unit = Model::new(UnitKind::E3, Width::PAPER, Frame::default());
//! // A light 60° and a halfway vector 30° off the normal, which is the z axis; a flat bump vector (ξ = 0, ρ = 1, y = 0).
//! let degrees = |degrees: u32| (degrees * 65536 / 360) as u16;
//! let [light, half] = unit.products(&[0, degrees(60), 0, degrees(30), 0, 0, 0, 1 << 14, 0]);
//! assert!((i32::from(light) - (1 << 13)).abs() < 32 && half > light);
//!
//! let cost = unit.cost(&LightTables::new(Width::PAPER, 65535, 65535, 20)).total();
//! assert_eq!((cost.multipliers, cost.adders, cost.tables), (6, 20, 12));
//! ```
//!
//! Source: Lee et al., "An effective bump mapping hardware architecture using polar coordinate system"; E1 to E4d are this
//! project's.

#![no_std]
#![forbid(unsafe_code)]

extern crate alloc;

mod cost;
mod frame;
mod geometry;
mod light;
mod limit;
mod logic;
mod model;
mod rom;
mod unit;

pub use cost::{Printed, StageCost, UnitCost};
pub use frame::{Direction, Frame};
pub use geometry::Sample;
pub use light::LightTables;
pub use logic::{Cost, Stage};
pub use model::{Model, Twist, UnitKind, UnknownUnit};
pub use rom::{FRACTION, HALF, ONE, QUARTER, Rom, Width, WidthError};
pub use unit::{Bump, Port, Vector};
