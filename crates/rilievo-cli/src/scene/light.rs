//! What shines on the scene, and what mirrors show.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use glam::{Quat, Vec3};
use rilievo::light::{Environment, Light, Lighting};
use rilievo::{LinearRgb, World};

use crate::args::Given;
use crate::inputs;

/// All light of a scene, before the size of the scene is known.
#[derive(Debug, Clone)]
pub(crate) struct LightSpec {
    pub(crate) ambient: LinearRgb,
    pub(crate) lamps: Vec<Lamp>,
    /// A panorama or a matcap.
    pub(crate) environment: Option<PathBuf>,
    pub(crate) environment_turn_rad: f32,
    /// What of the environment was written, and how it is called there.
    pub(crate) given: Given,
}

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Lamp {
    /// Far away.
    Side(Side),
    /// Near: at so many radii of the scene from its middle, with its colour there.
    About { side: Side, distance: f32 },
    /// At a place in the world.
    At {
        position: Vec3,
        color: LinearRgb,
        /// Where it has its colour, in the world's units; it does not fall off if that is 0. At the middle of the scene
        /// without it.
        reference_distance: Option<f32>,
    },
}

/// Where light comes from, and its colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Side {
    pub(crate) azimuth_rad: f32,
    pub(crate) elevation_rad: f32,
    pub(crate) color: LinearRgb,
}

impl Side {
    /// The light, carried `turn_rad` further round the vertical axis.
    pub(crate) fn resolve(&self, turn_rad: f32) -> Light<World> {
        Light::from_angles(self.azimuth_rad + turn_rad, self.elevation_rad, self.color)
    }
}

impl Lamp {
    /// The light for a scene within a sphere, carried `turn_rad` further round the vertical axis through its middle.
    fn resolve(&self, (middle, radius): (Vec3, f32), turn_rad: f32) -> Light<World> {
        match *self {
            Self::Side(side) => side.resolve(turn_rad),
            Self::About { side, distance } => {
                let toward = side.resolve(turn_rad).toward(middle).unwrap_or(Vec3::Z);
                let distance = distance * radius;
                let position = middle + toward * distance;
                Light::Point { position, color: side.color, reference_distance: Some(distance) }
            }
            Self::At { position, color, reference_distance } => {
                let from_middle = position - middle;
                let reference = reference_distance.unwrap_or_else(|| from_middle.length());
                Light::Point {
                    position: middle + Quat::from_rotation_y(turn_rad) * from_middle,
                    color,
                    reference_distance: (reference > 0.0).then_some(reference),
                }
            }
        }
    }
}

/// What mirrors show, read once for all frames.
#[derive(Debug, Default)]
pub(crate) struct Surroundings(Option<Arc<Environment>>);

impl LightSpec {
    /// Whether any light has a place rather than a direction.
    pub(crate) fn has_near_lamps(&self) -> bool {
        self.lamps.iter().any(|lamp| !matches!(lamp, Lamp::Side(_)))
    }

    /// Reads the environment, and tells of what plays no part: the environment, if nothing mirrors it.
    pub(crate) fn surroundings(&self, mirrors: bool) -> Result<Surroundings> {
        if self.environment.is_none() {
            self.given.unused(&["turn_environment"], "there is no environment to turn");
        } else if !mirrors {
            let why = "no material mirrors it; add the model environment, or metallic-roughness";
            self.given.unused(&["environment", "turn_environment"], why);
            return Ok(Surroundings::default());
        }
        let read = self.environment.as_deref().map(inputs::environment).transpose()?;
        Ok(Surroundings(read.map(Arc::new)))
    }

    /// The light on a scene within a sphere, with every lamp and the surroundings carried `turn_rad` further round the
    /// vertical axis.
    pub(crate) fn lighting(&self, around: &Surroundings, sphere: (Vec3, f32), turn_rad: f32) -> Lighting<World> {
        let lights = self.lamps.iter().map(|lamp| lamp.resolve(sphere, turn_rad)).collect();
        Lighting {
            environment: around.0.clone(),
            // Where the sky is turned to the right, a direction is looked up further to the left.
            to_sky: Quat::from_rotation_y(-self.environment_turn_rad - turn_rad),
            ..Lighting::new(self.ambient, lights)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: (Vec3, f32) = (Vec3::new(1.0, 2.0, 3.0), 2.0);

    #[test]
    fn lamps_about_the_scene_have_their_colour_in_its_middle() {
        let color = LinearRgb::new(1.0, 0.5, 0.0);
        let side = Side { azimuth_rad: (-90f32).to_radians(), elevation_rad: 0.0, color };
        let light = Lamp::About { side, distance: 1.5 }.resolve(SCENE, 0.0);
        let Light::Point { position, reference_distance, .. } = light else { panic!("{light:?}") };
        assert!((position - Vec3::new(-2.0, 2.0, 3.0)).length() < 1e-5 && reference_distance == Some(3.0));
        assert_eq!(light.color_at(SCENE.0), color);
    }

    #[test]
    fn lamps_at_a_place_have_their_colour_in_the_middle_unless_told_otherwise() {
        let at = |reference_distance| Lamp::At {
            position: Vec3::new(1.0, 2.0, 7.0),
            color: LinearRgb::WHITE,
            reference_distance,
        };
        let seen = |lamp: Lamp, turn: f32| lamp.resolve(SCENE, turn).color_at(SCENE.0).g;
        assert!((seen(at(None), 0.0) - 1.0).abs() < 1e-6 && (seen(at(None), 1.0) - 1.0).abs() < 1e-6);
        assert_eq!((seen(at(Some(2.0)), 0.0), seen(at(Some(0.0)), 0.0)), (0.25, 1.0));
        let turned = at(None).resolve(SCENE, std::f32::consts::FRAC_PI_2).toward(SCENE.0).unwrap();
        assert!((turned - Vec3::X).length() < 1e-6, "{turned}");
    }

    #[test]
    fn the_environment_turns_to_the_right() {
        let spec = LightSpec {
            ambient: LinearRgb::BLACK,
            lamps: Vec::new(),
            environment: None,
            environment_turn_rad: 30f32.to_radians(),
            given: Given::default(),
        };
        let turned = spec.lighting(&Surroundings::default(), SCENE, 60f32.to_radians());
        // What was in front of the object (+Z) is now on its right (+X).
        assert!((turned.to_sky * Vec3::X - Vec3::Z).length() < 1e-6);
    }
}
