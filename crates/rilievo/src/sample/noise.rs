//! Hash noise. Class A: integers and IEEE + − × only.
//!
//! Clay is a solid, so its grain is noise in space, cut by the surface: it needs no seam and has the same size on the
//! narrow neck as on the wide body. Only brush marks live on the surface, and repeat around.

/// A well mixed 32-bit hash of a lattice point (the finaliser of MurmurHash3 on a linear combination).
fn hash(x: i32, y: i32, z: i32) -> u32 {
    let lin = |v: i32, k: u32| (v as u32).wrapping_mul(k);
    let mut h = lin(x, 0x9e37_79b1) ^ lin(y, 0x85eb_ca77) ^ lin(z, 0xc2b2_ae3d);
    h ^= h >> 16;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    h = h.wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

/// A lattice value in [−1, 1).
fn lattice(x: i32, y: i32, z: i32) -> f32 {
    (hash(x, y, z) >> 8) as f32 * (1.0 / 8_388_608.0) - 1.0
}

/// 0 below `a`, 1 above `b`, the cubic between; falls if b < a.
pub(crate) fn smoothstep(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// `a` at 0, `b` at 1.
pub(crate) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

fn cell(x: f32) -> (i32, f32) {
    // By truncation: `floor` is a call into the C library where the target has no instruction for it.
    let cut = x as i32;
    let floor = cut - i32::from((cut as f32) > x);
    let t = x - floor as f32;
    (floor, t * t * t * (t * (t * 6.0 - 15.0) + 10.0))
}

/// Value noise on a surface in [−1, 1): one lattice value per unit, `period` units around in x.
pub(crate) fn surface_noise(x: f32, y: f32, period: u32, seed: i32) -> f32 {
    lattice_noise(x, y, |ix, iy| lattice(ix.rem_euclid(period as i32), iy, seed))
}

/// Value noise in [−1, 1) that repeats after `period` units in x and in y; whole places have a lattice's value.
pub(crate) fn tile_noise(x: f32, y: f32, period: [u32; 2], seed: i32) -> f32 {
    let [across, down] = period.map(|p| p as i32);
    lattice_noise(x, y, |ix, iy| lattice(ix.rem_euclid(across), iy.rem_euclid(down), seed))
}

/// Three octaves of [`tile_noise`], of so many cells at first; about [−1, 1].
pub(crate) fn tile_octaves(u: f32, v: f32, cells: [u32; 2], seed: i32) -> f32 {
    (0..3).fold(0.0, |sum, octave| {
        let [across, down] = cells.map(|n| n << octave);
        let noise = tile_noise(u * across as f32, v * down as f32, [across, down], seed * 16 + octave);
        sum + noise * 0.57 / (1 << octave) as f32
    })
}

fn lattice_noise(x: f32, y: f32, value: impl Fn(i32, i32) -> f32) -> f32 {
    let ((ix, tx), (iy, ty)) = (cell(x), cell(y));
    let at = |dx: i32, dy: i32| value(ix + dx, iy + dy);
    mix(mix(at(0, 0), at(1, 0), tx), mix(at(0, 1), at(1, 1), tx), ty)
}

/// Octaves of [`surface_noise`], each of half the size and half the height; about [−1, 1].
///
/// `u` is 0 … 1 around, `y` down in the same length, and features are `stretch` times longer around than down.
pub(crate) fn brush(u: f32, y: f32, period: u32, stretch: f32, octaves: u32, seed: i32) -> f32 {
    let (mut sum, mut gain, mut period) = (0.0, 0.5, period);
    for octave in 0..octaves {
        let frequency = period as f32;
        sum += gain * surface_noise(u * frequency, y * frequency * stretch, period, seed + octave as i32);
        gain *= 0.5;
        period *= 2;
    }
    sum
}

/// Value noise in space in [−1, 1).
fn solid_noise(p: [f32; 3]) -> f32 {
    let [(ix, tx), (iy, ty), (iz, tz)] = p.map(cell);
    let at = |dx: i32, dy: i32, dz: i32| lattice(ix + dx, iy + dy, iz + dz);
    let plane = |dz: i32| mix(mix(at(0, 0, dz), at(1, 0, dz), tx), mix(at(0, 1, dz), at(1, 1, dz), tx), ty);
    mix(plane(0), plane(1), tz)
}

/// Octaves of noise in space with features of `size`, each octave half the size and half the height; about [−1, 1].
///
/// Octaves too fine for texels of size `texel` are faded out: they could only alias.
pub(crate) fn solid(p: [f32; 3], size: f32, octaves: u32, texel: f32, seed: u32) -> f32 {
    let (mut sum, mut gain, mut frequency) = (0.0, 0.5, 1.0 / size);
    for octave in 0..octaves {
        let visible = smoothstep(1.0, 0.5, frequency * texel);
        if visible <= 0.0 {
            break;
        }
        // Far apart in space, octaves and seeds have nothing to do with each other.
        let away = (seed * 8 + octave) as f32 * 64.37;
        sum += gain * visible * solid_noise(p.map(|x| x * frequency + away));
        gain *= 0.5;
        frequency *= 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surface_noise_closes_around() {
        for y in [0.0, 0.37, -12.8] {
            assert_eq!(surface_noise(0.0, y, 7, 3), surface_noise(7.0, y, 7, 3));
            assert_eq!(surface_noise(0.25, y, 7, 3), surface_noise(7.25, y, 7, 3));
        }
    }

    #[test]
    fn noise_is_centred_and_fills_its_range() {
        let n = 20_000;
        let point = |i: i32| [i as f32 * 0.071, i as f32 * 0.037, i as f32 * -0.053];
        let v: Vec<f32> = (0..n).map(|i| solid_noise(point(i))).collect();
        let mean = v.iter().sum::<f32>() / n as f32;
        let (low, high) = v.iter().fold((0.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(mean.abs() < 0.03 && low < -0.8 && high > 0.8 && low >= -1.0 && high <= 1.0, "{mean} {low} {high}");
    }

    #[test]
    fn octaves_below_a_texel_are_left_out() {
        let p = [0.3, 0.8, -0.1];
        assert_eq!(solid(p, 0.01, 3, 0.02, 1), 0.0);
        assert_eq!(solid(p, 0.04, 3, 0.02, 1), solid(p, 0.04, 1, 0.02, 1));
        assert_ne!(solid(p, 0.04, 3, 0.001, 1), solid(p, 0.04, 1, 0.001, 1));
    }

    #[test]
    fn smoothstep_runs_either_way() {
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(|x| smoothstep(0.0, 1.0, x)), [0.0, 0.5, 1.0, 1.0]);
        assert_eq!([0.0, 0.5, 1.0].map(|x| smoothstep(1.0, 0.0, x)), [1.0, 0.5, 0.0]);
    }
}
