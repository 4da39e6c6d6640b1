//! The reference renderer: plain scalar code, clear before fast; every faster path is held against it.

mod draw;
mod exact;
mod table;

pub use draw::draw;
pub(super) use draw::color;
pub(super) use exact::Exact;
pub(super) use table::Table;
