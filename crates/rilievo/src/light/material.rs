//! What a surface does with light.

use crate::color::LinearRgb;

/// Reflectances of the ambient + Lambert + Blinn-Phong model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Diffuse reflectance; multiplies the base colour where there is one.
    pub diffuse: LinearRgb,
    /// Specular reflectance.
    pub specular: LinearRgb,
    /// Specular exponent of the half-vector model, ≥ 0; larger is shinier.
    pub shininess: f32,
}

impl Material {
    /// White and without gloss: shows the shape and nothing else.
    pub const MATTE_WHITE: Self = Self { diffuse: LinearRgb::gray(0.8), specular: LinearRgb::BLACK, shininess: 1.0 };
}

impl Default for Material {
    /// Light gray with a soft, weak highlight.
    fn default() -> Self {
        Self { diffuse: LinearRgb::gray(0.8), specular: LinearRgb::gray(0.15), shininess: 40.0 }
    }
}
