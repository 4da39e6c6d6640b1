//! Lighting models: normal → light.

use glam::Vec3;

use crate::color::LinearRgb;
use crate::light::{Lighting, Material, Shade};
use crate::normal::{Normal, Space};

/// How a surface answers light: one term of a [`Material`].
///
/// Each is a function of the normal for given light and view directions, so that a table can hold it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LightingModel {
    /// Light from everywhere, times `color`. Tinted by the base colour.
    Ambient {
        /// Reflectance.
        color: LinearRgb,
    },
    /// Lambert's cosine law: `n·l`, times `color`. Tinted by the base colour.
    Lambert {
        /// Reflectance.
        color: LinearRgb,
    },
    /// Blinn's half-vector highlight: `(n·h)^shininess`, times `color`; not energy-normalised, as in the source.
    BlinnPhong {
        /// Reflectance.
        color: LinearRgb,
        /// Exponent, ≥ 0; larger is shinier.
        shininess: f32,
    },
}

/// What a surface of `material` with normal `n` at `position` shows to an eye in direction `view` (surface → eye).
///
/// The scalar definition: shade tables and pixels are lit by it or held against it. Light from behind the surface
/// (n·l ≤ 0) gives neither diffuse light nor a highlight. `position` counts for point lights only.
///
/// - **Source:** Tarini et al. 2000, § 5.1; Blinn 1977 for the half-vector.
pub fn shade<S: Space>(
    material: &Material,
    lighting: &Lighting<S>,
    n: Normal<S>,
    view: Normal<S>,
    position: Vec3,
) -> Shade {
    let (n, view) = (n.vec(), view.vec());
    let mut total = Shade::default();
    for layer in material.layers() {
        if let LightingModel::Ambient { color } = layer.model {
            total.diffuse += lighting.ambient * color * layer.weight;
        }
    }
    for light in &lighting.lights {
        let Some(l) = light.toward(position) else { continue };
        let cosine = n.dot(l);
        if cosine <= 0.0 {
            continue;
        }
        let light = light.color_at(position);
        for layer in material.layers() {
            match layer.model {
                LightingModel::Ambient { .. } => {}
                LightingModel::Lambert { color } => total.diffuse += light * color * (cosine * layer.weight),
                LightingModel::BlinnPhong { color, shininess } => {
                    // A light straight behind the eye's opposite gives h = 0 and no highlight.
                    let h = (l + view).normalize_or_zero();
                    let power = n.dot(h).max(0.0).powf(shininess);
                    total.specular += light * color * (power * layer.weight);
                }
            }
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Light;
    use crate::normal::Object;

    fn from_left() -> Lighting<Object> {
        let direction = Normal::new(Vec3::new(-1.0, 0.0, 1.0)).unwrap();
        Lighting::new(LinearRgb::gray(0.1), vec![Light::directional(direction, LinearRgb::WHITE)])
    }

    #[test]
    fn light_from_the_left_lights_left_slopes() {
        let lit = |x: f32| {
            let n = Normal::new(Vec3::new(x, 0.0, 1.0)).unwrap();
            shade(&Material::MATTE_WHITE, &from_left(), n, Normal::Z, Vec3::ZERO).diffuse.r
        };
        assert!(lit(-0.5) > lit(0.0) && lit(0.0) > lit(0.5));
    }

    #[test]
    fn facing_the_light_gives_its_color_and_behind_gives_ambient() {
        let lighting = from_left();
        let toward = Normal::new(lighting.lights[0].toward(Vec3::ZERO).unwrap()).unwrap();
        let away = Normal::new(-toward.vec()).unwrap();
        let material = Material::blinn_phong(LinearRgb::gray(0.8), LinearRgb::WHITE, 20.0);
        let front = shade(&material, &lighting, toward, toward, Vec3::ZERO);
        assert!((front.diffuse.g - 0.8 * 1.1).abs() < 1e-6 && (front.specular.g - 1.0).abs() < 1e-5);
        let back = shade(&material, &lighting, away, toward, Vec3::ZERO);
        assert_eq!((back.diffuse, back.specular), (LinearRgb::gray(0.1) * LinearRgb::gray(0.8), LinearRgb::BLACK));
    }

    #[test]
    fn lights_add_up() {
        let mut two = from_left();
        two.lights.push(Light::directional(Normal::Y, LinearRgb::new(0.0, 0.5, 0.0)));
        let n = Normal::new(Vec3::new(-0.2, 0.6, 0.7)).unwrap();
        let eval = |l: &Lighting<Object>| shade(&Material::default(), l, n, Normal::Z, Vec3::ZERO);
        let only_second = Lighting::new(LinearRgb::BLACK, vec![two.lights[1]]);
        let (sum, a, b) = (eval(&two), eval(&from_left()), eval(&only_second));
        assert!((sum.diffuse.g - a.diffuse.g - b.diffuse.g).abs() < 1e-6);
        assert!((sum.specular.g - a.specular.g - b.specular.g).abs() < 1e-6);
    }
}
