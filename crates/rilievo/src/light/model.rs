//! Lighting models and their parameters.

use crate::color::LinearRgb;
use crate::error::{Error, Result};

/// How a surface answers light: one term of a [`crate::light::Material`], evaluated by [`crate::light::shade`].
///
/// Each is a function of the normal `n` for given light and view directions, so that a table can hold it. Below, `l` is the
/// direction to the light, `v` to the eye, `h` halfway between them; `r` is `v` mirrored at `n`. What says "tinted" goes
/// to [`crate::light::Shade::diffuse`], the rest to [`crate::light::Shade::specular`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LightingModel {
    /// Light from everywhere, times `color`; tinted.
    Ambient {
        /// Reflectance.
        color: LinearRgb,
    },
    /// Lambert's cosine law: `n·l`, times `color`; tinted.
    Lambert {
        /// Reflectance.
        color: LinearRgb,
    },
    /// Lambert's cosine, rounded to the nearest of `0, 1/steps, … 1`; tinted.
    Steps {
        /// Reflectance.
        color: LinearRgb,
        /// Steps between dark and fully lit; none count as one.
        steps: u16,
    },
    /// Flat colours, chosen by how much light falls on the surface; tinted (Tarini et al. 2000, § 5.1, item 4).
    Cartoon {
        /// The colours, and from how much light on they are used.
        bands: Bands,
    },
    /// Phong's highlight: `(r·l)^shininess`, times `color`; not energy-normalised, as in the source.
    Phong {
        /// Reflectance.
        color: LinearRgb,
        /// Exponent, ≥ 0; larger is shinier.
        shininess: f32,
    },
    /// Blinn's half-vector highlight: `(n·h)^shininess`, times `color`; not energy-normalised.
    BlinnPhong {
        /// Reflectance.
        color: LinearRgb,
        /// Exponent, ≥ 0; four times that of Phong's looks alike.
        shininess: f32,
    },
    /// Phong's highlight with the angle between the mirrored light and the eye doubled: `cos(2θ)^shininess`, times `color`.
    ///
    /// Not of this world: the highlight is half as wide, and there is a second one where the doubled angle comes full circle,
    /// on rims lit from beside the eye (Tarini et al. 2000, fig. 6).
    DoubledAngle {
        /// Reflectance.
        color: LinearRgb,
        /// Exponent, ≥ 0.
        shininess: f32,
    },
    /// A mirror in an open landscape (Tarini et al. 2000, fig. 7).
    Chrome {
        /// What it mirrors.
        landscape: Landscape,
    },
    /// A mirror in [`crate::light::Lighting::environment`], times `color` (Tarini et al. 2000, § 5.1, item 3).
    Environment {
        /// Reflectance.
        color: LinearRgb,
        /// From 0, a clear mirror, to 1: how blurred the reflection is.
        roughness: f32,
    },
    /// The metallic-roughness BRDF of glTF 2.0 (appendix B): GGX with height-correlated Smith shadowing, Schlick's Fresnel
    /// and Lambert's diffuse light.
    ///
    /// `α = roughness²`, at least 0.002; `F₀` is 0.04, and `base_color` for metal. Lights are scaled so that a white
    /// dielectric without gloss shows what [`LightingModel::Lambert`] does.
    ///
    /// What falls on it from everywhere: the diffuse part mirrors the ambient light, the specular part the environment (or the ambient
    /// light if there is none) by the directional albedo of GGX, which is approximated (Karis 2014, "Physically Based Shading on
    /// Mobile").
    ///
    /// What metal mirrors is tinted by the base colour, as far as it is linear in it: exact for metallic 0 and 1.
    MetallicRoughness {
        /// Reflectance: diffuse of dielectrics, specular at right angles of metals.
        base_color: LinearRgb,
        /// From 0, a dielectric, to 1, a metal.
        metallic: f32,
        /// From 0, a mirror, to 1, chalk.
        roughness: f32,
    },
}

/// The most colours [`Bands`] have.
pub const MAX_BANDS: usize = 8;

/// A few flat colours, from dark to bright.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands {
    /// Thresholds and colours; those past `len` are not used.
    bands: [(f32, LinearRgb); MAX_BANDS],
    len: usize,
}

impl Bands {
    /// Colours with the light from which on each is used, in rising order; the first is used below all thresholds too.
    ///
    /// The light is that of all lights, each weighted by its cosine and its luminance: for one white light it is the
    /// cosine.
    ///
    /// # Errors
    /// [`Error::Parameter`] for none or more than [`MAX_BANDS`] colours, or thresholds that do not rise.
    pub fn new(bands: &[(f32, LinearRgb)]) -> Result<Self> {
        let rising = bands.windows(2).all(|pair| pair[0].0 < pair[1].0) && bands.iter().all(|b| b.0.is_finite());
        if bands.is_empty() || bands.len() > MAX_BANDS || !rising {
            let given: Vec<f32> = bands.iter().map(|b| b.0).collect();
            let expected = format!("1 to {MAX_BANDS} thresholds in rising order");
            return Err(Error::parameter("bands", format_args!("{given:?}"), expected));
        }
        let mut all = [(0.0, LinearRgb::BLACK); MAX_BANDS];
        all[..bands.len()].copy_from_slice(bands);
        Ok(Self { bands: all, len: bands.len() })
    }

    /// Three tones of a colour: shadow, half light, light.
    pub fn of(color: LinearRgb) -> Self {
        let mut bands = [(0.0, LinearRgb::BLACK); MAX_BANDS];
        bands[..3].copy_from_slice(&[(0.0, color * 0.25), (0.2, color * 0.6), (0.65, color)]);
        Self { bands, len: 3 }
    }

    /// Thresholds and colours in rising order.
    pub fn bands(&self) -> &[(f32, LinearRgb)] {
        &self.bands[..self.len]
    }

    /// The colour for so much light.
    pub(super) fn at(&self, light: f32) -> LinearRgb {
        self.bands().iter().skip(1).fold(self.bands[0].1, |color, band| if light >= band.0 { band.1 } else { color })
    }
}

/// What chrome mirrors: a sky and a ground, each shaded from the horizon up or down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landscape {
    /// Straight up.
    pub zenith: LinearRgb,
    /// The sky at the horizon.
    pub sky: LinearRgb,
    /// The ground at the horizon.
    pub ground: LinearRgb,
    /// Straight down.
    pub nadir: LinearRgb,
}

impl Landscape {
    /// Half the sine of the angle over which sky and ground meet, so that the horizon has no steps.
    pub(super) const HAZE: f32 = 0.02;

    /// Brown earth under a blue sky that is pale at the horizon: the landscape of the source.
    pub const BROWN_AND_BLUE: Self = Self {
        zenith: LinearRgb::new(0.05, 0.16, 0.55),
        sky: LinearRgb::new(0.75, 0.88, 1.0),
        ground: LinearRgb::new(0.16, 0.085, 0.04),
        nadir: LinearRgb::new(0.45, 0.28, 0.15),
    };

    /// The same in other light: all colours times `color`.
    pub fn times(&self, color: LinearRgb) -> Self {
        let [zenith, sky, ground, nadir] = [self.zenith, self.sky, self.ground, self.nadir].map(|c| c * color);
        Self { zenith, sky, ground, nadir }
    }

    /// The colour towards a direction, by the sine of its elevation.
    pub(super) fn at(&self, elevation: f32) -> LinearRgb {
        let (up, down) = (elevation.clamp(0.0, 1.0), (-elevation).clamp(0.0, 1.0));
        let sky = self.sky * (1.0 - up) + self.zenith * up;
        let ground = self.ground * (1.0 - down) + self.nadir * down;
        let share = (elevation / (2.0 * Self::HAZE) + 0.5).clamp(0.0, 1.0);
        ground * (1.0 - share) + sky * share
    }
}

impl Default for Landscape {
    fn default() -> Self {
        Self::BROWN_AND_BLUE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_start_at_their_thresholds() {
        let (a, b, c) = (LinearRgb::gray(0.1), LinearRgb::gray(0.2), LinearRgb::gray(0.3));
        let bands = Bands::new(&[(0.0, a), (0.25, b), (0.5, c)]).unwrap();
        let seen = [-1.0, 0.0, 0.2499, 0.25, 0.49, 0.5, 7.0].map(|light| bands.at(light));
        assert_eq!(seen, [a, a, a, b, b, c, c]);
        assert_eq!(bands.bands().len(), 3);
        for bad in [&[][..], &[(0.5, a), (0.5, b)], &[(0.5, a), (0.1, b)], &[(f32::NAN, a)], &[(0.0, a); 9]] {
            assert!(Bands::new(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn landscapes_are_brown_below_and_blue_above() {
        let land = Landscape::BROWN_AND_BLUE;
        assert_eq!((land.at(1.0), land.at(-1.0)), (land.zenith, land.nadir));
        for i in 1..100 {
            let (up, down) = (land.at(i as f32 / 100.0 + 0.02), land.at(-i as f32 / 100.0 - 0.02));
            assert!(up.b > up.r && down.r > down.b, "{up:?} {down:?}");
        }
    }
}
