//! Dithering normals to 8 bits, so that what a lens, a mip level or an eye averages is the normal that was meant.
//!
//! Eight bits turn smooth curvature into terraces of almost half a degree, which glancing light shows. Dithering colours
//! would not do: what counts is the direction a colour decodes to after renormalisation, so errors are measured and
//! passed on there.

use glam::Vec3;

use super::blue_noise::BlueNoise;
use super::{Normal, NormalMap, Space, decode_u8, encode_u8};
use crate::grid::Grid;
use crate::par;

/// How normals are rounded to 8 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DitherU8 {
    /// To the nearest code, each component by itself.
    #[default]
    None,
    /// By a blue-noise mask: each texel on its own, so tiles stay tiles and still pictures stay still.
    BlueNoise,
    /// By error diffusion: the closest averages, but a texel depends on all those above it.
    Diffusion,
}

/// A normal map as 8-bit colours.
///
/// - **Shape:** one colour per texel, row-major, same size as `map`; decode with [`super::decode_u8`].
/// - **Accuracy:** over three slowly curving maps, the errors of normals averaged over σ = 1.5 texels fall to 17–29 %
///   (blue noise) and 8–19 % (diffusion) of those without dithering, while single texels err 1.4 and 0.8–1.3 times as
///   much (`smooth_curvature_survives_in_local_averages`).
/// - **Determinism:** class A: the same bits for any thread count and instruction set.
///
/// ```
/// use rilievo::normal::{DitherU8, decode_u8, encode_map_u8};
/// use rilievo::{Grid, Normal, Tangent};
///
/// // No 8-bit colour is straight up; dithering makes it so on average.
/// let flat = Grid::filled(64, 64, Normal::<Tangent>::Z)?;
/// let mean_x = |dither| {
///     let codes = encode_map_u8(&flat, dither);
///     codes.texels().iter().map(|c| decode_u8::<Tangent>(*c).vec().x).sum::<f32>() / 4096.0
/// };
/// assert!(mean_x(DitherU8::None) > 0.003);
/// assert!(mean_x(DitherU8::BlueNoise).abs() < 1e-4);
/// assert!(mean_x(DitherU8::Diffusion).abs() < 1e-4);
/// # Ok::<(), rilievo::Error>(())
/// ```
pub fn encode_map_u8<S: Space>(map: &NormalMap<S>, dither: DitherU8) -> Grid<[u8; 3]> {
    let mut codes = map.map(|_| [0; 3]);
    let width = map.width() as usize;
    match dither {
        DitherU8::None => par::for_each_row(codes.texels_mut(), width, |y, row| {
            for (code, n) in row.iter_mut().zip(map.row(y as u32)) {
                *code = encode_u8(*n);
            }
        }),
        DitherU8::BlueNoise => {
            let mask = BlueNoise::get();
            par::for_each_row(codes.texels_mut(), width, |y, row| {
                for (x, (code, n)) in row.iter_mut().zip(map.row(y as u32)).enumerate() {
                    *code = masked(*n, mask, x, y);
                }
            });
        }
        DitherU8::Diffusion => diffuse(map, &mut codes),
    }
    codes
}

/// A component −1 … 1 as a real number of codes 0 … 255.
fn in_codes(component: f32) -> f32 {
    component * 127.5 + 127.5
}

/// Rounds each component up where its fraction reaches the threshold.
///
/// The mean over the mask is the vector itself. Renormalising each texel changes that mean only in the second order
/// (one code is 0.008 rad, so by some 10⁻⁵ rad), and not at all along the normal, as long as the components are rounded
/// independently: each sees the mask from another corner.
fn masked<S: Space>(n: Normal<S>, mask: &BlueNoise, x: usize, y: usize) -> [u8; 3] {
    const OFFSETS: [(usize, usize); 3] = [(0, 0), (23, 41), (45, 14)];
    let components = n.vec().to_array();
    std::array::from_fn(|c| {
        let (dx, dy) = OFFSETS[c];
        (in_codes(components[c]) + mask.threshold(x + dx, y + dy)).floor().clamp(0.0, 255.0) as u8
    })
}

/// Floyd and Steinberg's error diffusion (1976), rows in alternating directions, with errors that are differences of
/// unit vectors: between the normal wanted and the one that the code decodes to.
fn diffuse<S: Space>(map: &NormalMap<S>, codes: &mut Grid<[u8; 3]>) {
    let width = map.width() as usize;
    // One texel of margin on both sides takes the errors that leave the map.
    let (mut here, mut below) = (vec![Vec3::ZERO; width + 2], vec![Vec3::ZERO; width + 2]);
    for (y, row) in codes.texels_mut().chunks_exact_mut(width).enumerate() {
        let leftwards = y % 2 == 1;
        for step in 0..width {
            let x = if leftwards { width - 1 - step } else { step };
            let n = map.row(y as u32)[x];
            // Back to the sphere first: length is nothing that a code could pay back.
            let wanted = Normal::new_or(n.vec() + here[x + 1], n);
            let (code, decoded) = nearest(wanted);
            row[x] = code;
            let error = wanted.vec() - decoded.vec();
            let (ahead, behind) = if leftwards { (x, x + 2) } else { (x + 2, x) };
            here[ahead] += error * (7.0 / 16.0);
            below[behind] += error * (3.0 / 16.0);
            below[x + 1] += error * (5.0 / 16.0);
            below[ahead] += error * (1.0 / 16.0);
        }
        std::mem::swap(&mut here, &mut below);
        below.fill(Vec3::ZERO);
    }
}

/// Of the 8 codes around a unit vector, the one that decodes to the closest direction, and that direction.
///
/// Rounding each component by itself is not it: a code off the sphere may point better than one on it.
fn nearest<S: Space>(wanted: Normal<S>) -> ([u8; 3], Normal<S>) {
    let low = wanted.vec().to_array().map(|c| in_codes(c).floor().clamp(0.0, 254.0));
    // sin² of the angle to each: as exact as comparing decoded normals, in 60 % of the time (no root).
    let sin2 = std::array::from_fn::<f32, 8, _>(|corner| {
        let code = std::array::from_fn(|c| low[c] + (corner >> c & 1) as f32);
        let v = Vec3::from_array(code) * 2.0 - 255.0;
        wanted.vec().cross(v).length_squared() / v.length_squared()
    });
    let best = (0..8).min_by(|&a, &b| sin2[a].total_cmp(&sin2[b])).expect("invariant: there are 8");
    let code = std::array::from_fn(|c| low[c] as u8 + (best >> c & 1) as u8);
    (code, decode_u8(code))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::grid::Edges;
    use crate::normal::Object;

    const MODES: [DitherU8; 3] = [DitherU8::None, DitherU8::BlueNoise, DitherU8::Diffusion];

    /// A slowly curving map: `bend` is the change of slope over the whole map.
    fn curving(width: u32, height: u32, bend: f32, around: Vec3) -> NormalMap<Object> {
        Grid::from_fn(width, height, |x, y| {
            let (u, v) = (x as f32 / width as f32 - 0.5, y as f32 / height as f32 - 0.5);
            Normal::new(around + bend * Vec3::new(u, v * 0.8 + u * u, 0.3 * v)).unwrap()
        })
        .unwrap()
    }

    fn decoded(map: &NormalMap<Object>, dither: DitherU8) -> NormalMap<Object> {
        encode_map_u8(map, dither).map(|c| decode_u8(*c))
    }

    /// Normals averaged with a Gaussian of σ = 1.5 texels, cut at 6, as a lens or a mip level would.
    fn blurred(map: &NormalMap<Object>) -> Grid<DVec3> {
        let weights: Vec<f64> = (-6..=6).map(|i| (-f64::from(i * i) / 4.5).exp()).collect();
        let (w, h) = map.size();
        let at = |x: i64, y: i64| map[(Edges::Clamp.resolve(x, w), Edges::Clamp.resolve(y, h))].vec().as_dvec3();
        let line = |f: &dyn Fn(i64) -> DVec3| (-6..=6).zip(&weights).map(|(i, w)| f(i) * *w).sum::<DVec3>();
        let rows = Grid::from_fn(w, h, |x, y| line(&|i| at(i64::from(x) + i, y.into()))).unwrap();
        let row = |x: u32, y: i64| rows[(x, Edges::Clamp.resolve(y, h))];
        Grid::from_fn(w, h, |x, y| line(&|i| row(x, i64::from(y) + i)).normalize()).unwrap()
    }

    /// RMS angle in degrees away from the border.
    fn rms_deg(a: &Grid<DVec3>, b: &Grid<DVec3>) -> f64 {
        let (w, h) = a.size();
        let (mut sum, mut count) = (0.0, 0);
        for y in 8..h - 8 {
            for x in 8..w - 8 {
                sum += (a[(x, y)] - b[(x, y)]).length_squared();
                count += 1;
            }
        }
        (sum / f64::from(count)).sqrt().to_degrees()
    }

    #[test]
    fn smooth_curvature_survives_in_local_averages() {
        for (name, around) in [("tangent", Vec3::Z), ("oblique", Vec3::new(0.5, -0.7, 0.6)), ("edge", Vec3::X)] {
            let map = curving(161, 131, 0.15, around);
            let error = |dither| rms_deg(&blurred(&map), &blurred(&decoded(&map, dither)));
            let single = |dither| {
                let plain = |m: &NormalMap<Object>| m.map(|n| n.vec().as_dvec3());
                rms_deg(&plain(&map), &plain(&decoded(&map, dither)))
            };
            let [none, masked, diffused] = MODES.map(error);
            let singles = MODES.map(single);
            println!("{name}: blurred {none:.4}° {masked:.4}° {diffused:.4}°, single texels {singles:.4?}°");
            assert!(masked < none * 0.35, "{name}: {none} {masked}");
            assert!(diffused < none * 0.22, "{name}: {none} {diffused}");
        }
    }

    #[test]
    fn mean_over_a_flat_map_is_the_normal_itself() {
        for v in [Vec3::Z, Vec3::new(0.3, 0.2, 0.9), Vec3::new(-0.51, 0.77, -0.33), Vec3::new(-1.0, 0.004, 0.0)] {
            let n = Normal::<Object>::new(v).unwrap();
            let map = Grid::filled(128, 128, n).unwrap();
            for dither in [DitherU8::BlueNoise, DitherU8::Diffusion] {
                let mean = decoded(&map, dither).texels().iter().map(|n| n.vec().as_dvec3()).sum::<DVec3>();
                let off = (mean.normalize() - n.vec().as_dvec3()).length().to_degrees();
                assert!(off < 0.005, "{dither:?} {v}: {off}°");
            }
        }
    }

    #[test]
    fn no_texel_strays_farther_than_its_codes() {
        let map = curving(67, 43, 0.7, Vec3::new(0.2, 0.3, 1.0));
        // One code in each component (blue noise), and what diffusion has piled up besides.
        for (dither, codes) in [(DitherU8::None, 0.5), (DitherU8::BlueNoise, 1.0), (DitherU8::Diffusion, 1.5)] {
            let limit = codes * 3.0f64.sqrt() / 127.5 * 1.01;
            for (n, d) in map.texels().iter().zip(decoded(&map, dither).texels()) {
                assert!(n.angle_to(*d) <= limit, "{dither:?} {n:?} {d:?}");
            }
        }
    }

    #[test]
    fn mirrored_normals_diffuse_to_mirrored_codes() {
        // c and 255 − c decode to opposite components, so nothing favours a side. (Blue noise does, texel by
        // texel: the mask does not turn with the normals.)
        let map = curving(41, 29, 0.3, Vec3::new(0.31, 0.22, 0.9));
        let mirrored = map.map(|n| Normal::<Object>::new(n.vec() * Vec3::new(-1.0, 1.0, -1.0)).unwrap());
        for dither in [DitherU8::None, DitherU8::Diffusion] {
            let opposite = encode_map_u8(&map, dither).map(|&[r, g, b]| [255 - r, g, 255 - b]);
            assert_eq!(encode_map_u8(&mirrored, dither), opposite, "{dither:?}");
        }
    }

    #[test]
    fn nearest_is_the_best_of_the_codes_within_one_step() {
        let map = curving(23, 19, 3.0, Vec3::new(0.1, 0.2, 0.1));
        for n in map.texels() {
            let (code, decoded) = nearest(*n);
            assert_eq!(decoded, decode_u8(code));
            let rounded = encode_u8(*n).map(i32::from);
            let around = (0..125).map(|i| [i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2]);
            let codes = around.map(|d| std::array::from_fn::<i32, 3, _>(|c| rounded[c] + d[c]));
            let inside = |code: &[i32; 3]| {
                let exact = n.vec().to_array().map(|c| f64::from(c) * 127.5 + 127.5);
                (0..3).all(|c| (0..256).contains(&code[c]) && (f64::from(code[c]) - exact[c]).abs() < 1.0)
            };
            for code in codes.filter(inside) {
                let other = decode_u8::<Object>(code.map(|c| c as u8));
                assert!(n.angle_to(decoded) <= n.angle_to(other) + 1e-6, "{n:?} {code:?}");
            }
        }
    }

    #[test]
    fn one_texel_and_lines_are_maps() {
        for (w, h) in [(1, 1), (1, 7), (9, 1)] {
            for dither in MODES {
                let map = curving(w, h, 0.1, Vec3::Z);
                assert_eq!(encode_map_u8(&map, dither).size(), (w, h));
                assert_eq!(encode_map_u8(&map, dither), encode_map_u8(&map, dither));
            }
        }
    }
}
