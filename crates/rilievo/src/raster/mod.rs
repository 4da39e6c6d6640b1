//! The reference renderer: perspective, clipping, depth test, watertight fill, perspective-correct texture look-ups.
//!
//! Plain scalar code, clear before fast: every faster path is held against it. A frame has two steps, as in the
//! source: [`prepare`] lights the tables (per object, a few thousand evaluations), [`draw`] fills pixels.
//!
//! ```
//! use rilievo::{LinearRgb, Normal, light, raster, surface};
//!
//! let mesh = surface::shapes::sphere(32, 16)?;
//! let materials = [light::Material::default()];
//! let object = raster::Object::new(&mesh, raster::Detail::Smooth, &materials);
//! let camera = surface::Camera::orbit(mesh.bounding_sphere(), 0.0, 0.3, 1.1, 0.6, 1.0)?;
//! let scene = raster::Scene {
//!     objects: vec![object],
//!     lighting: light::Lighting::new(
//!         LinearRgb::gray(0.05),
//!         vec![light::Light::directional(Normal::X, LinearRgb::WHITE)],
//!     ),
//!     camera,
//! };
//! let frame = raster::prepare(&scene, raster::Method::Exact, raster::TextureFilter::Trilinear)?;
//! let mut target = raster::Target::new(64, 64)?;
//! raster::draw(&frame, &mut target);
//! assert!(target.covered_pixels() > 1000);
//! # Ok::<(), rilievo::Error>(())
//! ```

mod clip;
mod frame;
mod project;
mod reference;
pub mod scanline;
mod scene;
mod target;
mod texture;
pub mod tile;
pub mod vectors;

pub use frame::{Frame, prepare};
pub use reference::{LitTables, bake_light_map, draw};
pub use scene::{BaseColor, Detail, Method, Object, Scene};
pub use target::{Target, average_samples};
pub use texture::TextureFilter;
