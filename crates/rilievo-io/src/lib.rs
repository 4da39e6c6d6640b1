//! Files of the rilievo pipeline, in and out: pictures, maps, indexed PNG, KTX2, meshes.
//!
//! Files are untrusted: formats are told by content and not by name, sizes are checked against [`Limits`] before
//! anything is allocated, and damage is an [`Error`] that names the file, the place in it and what to do.
#![forbid(unsafe_code)]

mod error;
mod limits;
mod source;
mod write;

pub use error::{Error, Result};
pub use limits::Limits;
pub use source::Source;
pub use write::write_atomic;
