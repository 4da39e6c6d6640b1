//! What shines: directional and point lights, light from everywhere, an environment.

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::color::LinearRgb;
use crate::light::Environment;
use crate::normal::{Normal, Object, Space, World};
use crate::pose::Pose;

/// How much brighter than at its reference distance a point light may get: a surface at the light itself stays finite.
pub(super) const BRIGHTEST: f32 = 1e6;

/// A light in space `S`. Colours are linear colour times intensity: what a white matte surface facing the light shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light<S> {
    /// A light so far away that its direction is the same everywhere.
    Directional {
        /// From the surface to the light.
        toward: Normal<S>,
        /// Its colour, everywhere.
        color: LinearRgb,
    },
    /// A light at a place.
    Point {
        /// Where it is.
        position: Vec3,
        /// Its colour at the reference distance.
        color: LinearRgb,
        /// Where `color` is meant, in units of `S`; it falls off with the square of the distance. `None`: it does not fall
        /// off, as in the sources.
        reference_distance: Option<f32>,
    },
}

impl<S: Space> Light<S> {
    /// A directional light.
    pub const fn directional(toward: Normal<S>, color: LinearRgb) -> Self {
        Self::Directional { toward, color }
    }

    /// A point light that does not fall off.
    pub const fn point(position: Vec3, color: LinearRgb) -> Self {
        Self::Point { position, color, reference_distance: None }
    }

    /// The unit vector from a surface at `p` to the light; `None` at the light itself.
    pub fn toward(&self, p: Vec3) -> Option<Vec3> {
        match *self {
            Self::Directional { toward, .. } => Some(toward.vec()),
            Self::Point { position, .. } => Normal::<S>::new(position - p).map(Normal::vec),
        }
    }

    /// What a white matte surface at `p` that faces the light shows; at most a million times the light's own colour.
    pub fn color_at(&self, p: Vec3) -> LinearRgb {
        match *self {
            Self::Directional { color, .. } | Self::Point { color, reference_distance: None, .. } => color,
            Self::Point { position, color, reference_distance: Some(reference) } => {
                let falloff = reference * reference / (position - p).length_squared();
                // 0 / 0 is NaN: a reference distance of zero lights nothing.
                color * if falloff.is_nan() { 0.0 } else { falloff.min(BRIGHTEST) }
            }
        }
    }

    /// The light as the surface at `p` sees it, taken for directional; `None` at the light itself.
    pub fn from_place(&self, p: Vec3) -> Option<Self> {
        let toward = Normal::new(self.toward(p)?)?;
        Some(match self {
            Self::Directional { .. } => *self,
            Self::Point { .. } => Self::directional(toward, self.color_at(p)),
        })
    }
}

impl Light<World> {
    /// A light from the given side: azimuth 0 is the front (+Z) and π/2 the right (+X), elevation goes up from the horizon.
    pub fn from_angles(azimuth_rad: f32, elevation_rad: f32, color: LinearRgb) -> Self {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (azimuth_rad.sin_cos(), elevation_rad.sin_cos());
        let toward = Vec3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        Self::directional(Normal::new_or(toward, Normal::Z), color)
    }
}

/// All light that falls on an object, in space `S`.
#[derive(Debug, Clone, PartialEq)]
pub struct Lighting<S> {
    /// Light from everywhere.
    pub ambient: LinearRgb,
    /// Any number of lights.
    pub lights: Vec<Light<S>>,
    /// What mirrors show; without it an even sky of the ambient light.
    pub environment: Option<Arc<Environment>>,
    /// Rotation from `S` to the space of the environment, where +Y is up; for `World` it turns the environment.
    pub to_sky: Quat,
}

impl<S: Space> Lighting<S> {
    /// Lights without an environment; the sky is up along +Y.
    pub const fn new(ambient: LinearRgb, lights: Vec<Light<S>>) -> Self {
        Self { ambient, lights, environment: None, to_sky: Quat::IDENTITY }
    }

    /// The same with point lights taken for directional ones as they are seen from `p`: what a shade table is lit by.
    pub fn from_place(&self, p: Vec3) -> Self {
        Self { lights: self.lights.iter().filter_map(|l| l.from_place(p)).collect(), ..self.clone() }
    }

    /// Where the sky is.
    pub fn up(&self) -> Vec3 {
        self.to_sky.inverse() * Vec3::Y
    }

    /// What a mirror with normal `n` shows to an eye in direction `view`; `roughness` 0 is sharp, 1 all blurred.
    pub fn reflected(&self, n: Vec3, view: Vec3, roughness: f32) -> LinearRgb {
        match &self.environment {
            Some(environment) => environment.reflected(self.to_sky * n, self.to_sky * view, roughness),
            None => self.ambient,
        }
    }
}

impl<S: Space> Default for Lighting<S> {
    /// Darkness.
    fn default() -> Self {
        Self::new(LinearRgb::BLACK, Vec::new())
    }
}

impl Lighting<World> {
    /// The same light as the object sees it in its own space.
    pub fn to_object(&self, pose: &Pose) -> Lighting<Object> {
        let lights = self.lights.iter().map(|light| match *light {
            Light::Directional { toward, color } => Light::directional(pose.to_object(toward), color),
            Light::Point { position, color, reference_distance } => Light::Point {
                position: pose.point_to_object(position),
                color,
                // The object's units are `scale` of the world's.
                reference_distance: reference_distance.map(|d| d / pose.scale),
            },
        });
        self.moved(lights.collect(), self.to_sky * pose.rotation)
    }

    /// The same light on a flat map that lies in the picture plane, whose own axes are the world's.
    pub fn facing<S: Space>(&self) -> Lighting<S> {
        let lights = self.lights.iter().map(|light| match *light {
            Light::Directional { toward, color } => Light::directional(toward.relabel(), color),
            Light::Point { position, color, reference_distance } => {
                Light::Point { position, color, reference_distance }
            }
        });
        self.moved(lights.collect(), self.to_sky)
    }

    fn moved<S>(&self, lights: Vec<Light<S>>, to_sky: Quat) -> Lighting<S> {
        Lighting { ambient: self.ambient, lights, environment: self.environment.clone(), to_sky }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_turns_with_the_object() {
        let world = Lighting::new(LinearRgb::BLACK, vec![Light::directional(Normal::X, LinearRgb::WHITE)]);
        let pose = Pose::turned(std::f32::consts::FRAC_PI_2);
        // The object's +Z points to world +X, so it sees the light along its own +Z.
        let seen = world.to_object(&pose).lights[0].toward(Vec3::ZERO).unwrap();
        assert!((seen - Vec3::Z).length() < 1e-6, "{seen}");
    }

    #[test]
    fn point_lights_move_and_scale_with_the_object() {
        let light = Light::Point {
            position: Vec3::new(1.0, 2.0, 3.0),
            color: LinearRgb::new(0.5, 1.0, 2.0),
            reference_distance: Some(0.7),
        };
        let world = Lighting::<World>::new(LinearRgb::BLACK, vec![light]);
        let pose = Pose { scale: 3.0, translation: Vec3::new(-1.0, 0.5, 0.2), ..Pose::turned(0.8) };
        let inside = world.to_object(&pose).lights[0];
        let p = Vec3::new(0.3, -0.4, 0.1);
        let (there, here) = (pose.point_to_world(p), inside.toward(p).unwrap());
        assert!((pose.rotation * here - light.toward(there).unwrap()).length() < 1e-6);
        let (a, b) = (light.color_at(there), inside.color_at(p));
        assert!((a.g - b.g).abs() < 1e-6 * a.g && (a.b - b.b).abs() < 1e-6 * a.b);
        // By hand: the square of the distance in the world.
        let d2 = f64::from((Vec3::new(1.0, 2.0, 3.0) - there).length_squared());
        assert!((f64::from(a.g) - 0.49 / d2).abs() < 1e-6);
    }

    #[test]
    fn a_surface_at_the_light_is_not_lit_and_nothing_is_infinite() {
        let light = |reference_distance| Light::<Object>::Point {
            position: Vec3::ONE,
            color: LinearRgb::WHITE,
            reference_distance,
        };
        assert_eq!(light(None).toward(Vec3::ONE), None);
        assert_eq!(light(None).color_at(Vec3::ONE), LinearRgb::WHITE);
        assert_eq!(light(Some(1.0)).color_at(Vec3::ONE), LinearRgb::gray(BRIGHTEST));
        assert_eq!(light(Some(0.0)).color_at(Vec3::ONE), LinearRgb::BLACK);
        assert!(Lighting::new(LinearRgb::WHITE, vec![light(None)]).from_place(Vec3::ONE).lights.is_empty());
    }
}
