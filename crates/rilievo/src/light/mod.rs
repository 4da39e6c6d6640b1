//! Light: models, materials, and the shade table.
//!
//! One function, [`shade`], defines what a material does with light. Shade tables and tiles of pixels evaluate it sixteen
//! normals at a time (`lanes`), held against the definition in a test; so the methods can only differ by what they feed it.

mod environment;
mod lane_blend;
mod lane_environment;
mod lane_facet;
#[cfg(test)]
mod lane_tests;
mod lanes;
mod lights;
mod material;
mod microfacet;
mod model;
mod relight;
mod scalar;
mod shade;
mod shade_table;
#[cfg(test)]
mod tests;

pub use environment::{Environment, EnvironmentCopy, Projection};
pub(crate) use lanes::Prepared;
pub use lights::{Light, Lighting};
pub use material::{Layer, Material};
pub use model::{Bands, Landscape, LightingModel, MAX_BANDS};
pub use relight::relight;
pub use scalar::shade;
pub use shade::{Blend, Shade};
pub use shade_table::ShadeTable;
