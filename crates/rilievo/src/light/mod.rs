//! Light: models, materials, and the shade table.
//!
//! One function, [`shade`], evaluates a lighting model for a normal. The shade table calls it once per entry, the
//! per-pixel methods once per pixel; so they can only differ by what they feed it.

mod material;
mod model;
mod relight;
mod shade_table;

pub use material::Material;
pub use model::{DirectionalLight, Lighting, LightingModel, Shade, shade};
pub use relight::relight;
pub use shade_table::ShadeTable;
