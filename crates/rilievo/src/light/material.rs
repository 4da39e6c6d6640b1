//! What a surface does with light.

use std::borrow::Cow;

use crate::color::LinearRgb;
use crate::light::LightingModel;

/// One term of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// What the model's light is multiplied by.
    pub weight: f32,
    /// The model, with its parameters.
    pub model: LightingModel,
}

impl Layer {
    /// A model with weight 1.
    pub const fn new(model: LightingModel) -> Self {
        Self { weight: 1.0, model }
    }
}

impl From<LightingModel> for Layer {
    fn from(model: LightingModel) -> Self {
        Self::new(model)
    }
}

/// A weighted sum of lighting models (Tarini et al. 2000, § 5.1, item 7, and § 6).
///
/// ```
/// use rilievo::LinearRgb;
/// use rilievo::light::{Layer, LightingModel, Material};
///
/// let clay = Material::matte(LinearRgb::new(0.7, 0.4, 0.25));
/// let glazed = clay.with(Layer {
///     weight: 0.3,
///     model: LightingModel::Phong { color: LinearRgb::WHITE, shininess: 60.0 },
/// });
/// assert_eq!(glazed.layers().len(), 3);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    layers: Cow<'static, [Layer]>,
}

impl Material {
    /// White and without gloss: shows the shape and nothing else.
    pub const MATTE_WHITE: Self = Self {
        layers: Cow::Borrowed(&[
            Layer::new(LightingModel::Ambient { color: LinearRgb::gray(0.8) }),
            Layer::new(LightingModel::Lambert { color: LinearRgb::gray(0.8) }),
        ]),
    };

    /// The sum of `layers`; black without any.
    pub fn new(layers: impl IntoIterator<Item = impl Into<Layer>>) -> Self {
        Self { layers: layers.into_iter().map(Into::into).collect() }
    }

    /// Ambient light and Lambert's cosine law, of one reflectance.
    pub fn matte(diffuse: LinearRgb) -> Self {
        Self::new([LightingModel::Ambient { color: diffuse }, LightingModel::Lambert { color: diffuse }])
    }

    /// [`Material::matte`] with a Blinn-Phong highlight of reflectance `specular`.
    pub fn blinn_phong(diffuse: LinearRgb, specular: LinearRgb, shininess: f32) -> Self {
        Self::matte(diffuse).with(LightingModel::BlinnPhong { color: specular, shininess })
    }

    /// The same and one term more.
    pub fn with(&self, layer: impl Into<Layer>) -> Self {
        let more = std::iter::once(layer.into());
        Self { layers: self.layers.iter().copied().chain(more).collect() }
    }

    /// `weight` of this and the rest of `other`: a weight of 1 is this material alone.
    pub fn mix(&self, other: &Self, weight: f32) -> Self {
        let scaled = |m: &Self, by: f32| -> Vec<Layer> {
            m.layers.iter().map(|l| Layer { weight: l.weight * by, ..*l }).collect()
        };
        Self::new(scaled(self, weight).into_iter().chain(scaled(other, 1.0 - weight)))
    }

    /// The terms.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }
}

impl Default for Material {
    /// Light gray with a soft, weak highlight.
    fn default() -> Self {
        Self::blinn_phong(LinearRgb::gray(0.8), LinearRgb::gray(0.15), 40.0)
    }
}
