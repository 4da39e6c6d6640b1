//! **rilievo's viewer**: a bump-mapped surface to turn and to light, by every method side by side.
//!
//! One code for a native window and the browser. What is looked at is a [`subject::Subject`], made beside the window from a
//! sample or a file; how it is looked at is a [`look::Look`]; [`canvas`] draws the two by GPU or CPU, and the window around
//! it is egui's.
#![forbid(unsafe_code)]

mod app;
pub mod canvas;
pub mod job;
pub mod look;
#[cfg(not(target_arch = "wasm32"))]
mod native;
pub mod subject;
#[cfg(any(target_arch = "wasm32", test))]
mod web;

pub use app::{Font, Start, Viewer};
#[cfg(not(target_arch = "wasm32"))]
pub use native::run;
#[cfg(target_arch = "wasm32")]
pub use web::{Plain, prepare, start, work};
