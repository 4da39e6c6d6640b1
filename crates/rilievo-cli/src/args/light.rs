//! Lights and materials.

use std::str::FromStr;

use clap::Args;
use rilievo::light::{Light, Lighting, LightingModel, Material};
use rilievo::{LinearRgb, World};

use super::values::finite;
use super::{ColorArg, ModelArg};
use crate::exit;

/// Light that falls on the surface.
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
    /// How the surface answers light.
    #[arg(long, value_enum, default_value_t = ModelArg::BlinnPhong)]
    model: ModelArg,
}

impl LightArgs {
    /// The light, with every lamp carried `turn_rad` further round the vertical axis.
    pub(crate) fn lighting(&self, turn_rad: f32) -> Lighting<World> {
        Lighting::new(self.ambient.0, self.lights.iter().map(|l| l.resolve(turn_rad)).collect())
    }

    /// What the chosen model leaves of a material.
    pub(crate) fn apply(&self, material: Material) -> Material {
        match self.model {
            ModelArg::BlinnPhong => material,
            ModelArg::Lambert => {
                let glossy = |model: &LightingModel| matches!(model, LightingModel::BlinnPhong { .. });
                Material::new(material.layers().iter().copied().filter(|l| !glossy(&l.model)))
            }
        }
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
    /// Materials `0 … count − 1`: those that were given, and the default for the rest.
    pub(crate) fn resolve(&self, count: usize, default: impl Fn(usize) -> Material) -> Vec<Material> {
        for absent in self.material.iter().filter(|m| usize::from(m.number) >= count.max(1)) {
            exit::warn("--material", &format!("there is no material {}: the maps name {count}", absent.number));
        }
        let given = |n: usize| self.material.iter().rev().find(|m| usize::from(m.number) == n);
        (0..count.max(1)).map(|n| given(n).map_or_else(|| default(n), |m| m.material.clone())).collect()
    }
}

#[derive(Debug, Clone, PartialEq)]
struct MaterialArg {
    number: u8,
    material: Material,
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
        let diffuse = diffuse.parse::<ColorArg>()?.0;
        let specular = parts.get(2).map_or(Ok(ColorArg(LinearRgb::gray(0.15))), |s| s.parse())?.0;
        let shininess = parts.get(3).map_or(Some(40.0), |s| finite(s).filter(|s| *s >= 0.0)).ok_or_else(form)?;
        let material = Material::blinn_phong(diffuse, specular, shininess);
        Ok(Self { number: number.trim().parse().map_err(|_| form())?, material })
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
    fn the_last_material_of_a_number_counts() {
        let args = MaterialArgs { material: ["1,000000", "1,ffffff,ffffff*0.5,7"].map(|t| t.parse().unwrap()).into() };
        let all = args.resolve(3, |_| Material::MATTE_WHITE);
        assert_eq!((&all[0], &all[2]), (&Material::MATTE_WHITE, &Material::MATTE_WHITE));
        assert_eq!(all[1], Material::blinn_phong(LinearRgb::WHITE, LinearRgb::gray(0.5), 7.0));
        for bad in ["", "1", "256,ffffff", "0,ffffff,ffffff,-1", "0,ffffff,ffffff,1,2"] {
            assert!(bad.parse::<MaterialArg>().is_err(), "{bad}");
        }
    }
}
