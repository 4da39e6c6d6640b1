//! Surroundings that mirrors show.
//!
//! Panoramas are resampled to the octahedral map when they are made: a look-up is then a few additions and no angle, the
//! same for one normal and for sixteen, and blurred copies for rough mirrors have no poles. Refused: looking up the
//! panorama itself, which costs an arc tangent and an arc cosine for each of the pixels.

mod blur;
mod octahedral;
mod panorama;

use glam::{Vec2, Vec3};

use crate::color::LinearRgb;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::light::scalar::mirrored;

pub(super) use octahedral::to_square;

/// How an environment lies in its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Projection {
    /// The whole sphere: longitude across, the zenith (+Y) on top. The middle is −Z, what an eye in front of the object
    /// sees behind it, and +X lies to the right of it.
    Equirectangular,
    /// A lit sphere as the eye sees it, filling the picture: it is looked up by the normal, and turns with the eye.
    Matcap,
}

/// The radius of the sphere within the square of a matcap: its rim often shows what is behind it.
pub(super) const MATCAP_RADIUS: f32 = 0.99;
/// Below this length the eye's direction has no right-hand side: it looks straight down or up.
pub(super) const LEAST_SIDE: f32 = 1e-6;
/// The longest side of a resampled panorama.
const MAX_SIDE: u32 = 2048;

/// A picture of the surroundings in linear light, ready for mirrors of any roughness.
///
/// A mirror of roughness r shows the surroundings weighted as GGX weights them when it is looked at from straight ahead
/// (Karis 2013, "Real Shading in Unreal Engine 4"); copies are made for roughness ¼, ½, ¾ and 1 and mixed in between. A
/// matcap is as rough as it is painted.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    projection: Projection,
    /// From sharp to blurred, evenly spaced in roughness; a single one for matcaps.
    levels: Vec<Level>,
}

impl Environment {
    /// Prepares a picture; a panorama is resampled to at most 2048 × 2048 texels.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a texel is negative, infinite or not a number.
    pub fn new(projection: Projection, picture: &Grid<LinearRgb>) -> Result<Self> {
        let light = |v: f32| v.is_finite() && v >= 0.0;
        let wrong = |c: &LinearRgb| !(light(c.r) && light(c.g) && light(c.b));
        if let Some(index) = picture.texels().iter().position(wrong) {
            return Err(Error::NotFinite { what: "texel of the environment", index });
        }
        let levels = match projection {
            Projection::Matcap => vec![Level::clamped(picture)?],
            Projection::Equirectangular => {
                let side = picture.width().clamp(64, MAX_SIDE).next_power_of_two().min(MAX_SIDE);
                let sharp = Level::octahedral(side, |d| panorama::at(picture, d))?;
                blur::levels(sharp)?
            }
        };
        Ok(Self { projection, levels })
    }

    /// What a mirror with normal `n` shows to an eye in direction `view`, both in the space of the environment, where +Y is
    /// up; `roughness` 0 is sharp, 1 all blurred.
    ///
    /// A matcap is upright for the eye; if that looks straight down or up, its right is +X.
    pub fn reflected(&self, n: Vec3, view: Vec3, roughness: f32) -> LinearRgb {
        match self.projection {
            Projection::Equirectangular => self.toward(mirrored(n, view), roughness),
            Projection::Matcap => {
                let side = Vec3::new(view.z, 0.0, -view.x);
                let right = if side.length() > LEAST_SIDE { side.normalize() } else { Vec3::X };
                let at = Vec2::new(n.dot(right), n.dot(view.cross(right)));
                self.levels[0].bilinear(at * MATCAP_RADIUS)
            }
        }
    }

    /// How the picture was read.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// What lies in direction `d`.
    fn toward(&self, d: Vec3, roughness: f32) -> LinearRgb {
        let at = to_square(d);
        let (level, share) = self.blend(roughness);
        let near = self.levels[level].bilinear(at);
        if share == 0.0 { near } else { near * (1.0 - share) + self.levels[level + 1].bilinear(at) * share }
    }

    /// The sharper of the two copies that are mixed for a roughness, and the share of the other; 0 if there is no other.
    pub(super) fn blend(&self, roughness: f32) -> (usize, f32) {
        let last = self.levels.len() - 1;
        let position = roughness.clamp(0.0, 1.0) * last as f32;
        let level = (position as usize).min(last);
        (level, if level == last { 0.0 } else { position - level as f32 })
    }

    /// The copies, from sharp to blurred, evenly spaced in roughness: for renderers that look them up elsewhere.
    ///
    /// Each is a square from −1 to 1 both ways, up is up, with a border of one texel on each side: an octahedral map (Meyer et
    /// al. 2010) whose middle is +Z, or the picture of a matcap.
    pub fn copies(&self) -> impl ExactSizeIterator<Item = EnvironmentCopy<'_>> {
        self.levels.iter().map(|l| EnvironmentCopy { width: l.width, height: l.height, texels: &l.texels })
    }

    /// One of the copies.
    pub(super) fn level(&self, level: usize) -> &Level {
        &self.levels[level]
    }
}

/// One of [`Environment::copies`].
#[derive(Debug, Clone)]
pub struct EnvironmentCopy<'a> {
    /// Texels across, without the border.
    pub width: u32,
    /// Texels down, without the border.
    pub height: u32,
    /// Row-major from the top, with the border: (`width` + 2) · (`height` + 2).
    pub texels: &'a [LinearRgb],
}

/// Texels of a square (−1 … 1 both ways, up is up) with a border of one more on each side, so that no look-up asks where it
/// ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Level {
    width: u32,
    height: u32,
    /// Bordered, row-major from the top.
    texels: Vec<LinearRgb>,
}

impl Level {
    /// A picture whose border goes on.
    fn clamped(picture: &Grid<LinearRgb>) -> Result<Self> {
        let (width, height) = picture.size();
        let inside = |i: u32, side: u32| i.saturating_sub(1).min(side - 1);
        let at = |x, y| picture[(inside(x, width), inside(y, height))];
        Ok(Self { width, height, texels: Grid::from_fn(width + 2, height + 2, at)?.into_texels() })
    }

    /// An octahedral map of what lies in each direction. Its border is what is on the other side of the fold.
    fn octahedral(side: u32, mut at: impl FnMut(Vec3) -> LinearRgb) -> Result<Self> {
        let to_unit = |i: u32| (i as f32 - 0.5) / side as f32 * 2.0 - 1.0;
        let texels = Grid::from_fn(side + 2, side + 2, |x, y| {
            at(octahedral::to_direction(Vec2::new(to_unit(x), -to_unit(y))).normalize())
        });
        Ok(Self { width: side, height: side, texels: texels?.into_texels() })
    }

    /// The four texels around a point of the square, mixed.
    fn bilinear(&self, at: Vec2) -> LinearRgb {
        let [x, y] = self.position(at.x, at.y);
        let (column, row) = ((x as usize).min(self.width as usize), (y as usize).min(self.height as usize));
        let (fx, fy) = (x - column as f32, y - row as f32);
        let stride = self.stride() as usize;
        let first = row * stride + column;
        let mix = |a: LinearRgb, b: LinearRgb, f: f32| a + (b + a * -1.0) * f;
        let top = mix(self.texels[first], self.texels[first + 1], fx);
        let below = mix(self.texels[first + stride], self.texels[first + stride + 1], fx);
        mix(top, below, fy)
    }

    /// Column and row with their fractions, within the border.
    fn position(&self, s: f32, t: f32) -> [f32; 2] {
        // A texel's middle is at ½, and the border comes first: −½ + 1. What is no number goes to the corner.
        let x = (s * 0.5 + 0.5) * self.width as f32 + 0.5;
        let y = (0.5 - t * 0.5) * self.height as f32 + 0.5;
        [x.max(0.0).min(self.width as f32 + 0.999), y.max(0.0).min(self.height as f32 + 0.999)]
    }

    /// Width and height without the border.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Texels from one row to the next.
    pub(super) fn stride(&self) -> u32 {
        self.width + 2
    }

    /// The bits of all components, for look-ups of many lanes.
    pub(super) fn words(&self) -> &[u32] {
        bytemuck::cast_slice(&self.texels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A panorama that says its direction: red = x, green = y, blue = z, each from 0 to 1.
    fn compass() -> Grid<LinearRgb> {
        let (w, h) = (256u32, 128u32);
        Grid::from_fn(w, h, |x, y| {
            let longitude = (f64::from(x) + 0.5) / f64::from(w) * std::f64::consts::TAU - std::f64::consts::PI;
            let polar = (f64::from(y) + 0.5) / f64::from(h) * std::f64::consts::PI;
            // The middle is −Z, +X to the right of it.
            let d = [longitude.sin() * polar.sin(), polar.cos(), -longitude.cos() * polar.sin()];
            let [r, g, b] = d.map(|v| (v * 0.5 + 0.5) as f32);
            LinearRgb::new(r, g, b)
        })
        .unwrap()
    }

    fn off(found: LinearRgb, d: Vec3) -> f32 {
        (Vec3::new(found.r, found.g, found.b) * 2.0 - 1.0 - d).length()
    }

    #[test]
    fn mirrors_show_what_lies_in_the_mirrored_direction() {
        let sky = Environment::new(Projection::Equirectangular, &compass()).unwrap();
        // An eye in front of a mirror sees itself: what is at +Z.
        assert!(off(sky.reflected(Vec3::Z, Vec3::Z, 0.0), Vec3::Z) < 0.02);
        // A mirror tilted back shows the zenith, one turned to the right what is on the right.
        let half = |a: Vec3, b: Vec3| (a + b).normalize();
        assert!(off(sky.reflected(half(Vec3::Z, Vec3::Y), Vec3::Z, 0.0), Vec3::Y) < 0.02);
        assert!(off(sky.reflected(half(Vec3::Z, Vec3::X), Vec3::Z, 0.0), Vec3::X) < 0.02);
        for i in 0..2000 {
            let t = i as f32;
            let d = Vec3::new((t * 0.37).sin(), (t * 0.91).cos(), (t * 0.113).sin() - 0.05).normalize();
            assert!(off(sky.toward(d, 0.0), d) < 0.02, "{d}");
        }
    }

    #[test]
    fn rough_mirrors_blur_and_keep_the_light() {
        let white = Grid::filled(64, 32, LinearRgb::gray(0.7)).unwrap();
        let even = Environment::new(Projection::Equirectangular, &white).unwrap();
        let sky = Environment::new(Projection::Equirectangular, &compass()).unwrap();
        let mut last = 1.1;
        for roughness in [0.0, 0.1, 0.25, 0.4, 0.5, 0.75, 1.0] {
            for d in [Vec3::X, -Vec3::Y, Vec3::new(-0.6, 0.0, -0.8), Vec3::new(0.5, -0.5, -0.7).normalize()] {
                let c = even.toward(d, roughness);
                assert!((c.g - 0.7).abs() < 1e-3, "{c:?}");
            }
            // A blurred compass still points the same way, less strongly.
            let c = sky.toward(Vec3::Y, roughness);
            let strength = c.g * 2.0 - 1.0;
            assert!(strength < last + 1e-3 && strength > 0.4, "{roughness}: {strength} after {last}");
            assert!((c.r - 0.5).abs() < 0.02 && (c.b - 0.5).abs() < 0.02, "{c:?}");
            last = strength;
        }
        assert!(last < 0.9, "{last}");
    }

    #[test]
    fn matcaps_are_upright_for_any_eye() {
        let picture = Grid::from_fn(64, 32, |x, y| LinearRgb::new(x as f32 / 63.0, y as f32 / 31.0, 0.0)).unwrap();
        let matcap = Environment::new(Projection::Matcap, &picture).unwrap();
        for view in [Vec3::Z, Vec3::X, Vec3::new(-0.6, 0.0, 0.8), Vec3::new(0.3, 0.7, -0.5).normalize()] {
            let right = Vec3::Y.cross(view).normalize();
            let up = view.cross(right);
            let seen = |side: Vec3| matcap.reflected((view + side).normalize(), view, 0.5);
            let middle = matcap.reflected(view, view, 0.0);
            assert!((middle.r - 0.5).abs() < 0.01 && (middle.g - 0.5).abs() < 0.01, "{middle:?}");
            // 45° to the side is at 1/√2 of the radius; rows run down.
            assert!((seen(right).r - 0.85).abs() < 0.02 && (seen(-right).r - 0.15).abs() < 0.02);
            assert!((seen(up).g - 0.15).abs() < 0.03 && (seen(-up).g - 0.85).abs() < 0.03);
        }
        let down = matcap.reflected(Vec3::Y, Vec3::Y, 0.0);
        assert!((down.r - 0.5).abs() < 0.01, "{down:?}");
    }

    #[test]
    fn what_is_not_light_is_refused() {
        for bad in [f32::NAN, f32::INFINITY, -0.1] {
            let picture = Grid::new(2, 1, vec![LinearRgb::WHITE, LinearRgb::new(0.0, bad, 0.0)]).unwrap();
            for projection in [Projection::Equirectangular, Projection::Matcap] {
                let refused = Environment::new(projection, &picture);
                assert!(matches!(refused, Err(Error::NotFinite { index: 1, .. })));
            }
        }
        // The smallest pictures work.
        let dot = Grid::filled(1, 1, LinearRgb::WHITE).unwrap();
        for projection in [Projection::Equirectangular, Projection::Matcap] {
            let one = Environment::new(projection, &dot).unwrap();
            assert!((one.reflected(Vec3::X, Vec3::Z, 0.6).g - 1.0).abs() < 1e-3);
            one.reflected(Vec3::NAN, Vec3::Z, 0.6);
        }
    }
}
