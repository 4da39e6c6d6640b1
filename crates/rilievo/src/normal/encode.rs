//! Normals as 8- and 16-bit colours.
//!
//! Source: `floor((n + 1) / 2 · max + 0.5)` and its inverse `c / max · 2 − 1`, renormalised. In 8 bits 127 and 128
//! both lie beside zero (0.32° of tilt each): the encoding has no exact zero.

use glam::Vec3;

use super::{Normal, Space};

fn encode(c: f32, max: f64) -> f64 {
    // In f64: near 65 535 a step of f32 is 0.008 of a code, and writers would disagree at the borders of cells.
    // Never below 0 or above max, even for a component a few ulps past one.
    ((f64::from(c) + 1.0) * 0.5 * max + 0.5).floor().clamp(0.0, max)
}

/// A normal as an 8-bit colour.
pub fn encode_u8<S: Space>(n: Normal<S>) -> [u8; 3] {
    n.vec().to_array().map(|c| encode(c, 255.0) as u8)
}

/// A normal as a 16-bit colour.
pub fn encode_u16<S: Space>(n: Normal<S>) -> [u16; 3] {
    n.vec().to_array().map(|c| encode(c, 65_535.0) as u16)
}

/// The normal an 8-bit colour stands for, renormalised. Every colour stands for one: no code decodes to zero length.
pub fn decode_u8<S: Space>(c: [u8; 3]) -> Normal<S> {
    decode(c.map(|v| 2 * i32::from(v) - 255))
}

/// The normal a 16-bit colour stands for, renormalised.
pub fn decode_u16<S: Space>(c: [u16; 3]) -> Normal<S> {
    decode(c.map(|v| 2 * i32::from(v) - 65_535))
}

/// `2c − max` is `max` times the component and exact; the scale vanishes in the normalisation.
fn decode<S: Space>(scaled: [i32; 3]) -> Normal<S> {
    let v = Vec3::from_array(scaled.map(|v| v as f32));
    Normal::new(v).expect("invariant: 2c − max is odd, so never zero")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::Object;

    #[test]
    fn axes_encode_to_the_ends() {
        assert_eq!(encode_u8(Normal::<Object>::Z), [128, 128, 255]);
        assert_eq!(encode_u16(Normal::<Object>::X), [65535, 32768, 32768]);
        let down = Normal::<Object>::new(-Vec3::Z).unwrap();
        assert_eq!(encode_u8(down), [128, 128, 0]);
    }

    #[test]
    fn every_8_bit_colour_decodes_to_a_unit_vector() {
        for r in 0..=255 {
            for g in 0..=255 {
                for b in (0..=255).step_by(5) {
                    let len = decode_u8::<Object>([r, g, b]).vec().length();
                    assert!((len - 1.0).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn sixteen_bits_keep_a_normal_within_its_cell() {
        let mut worst = 0.0f64;
        for i in 0..20_000u32 {
            let t = f64::from(i) * 2.399_963;
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 20_000.0;
            let r = (1.0 - z * z).sqrt();
            let n = Normal::<Object>::new(Vec3::new((r * t.cos()) as f32, (r * t.sin()) as f32, z as f32)).unwrap();
            worst = worst.max(n.angle_to(decode_u16(encode_u16(n))));
        }
        // Half a step in each component: √3 / 65535 rad, plus the rounding of f32.
        assert!(worst.to_degrees() < 0.0017, "{}", worst.to_degrees());
    }
}
