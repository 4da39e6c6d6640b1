//! Lights and materials.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use anyhow::Result;
use clap::Args;
use glam::{Quat, Vec3};
use rilievo::light::{Environment, Light, Lighting, Material};
use rilievo::{LinearRgb, World};

use super::model::{Finish, ModelArg};
use super::values::finite;
use super::{BlendArg, ColorArg, Given};
use crate::{exit, inputs};

/// Light that falls on the surface, and how the surface answers.
#[derive(Debug, Clone, Args)]
pub(crate) struct LightArgs {
    /// A directional light, in degrees; may repeat.
    ///
    /// Azimuth 0 shines from the front, 90 from the right, -90 from the left; elevation goes up. The colour is sRGB,
    /// and may be brightened or dimmed: `--light -45,30,ffeecc*1.2`.
    #[arg(long = "light", value_name = "AZ,EL[,COLOR]", allow_hyphen_values = true, default_values = ["-45,40"])]
    pub(crate) lights: Vec<LightArg>,
    /// Light from everywhere.
    #[arg(long, value_name = "COLOR", default_value = "ffffff*0.1")]
    pub(crate) ambient: ColorArg,
    #[arg(long = "model", value_name = "MODEL", help = "How the surface answers light; repeat it for a sum [default: blinn-phong]", long_help = super::model::help())]
    models: Vec<ModelArg>,
    /// What mirrors show: a panorama twice as wide as high, or a square matcap (HDR, EXR, PNG, JPEG).
    ///
    /// HDR and EXR are linear light, pictures are sRGB. The middle of a panorama is behind the object.
    #[arg(long, value_name = "FILE")]
    pub(crate) environment: Option<PathBuf>,
    /// Turn the environment by so many degrees, as --light turns.
    #[arg(long, value_name = "DEGREES", default_value = "0", allow_hyphen_values = true, value_parser = degrees)]
    turn_environment: f32,
    /// How light meets the base colour.
    #[arg(long, value_enum, default_value_t = BlendArg::Add)]
    pub(crate) blend: BlendArg,
}

impl LightArgs {
    /// Reads the environment, and tells of flags that play no part.
    pub(crate) fn surroundings(&self, given: &Given) -> Result<Surroundings> {
        if self.environment.is_none() {
            given.unused(&["turn_environment"], "there is no --environment to turn");
        } else if !self.models.iter().any(|m| m.mirrors()) {
            let why = "no --model mirrors it; add --model environment, or metallic-roughness";
            given.unused(&["environment", "turn_environment"], why);
            return Ok(Surroundings::default());
        }
        let read = self.environment.as_deref().map(inputs::environment).transpose()?;
        Ok(Surroundings(read.map(Arc::new)))
    }

    /// The light, with every lamp and the surroundings carried `turn_rad` further round the vertical axis.
    pub(crate) fn lighting(&self, surroundings: &Surroundings, turn_rad: f32) -> Lighting<World> {
        let lights = self.lights.iter().map(|l| l.resolve(turn_rad)).collect();
        Lighting {
            environment: surroundings.0.clone(),
            // Where the sky is turned to the right, a direction is looked up further to the left.
            to_sky: Quat::from_rotation_y(-self.turn_environment.to_radians() - turn_rad),
            ..Lighting::new(self.ambient.0, lights)
        }
    }
}

/// What mirrors show, read once for all frames.
#[derive(Debug, Default)]
pub(crate) struct Surroundings(Option<Arc<Environment>>);

fn degrees(text: &str) -> Result<f32, String> {
    finite(text).ok_or_else(|| format!("'{text}' is not a number of degrees"))
}

/// Lights near the object.
#[derive(Debug, Clone, Args)]
pub(crate) struct PointLightArgs {
    /// A light near the object; may repeat.
    ///
    /// Azimuth and elevation in degrees, as of --light; DISTANCE from the object's middle in radii of the object (1 is its outside). It has its colour
    /// at the object's middle and falls off with the square of the distance. A table takes it for directional, as seen from the middle; --method exact
    /// does not.
    #[arg(long = "point-light", value_name = "AZ,EL,DISTANCE[,COLOR]", allow_hyphen_values = true)]
    point_lights: Vec<PointLightArg>,
}

impl PointLightArgs {
    /// The lights about a bounding sphere, carried `turn_rad` further round.
    pub(crate) fn resolve(&self, (middle, radius): (Vec3, f32), turn_rad: f32) -> impl Iterator<Item = Light<World>> {
        self.point_lights.iter().map(move |l| {
            let LightArg { azimuth_rad, elevation_rad, color } = l.side;
            let toward = Light::from_angles(azimuth_rad + turn_rad, elevation_rad, color).toward(middle);
            let distance = l.distance * radius;
            let position = middle + toward.unwrap_or(Vec3::Z) * distance;
            Light::Point { position, color, reference_distance: Some(distance) }
        })
    }
}

/// `AZ,EL,DISTANCE[,COLOR]`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PointLightArg {
    side: LightArg,
    distance: f32,
}

impl FromStr for PointLightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("'{text}' is not AZIMUTH,ELEVATION,DISTANCE[,COLOR], as in -45,30,1.5,ffeecc");
        let parts: Vec<&str> = text.splitn(4, ',').collect();
        let [azimuth, elevation, distance, ref rest @ ..] = parts[..] else { return Err(form()) };
        let side = [azimuth, elevation].into_iter().chain(rest.iter().copied()).collect::<Vec<_>>().join(",");
        let distance = finite(distance).filter(|d| (0.01..=1e4).contains(d)).ok_or_else(form)?;
        Ok(Self { side: side.parse().map_err(|_| form())?, distance })
    }
}

/// `AZ,EL[,COLOR]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LightArg {
    azimuth_rad: f32,
    elevation_rad: f32,
    color: LinearRgb,
}

impl LightArg {
    fn resolve(&self, turn_rad: f32) -> Light<World> {
        Light::from_angles(self.azimuth_rad + turn_rad, self.elevation_rad, self.color)
    }
}

impl FromStr for LightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("'{text}' is not AZIMUTH,ELEVATION[,COLOR] in degrees, as in -45,30,ffeecc");
        let mut parts = text.splitn(3, ',');
        let mut angle = || parts.next().and_then(finite).ok_or_else(form);
        let (azimuth, elevation) = (angle()?, angle()?);
        let color = parts.next().map_or(Ok(ColorArg(LinearRgb::WHITE)), str::parse)?;
        Ok(Self { azimuth_rad: azimuth.to_radians(), elevation_rad: elevation.to_radians(), color: color.0 })
    }
}

/// What the surface is made of.
#[derive(Debug, Clone, Args)]
pub(crate) struct MaterialArgs {
    /// The surface's material; repeat it with the numbers of a material map for several.
    ///
    /// DIFFUSE and SPECULAR are colours, SHININESS is the exponent of the highlight:
    /// `--material 0,d08050,ffffff*0.04,12 --material 1,181818,ffffff*0.5,90`
    #[arg(long, value_name = "N,DIFFUSE[,SPECULAR[,SHININESS]]")]
    material: Vec<MaterialArg>,
}

impl MaterialArgs {
    /// Materials `0 … count − 1` under the models of `light`: those that were given, and the default for the rest.
    pub(crate) fn resolve(
        &self,
        count: usize,
        light: &LightArgs,
        default: impl Fn(usize) -> Material,
    ) -> Vec<Material> {
        for absent in self.material.iter().filter(|m| usize::from(m.number) >= count.max(1)) {
            exit::warn("--material", &format!("there is no material {}: the maps name {count}", absent.number));
        }
        let given = |n: usize| self.material.iter().rev().find(|m| usize::from(m.number) == n);
        let material = |n: usize| {
            let finish = given(n).map_or_else(|| Finish::of(&default(n)), |m| m.finish);
            let models = if light.models.is_empty() { &[ModelArg::DEFAULT] } else { light.models.as_slice() };
            finish.with(models)
        };
        (0..count.max(1)).map(material).collect()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct MaterialArg {
    number: u8,
    finish: Finish,
}

impl FromStr for MaterialArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("'{text}' is not N,DIFFUSE[,SPECULAR[,SHININESS]], as in 1,202020,ffffff*0.5,80");
        let parts: Vec<&str> = text.split(',').collect();
        let (number, diffuse) = match parts[..] {
            [number, diffuse, ..] if parts.len() <= 4 => (number, diffuse),
            _ => return Err(form()),
        };
        let mut finish = Finish { diffuse: diffuse.parse::<ColorArg>()?.0, ..Finish::default() };
        if let Some(specular) = parts.get(2) {
            finish.specular = specular.parse::<ColorArg>()?.0;
        }
        if let Some(shininess) = parts.get(3) {
            finish.shininess = finite(shininess).filter(|s| *s >= 0.0).ok_or_else(form)?;
        }
        Ok(Self { number: number.trim().parse().map_err(|_| form())?, finish })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn lights_come_from_where_they_say() {
        let toward = |text: &str| text.parse::<LightArg>().unwrap().resolve(0.0).toward(Vec3::ZERO).unwrap();
        assert!((toward("90,0") - Vec3::X).length() < 1e-6);
        assert!((toward("0,0") - Vec3::Z).length() < 1e-6);
        assert!((toward("-90,0,ff0000") + Vec3::X).length() < 1e-6);
        assert!((toward("13,90") - Vec3::Y).length() < 1e-6);
        for bad in ["", "1", "1,x", "1,2,red"] {
            assert!(bad.parse::<LightArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn point_lights_stand_about_the_object() {
        let args = |text: &str| PointLightArgs { point_lights: vec![text.parse().unwrap()] };
        let sphere = (Vec3::new(1.0, 2.0, 3.0), 2.0);
        let light = args("-90,0,1.5,ff0000").resolve(sphere, 0.0).next().unwrap();
        let Light::Point { position, reference_distance, .. } = light else { panic!("{light:?}") };
        assert!((position - Vec3::new(-2.0, 2.0, 3.0)).length() < 1e-5 && reference_distance == Some(3.0));
        assert_eq!(light.color_at(sphere.0), LinearRgb::new(1.0, 0.0, 0.0));
        for bad in ["", "1,2", "1,2,0", "1,2,3,red", "1,2,x"] {
            assert!(bad.parse::<PointLightArg>().is_err(), "{bad}");
        }
    }

    #[derive(Debug, clap::Parser)]
    struct Line {
        #[command(flatten)]
        light: LightArgs,
        #[command(flatten)]
        material: MaterialArgs,
    }

    fn line(text: &str) -> Line {
        <Line as clap::Parser>::parse_from(std::iter::once("test").chain(text.split_whitespace()))
    }

    #[test]
    fn the_last_material_of_a_number_counts() {
        let line = line("--material 1,000000 --material 1,ffffff,ffffff*0.5,7");
        let all = line.material.resolve(3, &line.light, |_| Material::default());
        assert_eq!((&all[0], &all[2]), (&Material::default(), &Material::default()));
        assert_eq!(all[1], Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(0.5), 7.0));
        for bad in ["", "1", "256,ffffff", "0,ffffff,ffffff,-1", "0,ffffff,ffffff,1,2"] {
            assert!(bad.parse::<MaterialArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn the_environment_turns_to_the_right() {
        let turned = line("--turn-environment 30").light.lighting(&Surroundings::default(), 60f32.to_radians());
        // What was in front of the object (+Z) is now on its right (+X).
        assert!((turned.to_sky * Vec3::X - Vec3::Z).length() < 1e-6);
    }
}
