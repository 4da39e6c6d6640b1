//! The built-in sample.
pub mod vase;
