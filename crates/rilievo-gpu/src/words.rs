//! Shades in eight bytes, as the table has them on the GPU.
//!
//! A shade is six numbers: what the base colour tints and what goes on top. The eye's response to light is near a square
//! root, so roots are what is kept, ten bits each, under a common power of two: a table of 2048 is 16 kB, half of what
//! 16-bit floats take, and no component of a shade up to white is off by more than a fifth of a step of an 8-bit picture.
//!
//! | bits | first word | second word |
//! |---|---|---|
//! | 0-9, 10-19, 20-29 | roots of the diffuse red, green, blue | roots of the specular red, green, blue |
//! | 30-31 | low bits of the exponent | its high bits |

use rilievo::LinearRgb;
use rilievo::light::Shade;

/// The largest root.
const FULL: f32 = 1023.0;
/// The largest exponent: light of 2¹⁵ is where it ends.
const MOST: i32 = 15;

/// Shades that are packed together: loops over so many are what compilers make vector code of.
const BLOCK: usize = 16;
/// Numbers of a shade.
const PARTS: usize = 6;

/// A shade as two words; light below 0 is none, and what is above 32768 ends there.
pub fn pack(shade: Shade) -> [u32; 2] {
    let mut words = [[0; 2]];
    pack_block(&[shade], &mut words);
    let [words] = words;
    words
}

/// Adds the words of many shades to a list.
pub(crate) fn pack_all(shades: &[Shade], words: &mut Vec<[u32; 2]>) {
    let first = words.len();
    words.resize(first + shades.len(), [0; 2]);
    for (shades, words) in shades.chunks(BLOCK).zip(words[first..].chunks_mut(BLOCK)) {
        pack_block(shades, words);
    }
}

/// At most [`BLOCK`] of them.
fn pack_block(shades: &[Shade], words: &mut [[u32; 2]]) {
    let values: &[f32] = bytemuck::cast_slice(shades);
    let mut light = [0.0f32; BLOCK * PARTS];
    for (light, &value) in light.iter_mut().zip(values) {
        // A comparison takes 0 where there is no number.
        *light = if value > 0.0 { value } else { 0.0 };
    }
    let (mut scales, mut exponents) = ([0.0f32; BLOCK * PARTS], [0; BLOCK]);
    for ((light, scales), exponent) in light.chunks_exact(PARTS).zip(scales.chunks_exact_mut(PARTS)).zip(&mut exponents)
    {
        let largest = light.iter().fold(0.0f32, |a, &b| if b > a { b } else { a });
        let least = exponent_of(largest);
        // 2^−exponent, by its bits.
        scales.fill(f32::from_bits(((127 - least) as u32) << 23) * (FULL * FULL));
        *exponent = least as u32;
    }
    let mut roots = [0u32; BLOCK * PARTS];
    for ((root, light), scale) in roots.iter_mut().zip(light).zip(scales) {
        let v = (light * scale).sqrt() + 0.5;
        *root = (if v < FULL { v } else { FULL }) as i32 as u32;
    }
    for ((words, r), exponent) in words.iter_mut().zip(roots.chunks_exact(PARTS)).zip(exponents) {
        let word = |r: &[u32], top: u32| r[0] | r[1] << 10 | r[2] << 20 | top << 30;
        *words = [word(&r[..3], exponent & 3), word(&r[3..], exponent >> 2)];
    }
}

/// The least exponent under which a value is at most one.
fn exponent_of(largest: f32) -> i32 {
    if largest <= 1.0 {
        return 0;
    }
    let bits = largest.to_bits();
    let floor = (bits >> 23) as i32 - 127;
    (floor + i32::from(bits & 0x7f_ffff != 0)).min(MOST)
}

/// What the shader makes of two words.
pub fn unpack([first, second]: [u32; 2]) -> Shade {
    let exponent = (first >> 30) | (second >> 30) << 2;
    let scale = (exponent as f32).exp2() / (FULL * FULL);
    let value = |word: u32, shift: u32| {
        let root = ((word >> shift) & 1023) as f32;
        root * root * scale
    };
    let color = |word| LinearRgb::new(value(word, 0), value(word, 10), value(word, 20));
    Shade { diffuse: color(first), specular: color(second) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::color::srgb_encode;

    fn shade(d: [f32; 3], s: [f32; 3]) -> Shade {
        let color = |[r, g, b]: [f32; 3]| LinearRgb::new(r, g, b);
        Shade { diffuse: color(d), specular: color(s) }
    }

    #[test]
    fn components_up_to_white_are_off_by_a_fifth_of_a_step_at_most() {
        let step = |v: f32| srgb_encode(v) * 255.0;
        for i in 0..=100_000 {
            let v = i as f32 / 100_000.0;
            let back = unpack(pack(shade([v, 1.0, 0.0], [0.5, v, v]))).specular.g;
            assert!((step(back) - step(v)).abs() < 0.2, "{v} {back}");
        }
    }

    #[test]
    fn brighter_than_white_keeps_its_ratio() {
        for (v, off) in [(1.5f32, 2e-3), (7.99, 2e-3), (100.0, 2e-3), (32768.0, 1e-6)] {
            let back = unpack(pack(shade([v, 0.0, 0.0], [v; 3])));
            assert!((back.diffuse.r / v - 1.0).abs() < off, "{v}: {back:?}");
            assert_eq!(back.diffuse.g, 0.0);
        }
        // What is brighter ends, what is no light is none.
        assert_eq!(unpack(pack(shade([1e9; 3], [f32::INFINITY; 3]))).diffuse.r, 32768.0);
        assert_eq!(unpack(pack(shade([-1.0; 3], [f32::NAN; 3]))), Shade::default());
    }

    #[test]
    fn many_are_packed_as_each() {
        let mut random = testkit::Random::new(3);
        for len in 0..70 {
            let mut component = || (random.unit() * random.unit() * 40.0) as f32;
            let shades: Vec<Shade> = std::iter::repeat_with(|| {
                let mut color = || [component(), component(), component()];
                shade(color(), color())
            })
            .take(len)
            .collect();
            let mut words = vec![[7, 7]];
            pack_all(&shades, &mut words);
            let each: Vec<[u32; 2]> = shades.iter().map(|&s| pack(s)).collect();
            assert_eq!(words[1..], each);
            assert_eq!(words[0], [7, 7]);
        }
    }

    #[test]
    fn powers_of_two_are_themselves() {
        for e in 0..=15 {
            let v = f32::exp2(e as f32);
            assert_eq!(unpack(pack(shade([v; 3], [0.0; 3]))).diffuse.b, v);
        }
    }
}
