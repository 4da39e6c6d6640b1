//! **rilievo on the GPU**: the scenes of [`rilievo::raster`], drawn by wgpu.
//!
//! An object by table is an integer texture of indices, with its mip levels, and a small texture of shades that the CPU lights
//! anew each frame: eight bytes an entry, 16 kB for 2048. The fragment stage looks up four texels and filters what it finds, as
//! palette hardware did after the look-up. Nothing needs more than WebGL2 has.
//!
//! Beside it are the methods it is compared with: by the pixel, a light map, light maps that the CPU expands for every frame
//! (the way without palettes), interpolated vectors, and two polar units in whole numbers.
//!
//! ```no_run
//! # async fn picture(scene: rilievo::raster::Scene<'_>) -> Result<(), rilievo_gpu::Error> {
//! use rilievo::raster::{Method, TextureFilter};
//! use rilievo_gpu::{Gpu, Renderer, Target};
//!
//! let gpu = Gpu::headless().await?;
//! let renderer = Renderer::new(&gpu);
//! // Once: meshes and maps go to the memory of the GPU.
//! let mut loaded = renderer.load(&scene, Method::Table.into(), TextureFilter::Trilinear)?;
//! let target = Target::new(&gpu, (640, 480))?;
//! // Each frame: tables are lit and uploaded, then everything is drawn.
//! renderer.update(&mut loaded, &scene, target.size())?;
//! renderer.draw(&loaded, &target, None);
//! let picture = target.read().await?;
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod device;
mod error;
mod frame;
mod load;
mod method;
mod pipelines;
mod renderer;
mod target;
mod texture;
mod timer;
mod words;

pub use device::Gpu;
pub use error::{Error, Result};
pub use method::{Method, VECTOR_LIGHTS};
pub use renderer::{Loaded, Renderer, Uploaded};
pub use target::Target;
pub use words::{pack, unpack};
