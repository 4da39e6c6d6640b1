//! The real program, run as a user runs it: files in a fresh folder, exit codes, stdout, stderr.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

mod compare;
mod hostile;
mod light;
mod methods;
mod normal;
mod page;
mod polar;
mod quantize;
mod relight;
mod render;
mod reproduce;
mod runner;
mod scene;
mod usage;
#[cfg(all(target_os = "linux", feature = "view"))]
mod view;
