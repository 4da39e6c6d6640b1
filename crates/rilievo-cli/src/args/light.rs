//! Lights and materials.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use rilievo::LinearRgb;

use super::model::{Finish, ModelArg};
use super::values::finite;
use super::{BlendArg, ColorArg, Given};
use crate::scene::{Lamp, LightSpec, MaterialSpec, Side};

/// Light that falls on the surface, and how the surface answers.
#[derive(Debug, Clone, Args)]
pub(crate) struct LightArgs {
    /// A directional light, in degrees; may repeat.
    ///
    /// Azimuth 0 shines from the front, 90 from the right, -90 from the left; elevation goes up. The colour is sRGB,
    /// and may be brightened or dimmed: `--light -45,30,ffeecc*1.2`.
    #[arg(long = "light", value_name = "AZ,EL[,COLOR]", allow_hyphen_values = true, default_values = ["-45,40"])]
    lights: Vec<Side>,
    /// Light from everywhere.
    #[arg(long, value_name = "COLOR", default_value = "ffffff*0.1")]
    ambient: ColorArg,
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
    /// All light, with the near lights among it.
    pub(crate) fn spec(&self, points: Option<&PointLightArgs>, given: &Given) -> LightSpec {
        let near = points.into_iter().flat_map(|p| &p.point_lights);
        let lamps = self.lights.iter().map(|&side| Lamp::Side(side));
        LightSpec {
            ambient: self.ambient.0,
            lamps: lamps.chain(near.map(|&PointLightArg { side, distance }| Lamp::About { side, distance })).collect(),
            environment: self.environment.clone(),
            environment_turn_rad: self.turn_environment.to_radians(),
            given: given.clone(),
        }
    }

    /// How materials answer, unless they say it themselves.
    fn models(&self) -> Vec<ModelArg> {
        if self.models.is_empty() { vec![ModelArg::DEFAULT] } else { self.models.clone() }
    }
}

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

/// `AZ,EL,DISTANCE[,COLOR]`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PointLightArg {
    side: Side,
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
impl FromStr for Side {
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
    /// The materials under the models of `light`.
    pub(crate) fn spec(&self, light: &LightArgs) -> MaterialSpec {
        let models = light.models();
        let given = self.material.iter().map(|m| (m.number, m.finish.with(&models))).collect();
        MaterialSpec { given, models, called: "--material".to_owned() }
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
    use rilievo::light::Material;

    #[test]
    fn lights_come_from_where_they_say() {
        let toward = |text: &str| text.parse::<Side>().unwrap().resolve(0.0).toward(Vec3::ZERO).unwrap();
        assert!((toward("90,0") - Vec3::X).length() < 1e-6);
        assert!((toward("0,0") - Vec3::Z).length() < 1e-6);
        assert!((toward("-90,0,ff0000") + Vec3::X).length() < 1e-6);
        assert!((toward("13,90") - Vec3::Y).length() < 1e-6);
        for bad in ["", "1", "1,x", "1,2,red"] {
            assert!(bad.parse::<Side>().is_err(), "{bad}");
        }
    }

    #[test]
    fn point_lights_have_a_distance() {
        let light = "-90,0,1.5,ff0000".parse::<PointLightArg>().unwrap();
        assert_eq!((light.distance, light.side.color), (1.5, LinearRgb::new(1.0, 0.0, 0.0)));
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
        let all = line.material.spec(&line.light).resolve(3, |_| Material::default());
        assert_eq!((&all[0], &all[2]), (&Material::default(), &Material::default()));
        assert_eq!(all[1], Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(0.5), 7.0));
        for bad in ["", "1", "256,ffffff", "0,ffffff,ffffff,-1", "0,ffffff,ffffff,1,2"] {
            assert!(bad.parse::<MaterialArg>().is_err(), "{bad}");
        }
    }
}
