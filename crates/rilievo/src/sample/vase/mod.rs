//! A Greek vase: an Attic neck amphora with engraved ornament, after fig. 10 of Tarini et al. 2000.
//!
//! The figure's recipe: black and clay are two materials, the paint is "thicker", the engravings lie below, and the
//! depressed parts are rougher. Here [`mesh`] is a low-poly surface of revolution with two handles, and [`maps`] draws
//! the ornament on it at any width: everything is a signed distance, so edges stay crisp and bevels keep their size.
//!
//! ```
//! use rilievo::sample::vase;
//! let maps = vase::maps(256)?;
//! let mesh = vase::mesh(vase::DEFAULT_SEGMENTS)?;
//! assert_eq!(maps.color.size(), (256, 192));
//! assert_eq!(mesh.triangles().len(), 1200);
//! # Ok::<(), rilievo::Error>(())
//! ```

mod handle;
mod layout;
mod maps;
mod meander;
mod mesh;
mod ornament;
mod profile;
mod stroke;

pub use maps::{VaseMaps, maps};
pub use mesh::{DEFAULT_SEGMENTS, mesh};

use crate::color::LinearRgb;
use crate::light::Material;

/// The material number of the clay.
pub const CLAY: u8 = 0;
/// The material number of the black glaze.
pub const GLAZE: u8 = 1;

/// [`CLAY`] and [`GLAZE`] for use over [`VaseMaps::color`]: reflectances that leave the map's colours as they are.
pub fn materials_over_color() -> [Material; 2] {
    [glossy(LinearRgb::WHITE, CLAY), glossy(LinearRgb::WHITE, GLAZE)]
}

/// [`CLAY`] and [`GLAZE`] with their own colours, for use without a colour map: a table of (normal, material) pairs
/// is then the whole appearance, as in fig. 10 of Tarini et al. 2000.
pub fn materials_colored() -> [Material; 2] {
    [glossy(LinearRgb::from_srgb(maps::CLAY_SRGB), CLAY), glossy(LinearRgb::from_srgb(maps::GLAZE_SRGB), GLAZE)]
}

fn glossy(diffuse: LinearRgb, material: u8) -> Material {
    let (specular, shininess) =
        if material == CLAY { (LinearRgb::gray(0.035), 9.0) } else { (LinearRgb::new(0.50, 0.48, 0.45), 48.0) };
    Material::blinn_phong(diffuse, specular, shininess)
}
