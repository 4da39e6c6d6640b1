//! Files of the rilievo pipeline, in and out: pictures, maps, indexed PNG, KTX2, meshes.
//!
//! Files are untrusted: formats are told by content and not by name, sizes are checked against [`Limits`] before
//! anything is allocated, and damage is an [`Error`] that names the file, the place in it and what to do.
#![forbid(unsafe_code)]

mod error;
mod limits;
mod mesh;
mod source;

pub use error::{Error, Result};
pub use limits::Limits;
pub use mesh::{MeshFile, decode_mesh};
pub use source::Source;
