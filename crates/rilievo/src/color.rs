//! Linear light and its one encoding, sRGB.

use std::ops::{Add, AddAssign, Mul};
use std::sync::LazyLock;

use bytemuck::{Pod, Zeroable};

use crate::grid::Grid;

/// Linear light in the sRGB primaries; 1 is the brightest a picture shows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct LinearRgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl LinearRgb {
    /// No light.
    pub const BLACK: Self = Self::new(0.0, 0.0, 0.0);
    /// Full light.
    pub const WHITE: Self = Self::new(1.0, 1.0, 1.0);

    /// From components.
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same amount of each.
    pub const fn gray(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// From an 8-bit sRGB colour.
    pub fn from_srgb(c: [u8; 3]) -> Self {
        // There are few codes, and many pixels.
        static DECODED: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|v| srgb_decode(v as f32 / 255.0)));
        let [r, g, b] = c.map(|v| DECODED[usize::from(v)]);
        Self { r, g, b }
    }

    /// As an opaque 8-bit sRGB pixel; light outside [0, 1] is clipped.
    pub fn to_srgb(self) -> Rgba8 {
        let [r, g, b] = [self.r, self.g, self.b].map(|v| (srgb_encode(v.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8);
        Rgba8 { r, g, b, a: 255 }
    }
}

impl Add for LinearRgb {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl AddAssign for LinearRgb {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mul for LinearRgb {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl Mul<f32> for LinearRgb {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        Self::new(self.r * s, self.g * s, self.b * s)
    }
}

/// One pixel of a picture: sRGB with straight alpha.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct Rgba8 {
    /// Red, sRGB-encoded.
    pub r: u8,
    /// Green, sRGB-encoded.
    pub g: u8,
    /// Blue, sRGB-encoded.
    pub b: u8,
    /// Coverage; 255 is opaque.
    pub a: u8,
}

impl Rgba8 {
    /// From components.
    pub const fn new(r: u8, g: u8, b: u8, a: u8) -> Self {
        Self { r, g, b, a }
    }

    /// The colour without its coverage.
    pub const fn rgb(self) -> [u8; 3] {
        [self.r, self.g, self.b]
    }
}

/// A picture for the eye.
pub type Picture = Grid<Rgba8>;

/// The sRGB transfer function, linear → encoded (IEC 61966-2-1), on [0, 1].
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse transfer function, encoded → linear, on [0, 1].
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_round_trips_all_codes() {
        for v in 0..=255u8 {
            assert_eq!(LinearRgb::from_srgb([v; 3]).to_srgb(), Rgba8::new(v, v, v, 255));
        }
    }

    #[test]
    fn out_of_range_light_is_clipped() {
        assert_eq!(LinearRgb::new(-1.0, 7.0, f32::NAN).to_srgb().rgb(), [0, 255, 0]);
    }
}
