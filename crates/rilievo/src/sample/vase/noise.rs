//! Hash noise that repeats in x, so that maps close around the vase. Class A: integers and IEEE + − × only.

/// A well mixed 32-bit hash of a lattice point (the finaliser of MurmurHash3 on a linear combination).
fn hash(x: u32, y: u32, seed: u32) -> u32 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ seed.wrapping_mul(0xc2b2_ae3d);
    h ^= h >> 16;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    h = h.wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

/// A lattice value in [−1, 1).
fn lattice(x: i32, y: i32, period: u32, seed: u32) -> f32 {
    let x = x.rem_euclid(period as i32) as u32;
    (hash(x, y as u32, seed) >> 8) as f32 * (1.0 / 8_388_608.0) - 1.0
}

/// 0 below `a`, 1 above `b`, the cubic between.
pub(super) fn smoothstep(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// `a` at 0, `b` at 1.
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Value noise in [−1, 1): one lattice value per unit, `period` units around in x.
pub(super) fn noise(x: f32, y: f32, period: u32, seed: u32) -> f32 {
    let (fx, fy) = (x.floor(), y.floor());
    let (ix, iy) = (fx as i32, fy as i32);
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (tx, ty) = (fade(x - fx), fade(y - fy));
    let at = |dx: i32, dy: i32| lattice(ix + dx, iy + dy, period, seed);
    mix(mix(at(0, 0), at(1, 0), tx), mix(at(0, 1), at(1, 1), tx), ty)
}

/// Octaves of [`noise`], each of half the size and half the height; about [−1, 1].
///
/// `u` is 0 … 1 around and `y` in the same length; `cells` lattice cells go around in the first octave. Octaves finer
/// than two texels (of size `texel`) are left out: they could only alias.
pub(super) fn fractal(u: f32, y: f32, cells: u32, stretch: f32, octaves: u32, texel: f32, seed: u32) -> f32 {
    let (mut sum, mut gain, mut cells) = (0.0, 0.5, cells);
    for octave in 0..octaves {
        let frequency = cells as f32;
        let visible = smoothstep(2.0, 1.0, frequency * texel * stretch.max(1.0) * 2.0);
        if visible <= 0.0 {
            break;
        }
        sum += gain * visible * noise(u * frequency, y * frequency * stretch, cells, seed + octave);
        gain *= 0.5;
        cells *= 2;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_closes_around() {
        for y in [0.0, 0.37, -12.8] {
            assert_eq!(noise(0.0, y, 7, 3), noise(7.0, y, 7, 3));
            assert_eq!(noise(0.25, y, 7, 3), noise(7.25, y, 7, 3));
        }
    }

    #[test]
    fn noise_is_centred_and_fills_its_range() {
        let n = 20_000;
        let v: Vec<f32> = (0..n).map(|i| noise(i as f32 * 0.71, i as f32 * 0.37, 1 << 20, 1)).collect();
        let mean = v.iter().sum::<f32>() / n as f32;
        let (low, high) = v.iter().fold((0.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(mean.abs() < 0.03 && low < -0.85 && high > 0.85 && low >= -1.0 && high <= 1.0, "{mean} {low} {high}");
    }

    #[test]
    fn smoothstep_runs_either_way() {
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(|x| smoothstep(0.0, 1.0, x)), [0.0, 0.5, 1.0, 1.0]);
        assert_eq!([0.0, 0.5, 1.0].map(|x| smoothstep(1.0, 0.0, x)), [1.0, 0.5, 0.0]);
    }
}
