//! The page: the same viewer on a canvas, and a plain one for browsers without a GPU.

#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(target_arch = "wasm32")]
mod plain;
mod wire;
#[cfg(target_arch = "wasm32")]
mod worker;

#[cfg(target_arch = "wasm32")]
pub use page::start;
#[cfg(target_arch = "wasm32")]
pub(crate) use page::tell_lost;
#[cfg(target_arch = "wasm32")]
pub use plain::Plain;
#[cfg(target_arch = "wasm32")]
pub(crate) use worker::begin;
#[cfg(target_arch = "wasm32")]
pub use worker::work;
