//! Built-in samples: things worth lighting, made by code, so that they need no file and have any resolution.

mod bricks;
mod covering;
mod globe;
mod noise;
mod planks;
mod turn;
pub mod vase;

pub use bricks::bricks;
pub use covering::Covering;
pub use globe::globe;
pub use planks::planks;
