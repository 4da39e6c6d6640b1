//! Files of the rilievo pipeline, in and out: pictures, maps, indexed PNG, KTX2, meshes.
//!
//! Files are untrusted: formats are told by content and not by name, sizes are checked against [`Limits`] before
//! anything is allocated, and damage is an [`Error`] that names the file, the place in it and what to do.
#![forbid(unsafe_code)]

mod chunks;
mod error;
pub mod image;
pub mod indexed;
mod limits;
pub mod mesh;
mod probe;
mod source;
mod write;

pub use error::{Action, Error, Result};
pub use image::{
    Depth, EmbeddedMaterials, EnvironmentImage, HeightImage, NormalImage, NormalRows, ReliefImage, decode_environment,
    decode_height, decode_materials, decode_normals, decode_normals_with_materials, decode_picture, decode_relief,
    encode_apng, encode_gray_png8, encode_gray_png16, encode_normals_exr, encode_normals_png8, encode_normals_png16,
    encode_picture_png, looks_like_normals, read_environment, repair_normals, sample_depth,
};
pub use indexed::{
    AnyIndexed, AnyTable, ImportAs, IndexedFile, PalettePng, PaletteTable, SpaceKind, decode_indexed,
    encode_indexed_png, encode_ktx2, relight_in_place,
};
pub use limits::Limits;
pub use mesh::{MeshFile, decode_mesh};
pub use probe::{is_indexed, is_palette_png};
pub use source::Source;
pub use write::write_atomic;
