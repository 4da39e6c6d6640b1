//! **rilievo**: bump mapping from end to end.
//!
//! A height map becomes a [`NormalMap`]; the normal map is quantised to a [`QuantizedMap`], an index map into a small
//! table of normals; each frame only that table is lit ([`light::ShadeTable`]), and the surface is coloured by look-up.
//!
//! The folders follow the pipeline, and the arrows between them go one way:
//! [`grid`] and [`normal`] → [`height`] → [`surface`] → [`quantize`] → [`light`] → [`raster`] → [`measure`].
//!
//! # Conventions
//! Right-handed, +Y up, counter-clockwise front faces; texture v runs down from the top row (glTF). Angles are in
//! radians. Normal maps point +Y up the picture ("gl") once they are inside the library.
//!
//! # Features
//! - `rayon` (default): long stages use all cores. Results are the same bits without it.
// Not `forbid`: one file may read tables by instructions that take addresses, and says why (`simd/gather.rs`).
#![deny(unsafe_code)]

pub mod color;
pub mod error;
pub mod fill;
pub mod grid;
pub mod height;
pub mod indexed;
pub mod light;
pub mod measure;
pub mod mip;
pub mod normal;
mod order;
pub mod par;
pub mod polar;
pub mod pose;
pub mod progress;
pub mod quantize;
mod random;
pub mod raster;
pub mod sample;
mod simd;
pub mod surface;

pub use color::{LinearRgb, Rgba8};
pub use error::{Error, Result};
pub use grid::{Edges, Grid};
pub use indexed::{IndexMap, MaterialMap, MaterialSpan, NormalTable, QuantizedMap};
pub use mip::MipChain;
pub use normal::{Convention, Normal, NormalMap, Object, Space, Tangent, World};
pub use pose::Pose;
pub use progress::Progress;
