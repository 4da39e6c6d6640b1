//! Oracles, generators and comparison shared by the tests of every crate. Not published.
#![forbid(unsafe_code)]

pub mod browser;
mod data;
#[cfg(target_os = "linux")]
pub mod display;
pub mod eye;
pub mod golden;
mod lengths;
mod npy;
pub mod polar;
mod random;
mod skip;
pub mod stages;

pub use data::{shared_data, shared_file};
pub use lengths::{LengthStats, length_stats};
pub use npy::{read_npy_f16, write_npy_f32};
pub use random::{Random, uniform_sphere};
pub use skip::{has_program, skip};
