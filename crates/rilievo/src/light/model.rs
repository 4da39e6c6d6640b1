//! Lighting models: normal → light.

use glam::Vec3;

use crate::color::LinearRgb;
use crate::light::Material;
use crate::normal::{Normal, Object, Space, World};
use crate::pose::Pose;

/// A light so far away that its direction is the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalLight<S> {
    /// From the surface to the light.
    pub direction: Normal<S>,
    /// Linear colour times intensity: what a white matte surface facing the light shows.
    pub color: LinearRgb,
}

impl DirectionalLight<World> {
    /// A light from the given side: azimuth 0 is the front (+Z) and π/2 the right (+X), elevation goes up from the horizon.
    pub fn from_angles(azimuth_rad: f32, elevation_rad: f32, color: LinearRgb) -> Self {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (azimuth_rad.sin_cos(), elevation_rad.sin_cos());
        let toward = Vec3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        Self { direction: Normal::new_or(toward, Normal::Z), color }
    }
}

/// All light that falls on an object, in space `S`.
#[derive(Debug, Clone, PartialEq)]
pub struct Lighting<S> {
    /// Light from everywhere.
    pub ambient: LinearRgb,
    /// Any number of directional lights.
    pub lights: Vec<DirectionalLight<S>>,
}

impl Lighting<World> {
    /// The same light as the object sees it in its own space.
    pub fn to_object(&self, pose: &Pose) -> Lighting<Object> {
        let lights = self.lights.iter();
        let lights = lights.map(|l| DirectionalLight { direction: pose.to_object(l.direction), color: l.color });
        Lighting { ambient: self.ambient, lights: lights.collect() }
    }
}

impl Lighting<World> {
    /// The same light on a flat map that lies in the picture plane, whose own axes are the world's.
    pub fn facing<S: Space>(&self) -> Lighting<S> {
        let lights = self.lights.iter();
        let lights = lights.map(|l| DirectionalLight { direction: l.direction.relabel(), color: l.color });
        Lighting { ambient: self.ambient, lights: lights.collect() }
    }
}

/// How a surface answers light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum LightingModel {
    /// Ambient and Lambert's cosine law.
    Lambert,
    /// Ambient, Lambert, and Blinn's half-vector highlight.
    #[default]
    BlinnPhong,
}

/// What a lighting model says of one normal: light for the base colour to tint, and light that goes on top.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Shade {
    /// Ambient and diffuse light, already times the material's reflectance.
    pub diffuse: LinearRgb,
    /// Specular light; not tinted by the base colour.
    pub specular: LinearRgb,
}

impl Shade {
    /// The light that leaves a surface of the given base colour.
    pub fn over(self, base: LinearRgb) -> LinearRgb {
        self.diffuse * base + self.specular
    }

    /// `self` and `weight` times `other`, for filtering.
    pub fn add_weighted(self, other: Self, weight: f32) -> Self {
        Self { diffuse: self.diffuse + other.diffuse * weight, specular: self.specular + other.specular * weight }
    }
}

/// Evaluates `model` for a surface of normal `n`, seen from direction `view` (surface → eye).
///
/// Light from behind the surface (n·l ≤ 0) gives neither diffuse light nor a highlight. The highlight is
/// `(n·h)^shininess`, not energy-normalised, as in the source.
///
/// - **Source:** Tarini et al. 2000, § 5.1, items 1 and 2; Blinn 1977 for the half-vector.
pub fn shade<S: Space>(
    model: LightingModel,
    material: &Material,
    lighting: &Lighting<S>,
    n: Normal<S>,
    view: Normal<S>,
) -> Shade {
    let n = n.vec();
    let mut incident = lighting.ambient;
    let mut specular = LinearRgb::BLACK;
    for light in &lighting.lights {
        let l = light.direction.vec();
        let cosine = n.dot(l);
        if cosine <= 0.0 {
            continue;
        }
        incident += light.color * cosine;
        if model == LightingModel::BlinnPhong {
            // A light straight behind the eye's opposite gives h = 0 and no highlight.
            let h = (l + view.vec()).normalize_or_zero();
            specular += light.color * n.dot(h).max(0.0).powf(material.shininess);
        }
    }
    Shade { diffuse: incident * material.diffuse, specular: specular * material.specular }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_left() -> Lighting<Object> {
        let direction = Normal::new(Vec3::new(-1.0, 0.0, 1.0)).unwrap();
        Lighting {
            ambient: LinearRgb::gray(0.1),
            lights: vec![DirectionalLight { direction, color: LinearRgb::WHITE }],
        }
    }

    #[test]
    fn light_from_the_left_lights_left_slopes() {
        let lit = |x: f32| {
            let n = Normal::new(Vec3::new(x, 0.0, 1.0)).unwrap();
            shade(LightingModel::Lambert, &Material::MATTE_WHITE, &from_left(), n, Normal::Z).diffuse.r
        };
        assert!(lit(-0.5) > lit(0.0) && lit(0.0) > lit(0.5));
    }

    #[test]
    fn facing_the_light_gives_its_color_and_behind_gives_ambient() {
        let lighting = from_left();
        let toward = lighting.lights[0].direction;
        let away = Normal::new(-toward.vec()).unwrap();
        let material = Material { specular: LinearRgb::WHITE, ..Material::MATTE_WHITE };
        let front = shade(LightingModel::BlinnPhong, &material, &lighting, toward, toward);
        assert!((front.diffuse.g - 0.8 * 1.1).abs() < 1e-6 && (front.specular.g - 1.0).abs() < 1e-5);
        let back = shade(LightingModel::BlinnPhong, &material, &lighting, away, toward);
        assert_eq!((back.diffuse, back.specular), (LinearRgb::gray(0.1) * LinearRgb::gray(0.8), LinearRgb::BLACK));
    }

    #[test]
    fn lights_add_up() {
        let mut two = from_left();
        two.lights.push(DirectionalLight { direction: Normal::Y, color: LinearRgb::new(0.0, 0.5, 0.0) });
        let n = Normal::new(Vec3::new(-0.2, 0.6, 0.7)).unwrap();
        let eval = |l: &Lighting<Object>| shade(LightingModel::BlinnPhong, &Material::default(), l, n, Normal::Z);
        let only_second = Lighting { ambient: LinearRgb::BLACK, lights: vec![two.lights[1]] };
        let (sum, a, b) = (eval(&two), eval(&from_left()), eval(&only_second));
        assert!((sum.diffuse.g - a.diffuse.g - b.diffuse.g).abs() < 1e-6);
        assert!((sum.specular.g - a.specular.g - b.specular.g).abs() < 1e-6);
    }

    #[test]
    fn light_turns_with_the_object() {
        let world = Lighting {
            ambient: LinearRgb::BLACK,
            lights: vec![DirectionalLight { direction: Normal::<World>::X, color: LinearRgb::WHITE }],
        };
        let pose = Pose::turned(std::f32::consts::FRAC_PI_2);
        // The object's +Z points to world +X, so it sees the light along its own +Z.
        assert!(world.to_object(&pose).lights[0].direction.angle_to(Normal::Z) < 1e-6);
    }
}
