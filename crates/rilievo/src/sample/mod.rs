//! The built-in sample: something worth lighting, made by code, so that it needs no file and has any resolution.

pub mod vase;
