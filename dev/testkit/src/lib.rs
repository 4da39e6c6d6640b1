//! Oracles, generators and comparison shared by the tests of every crate. Not published.
#![forbid(unsafe_code)]

mod data;
mod random;

pub use data::{has_program, shared_data, shared_file, skip};
pub use random::{Random, uniform_sphere};
