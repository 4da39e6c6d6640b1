//! Lighting models by name.

use std::fmt::Write as _;
use std::str::FromStr;

use rilievo::LinearRgb;
use rilievo::light::{Bands, Landscape, Layer, LightingModel, Material};

use super::values::finite;

/// What a material is made of, whatever models then answer light with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Finish {
    pub(crate) diffuse: LinearRgb,
    pub(crate) specular: LinearRgb,
    pub(crate) shininess: f32,
}

impl Default for Finish {
    /// Light gray with a soft, weak highlight: the library's own default.
    fn default() -> Self {
        Self { diffuse: LinearRgb::gray(0.8), specular: LinearRgb::gray(0.15), shininess: 40.0 }
    }
}

impl Finish {
    /// The finish of a material with a diffuse part and a Blinn-Phong highlight.
    pub(crate) fn of(material: &Material) -> Self {
        let mut finish = Self { specular: LinearRgb::BLACK, ..Self::default() };
        for layer in material.layers() {
            match layer.model {
                LightingModel::Lambert { color } => finish.diffuse = color,
                LightingModel::BlinnPhong { color, shininess } => {
                    (finish.specular, finish.shininess) = (color, shininess);
                }
                _ => {}
            }
        }
        finish
    }

    /// A material of this finish that answers light by the sum of `models`.
    pub(crate) fn with(self, models: &[ModelArg]) -> Material {
        Material::new(models.iter().flat_map(|m| m.layers(self)))
    }
}

/// `NAME[:VALUE[,VALUE]][*WEIGHT]`: one term of the sum that answers light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ModelArg {
    look: Look,
    weight: f32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Look {
    Ambient,
    Lambert,
    Phong,
    BlinnPhong,
    Highlight,
    DoubledAngle,
    Steps(u16),
    Cartoon,
    Chrome,
    Environment { roughness: f32 },
    MetallicRoughness { metallic: f32, roughness: f32 },
}

/// Names with their values, and what they show; the help is made from this.
const LOOKS: [(&str, &str); 11] = [
    ("blinn-phong", "ambient and diffuse light, and a half-vector highlight"),
    ("lambert", "ambient and diffuse light"),
    ("phong", "ambient and diffuse light, and Phong's highlight"),
    ("doubled-angle", "the same with the highlight's angle doubled: not of this world"),
    ("highlight", "the half-vector highlight alone"),
    ("ambient", "light from everywhere alone"),
    ("steps[:N]", "ambient light, and diffuse light in N steps [4]"),
    ("cartoon", "three flat tones of the diffuse colour"),
    ("chrome", "a mirror under blue sky, over brown earth"),
    ("environment[:ROUGHNESS]", "a mirror in --environment, 0 (sharp) to 1 (blurred) [0]"),
    ("metallic-roughness[:METALLIC[,ROUGHNESS]]", "glTF's material, both from 0 to 1 [0,0.5]"),
];

/// The long help of `--model`.
pub(crate) fn help() -> String {
    let mut help = String::from(
        "How the surface answers light: NAME[:VALUE,...][*WEIGHT]; repeat it for a sum [default: blinn-phong].\n\nColours and \
         exponents are those of --material.\n",
    );
    for (name, what) in LOOKS {
        // Writing to a string cannot fail.
        let _ = write!(help, "\n- {name}: {what}");
    }
    help + "\n\nTwo thirds clay and one third chrome: --model 'lambert*0.67' --model 'chrome*0.33'"
}

impl ModelArg {
    /// What is taken if nothing is said.
    pub(crate) const DEFAULT: Self = Self { look: Look::BlinnPhong, weight: 1.0 };

    fn layers(self, finish: Finish) -> Vec<Layer> {
        let Finish { diffuse: color, specular, shininess } = finish;
        let (ambient, lambert) = (LightingModel::Ambient { color }, LightingModel::Lambert { color });
        let blinn = LightingModel::BlinnPhong { color: specular, shininess };
        let models = match self.look {
            Look::Ambient => vec![ambient],
            Look::Lambert => vec![ambient, lambert],
            Look::Phong => vec![ambient, lambert, LightingModel::Phong { color: specular, shininess }],
            Look::BlinnPhong => vec![ambient, lambert, blinn],
            Look::Highlight => vec![blinn],
            Look::DoubledAngle => vec![ambient, lambert, LightingModel::DoubledAngle { color: specular, shininess }],
            Look::Steps(steps) => vec![ambient, LightingModel::Steps { color, steps }],
            Look::Cartoon => vec![LightingModel::Cartoon { bands: Bands::of(color) }],
            Look::Chrome => vec![LightingModel::Chrome { landscape: Landscape::BROWN_AND_BLUE }],
            Look::Environment { roughness } => {
                vec![LightingModel::Environment { color: LinearRgb::WHITE, roughness }]
            }
            Look::MetallicRoughness { metallic, roughness } => {
                vec![LightingModel::MetallicRoughness { base_color: color, metallic, roughness }]
            }
        };
        models.into_iter().map(|model| Layer { weight: self.weight, model }).collect()
    }

    /// Whether it shows the environment.
    pub(crate) fn mirrors(self) -> bool {
        matches!(self.look, Look::Environment { .. } | Look::MetallicRoughness { .. })
    }
}

impl FromStr for ModelArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (rest, weight) = text.split_once('*').unwrap_or((text, "1"));
        let bad_weight = || format!("'{text}': the weight must be a number of 0 or more, as in chrome*0.3");
        let weight = finite(weight).filter(|w| *w >= 0.0).ok_or_else(bad_weight)?;
        let (name, values) = rest.split_once(':').map_or((rest, None), |(name, values)| (name, Some(values)));
        let values: Vec<&str> = values.map_or_else(Vec::new, |v| v.split(',').collect());
        let share = |i: usize, default: f32| match values.get(i) {
            None => Ok(default),
            Some(v) => finite(v)
                .filter(|v| (0.0..=1.0).contains(v))
                .ok_or_else(|| format!("'{text}': '{v}' is not a number from 0 to 1")),
        };
        let (look, most) = match name {
            "ambient" => (Look::Ambient, 0),
            "lambert" => (Look::Lambert, 0),
            "phong" => (Look::Phong, 0),
            "blinn-phong" => (Look::BlinnPhong, 0),
            "highlight" => (Look::Highlight, 0),
            "doubled-angle" => (Look::DoubledAngle, 0),
            "cartoon" => (Look::Cartoon, 0),
            "chrome" => (Look::Chrome, 0),
            "steps" => {
                let steps = values.first().map_or(Ok(4), |v| v.trim().parse().ok().filter(|&n| n > 0).ok_or(v));
                (Look::Steps(steps.map_err(|v| format!("'{text}': '{v}' is not a number of steps"))?), 1)
            }
            "environment" => (Look::Environment { roughness: share(0, 0.0)? }, 1),
            "metallic-roughness" => {
                (Look::MetallicRoughness { metallic: share(0, 0.0)?, roughness: share(1, 0.5)? }, 2)
            }
            _ => {
                let names: Vec<&str> = LOOKS.iter().map(|(form, _)| *form).collect();
                return Err(format!("'{name}' is not a lighting model; there are {}", names.join(", ")));
            }
        };
        if values.len() > most {
            return Err(format!("'{text}': {name} takes {most} values at most"));
        }
        Ok(Self { look, weight })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> ModelArg {
        text.parse().unwrap()
    }

    #[test]
    fn models_have_values_and_weights() {
        assert_eq!(parsed("chrome*0.25"), ModelArg { look: Look::Chrome, weight: 0.25 });
        assert_eq!(parsed("steps").look, Look::Steps(4));
        assert_eq!(parsed("steps:7*2"), ModelArg { look: Look::Steps(7), weight: 2.0 });
        assert_eq!(parsed("metallic-roughness:1").look, Look::MetallicRoughness { metallic: 1.0, roughness: 0.5 });
        assert_eq!(parsed("environment:0.3").look, Look::Environment { roughness: 0.3 });
        for bad in
            ["", "shiny", "chrome:1", "steps:0", "steps:x", "environment:2", "lambert*-1", "metallic-roughness:1,1,1"]
        {
            assert!(bad.parse::<ModelArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn every_name_of_the_help_is_read() {
        for (form, _) in LOOKS {
            let name = form.split(['[', ':']).next().unwrap();
            assert!(name.parse::<ModelArg>().is_ok(), "{name}");
            assert!(help().contains(form));
        }
    }

    #[test]
    fn the_default_look_is_the_finish_itself() {
        let material = Material::blinn_phong(LinearRgb::new(0.1, 0.2, 0.3), LinearRgb::gray(0.4), 17.0);
        assert_eq!(Finish::of(&material).with(&[parsed("blinn-phong")]), material);
        assert_eq!(Finish::default().with(&[parsed("blinn-phong")]), Material::default());
        let sum = Finish::default().with(&[parsed("lambert*0.5"), parsed("chrome*0.5")]);
        assert_eq!(sum.layers().iter().map(|l| l.weight).collect::<Vec<_>>(), [0.5; 3]);
    }
}
