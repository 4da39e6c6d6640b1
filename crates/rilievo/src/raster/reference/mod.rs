//! The reference renderer: plain scalar code, clear before fast; every faster path is held against it.

mod baked;
mod draw;
mod exact;
mod interpolated;
mod polar;
mod table;

pub(super) use baked::Baked;
pub use baked::bake_light_map;
pub use draw::draw;
pub(super) use draw::{ScreenTriangle, base_color, set_up, shade};
pub(super) use exact::Exact;
pub(super) use interpolated::Interpolated;
pub(super) use polar::Polar;
pub use table::LitTables;
pub(super) use table::Table;
