//! The page: the same viewer on a canvas, and a plain one for browsers without a GPU.

#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(target_arch = "wasm32")]
mod plain;
#[cfg(target_arch = "wasm32")]
pub(crate) mod progress;
mod wire;
#[cfg(target_arch = "wasm32")]
mod words;
#[cfg(target_arch = "wasm32")]
mod worker;

#[cfg(target_arch = "wasm32")]
pub use page::{prepare, start};
#[cfg(target_arch = "wasm32")]
pub(crate) use page::{prepared, remember, tell_lost};
#[cfg(target_arch = "wasm32")]
pub use plain::Plain;
#[cfg(target_arch = "wasm32")]
pub(crate) use words::Words;
#[cfg(target_arch = "wasm32")]
pub use worker::work;
#[cfg(target_arch = "wasm32")]
pub(crate) use worker::{Work, begin};

/// An element of the page.
#[cfg(target_arch = "wasm32")]
fn element(id: &str) -> Option<web_sys::Element> {
    web_sys::window()?.document()?.get_element_by_id(id)
}
