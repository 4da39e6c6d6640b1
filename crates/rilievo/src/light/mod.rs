//! Light: models, materials, and the shade table.
//!
//! One function, [`shade`], evaluates a material for a normal. The shade table calls it once per entry, the per-pixel
//! methods once per pixel; so they can only differ by what they feed it.

mod environment;
mod lights;
mod material;
mod model;
mod relight;
mod shade;
mod shade_table;

pub use environment::{Environment, Projection};
pub use lights::{Light, Lighting};
pub use material::{Layer, Material};
pub use model::{LightingModel, shade};
pub use relight::relight;
pub use shade::{Blend, Shade};
pub use shade_table::ShadeTable;
