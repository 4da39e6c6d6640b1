//! How good a table can be at best.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

use super::points::Points;
use crate::order::{greater, lesser};

/// Intervals of the quadrature; the integrand is smooth. `triangles_cover_the_sphere` holds its error below 10⁻⁹.
const INTERVALS: u32 = 256;

/// The lowest root-mean-square angle, in radians, between directions spread evenly over the sphere and the nearest of
/// `entries` directions.
///
/// Fejes Tóth's moment theorem ("Lagerungen in der Ebene, auf der Kugel und im Raum", 1953): for a rising function f of
/// the angle to the nearest of n ≥ 3 points, ∫ f over the sphere is at least what 2n − 4 equilateral spherical triangles
/// that together have the sphere's area would give, each with f taken from its nearest corner. No configuration but
/// n = 3, 4, 6 and 12 reaches it (there the triangles exist), so it is a bound and not a prediction; for large n it tends to
/// Zador's constant of the hexagonal lattice, √(5 / (18√3) · 4π / n).
///
/// Such a triangle has area E = 4π / (2n − 4) and so, by its spherical excess, the angles α = (π + E) / 3. Its side s obeys
/// cos s = cos α / (1 − cos α), hence tan²(s/2) = 1 − 2 cos α. Its medians cut it into 6 right triangles with the angle α/2
/// at a corner; seen from that corner in direction φ the triangle ends on the mid-perpendicular of the side, at the angle
/// θ(φ) with tan θ = tan(s/2) / cos φ. With ∫ θ² sin θ dθ = −θ² cos θ + 2θ sin θ + 2 cos θ − 2 one integral over φ is left.
///
/// - **Validity:** n ≥ 3. For n = 2 the exact value of two hemispheres is given, √(π − 2), for n = 1 the exact one of a
///   single direction, √((π² − 4) / 2), and for n = 0 the largest angle there is, π.
/// - Measured over a finite sample of N random directions, a table can come out below, because it fits the
///   sample: 2.4 % below for n = 16 384 and N = 10⁶.
pub fn fejes_toth_rms_rad(entries: u32) -> f64 {
    match entries {
        0 => PI,
        1 => ((PI * PI - 4.0) / 2.0).sqrt(),
        2 => (PI - 2.0).sqrt(),
        n => {
            let second_moment = |t: f64| -t * t * t.cos() + 2.0 * t * t.sin() - 4.0 * (t / 2.0).sin().powi(2);
            mean_over_triangles(n, second_moment).sqrt()
        }
    }
}

/// Second moment of the regular hexagon of area 1: what the best cells of the plane look like.
const HEXAGON: f64 = 5.0 / (18.0 * 1.732_050_807_568_877_2);

/// The RMS angle, in radians, that the best of large tables tend to for directions as dense as `points`.
///
/// Zador's theorem (1982) in two dimensions: with the density p of what is quantised, the best table of K entries has the
/// mean squared error C · (∫ √p)² / K, C being the second moment of the hexagon. The integral is taken over cells of equal
/// area on the octahedron (Clarberg 2008), four per entry; with several materials, over those of each.
///
/// It is an estimate and not a bound: of a density that the cells only sample, for a table that is large, and for
/// densities that are smooth over a few cells. Fine lines and flat places are beaten by it or beat it.
pub(super) fn zador_rms_rad(points: &Points, entries: usize) -> f64 {
    // Cells with few points in them would take the sampling for structure.
    let side = ((4 * entries).min(points.len() / 4) as f64).sqrt().ceil().max(1.0) as usize;
    let cell = |c: f64| ((c * side as f64) as usize).min(side - 1);
    let (mut integral, mut total) = (0.0, 0.0);
    for group in &points.groups {
        let mut cells = vec![0.0; side * side];
        for i in group.points.clone() {
            let [u, v] = equal_area(points.at(i).map(f64::from));
            cells[cell(v) * side + cell(u)] += f64::from(points.weight[i]);
        }
        integral += cells.iter().map(|&weight| f64::sqrt(weight)).sum::<f64>();
        total += cells.iter().sum::<f64>();
    }
    let area = 4.0 * PI / (side * side) as f64;
    (HEXAGON * integral * integral * area / total / entries as f64).sqrt()
}

/// The sphere unfolded to the unit square so that areas keep their proportion (Clarberg 2008, "Fast equal-area mapping of
/// the (hemi)sphere using SIMD").
fn equal_area([x, y, z]: [f64; 3]) -> [f64; 2] {
    let radius = greater(1.0 - z.abs(), 0.0).sqrt();
    let v = quarter_turns(y.abs(), x.abs()) * radius;
    let (u, v) = if z < 0.0 { (1.0 - v, 1.0 - (radius - v)) } else { (radius - v, v) };
    [(u.copysign(x) + 1.0) * 0.5, (v.copysign(y) + 1.0) * 0.5]
}

/// The angle of a point of the first quadrant, in quarter turns, within 2·10⁻⁸ (Abramowitz and Stegun 1964, 4.4.49). In plain
/// arithmetic: several times faster than the library's, and the same everywhere.
fn quarter_turns(y: f64, x: f64) -> f64 {
    const EVEN: [f64; 9] = [
        1.0,
        -0.333_331_452_8,
        0.199_935_508_5,
        -0.142_088_994_4,
        0.106_562_639_3,
        -0.075_289_640_0,
        0.042_909_613_8,
        -0.016_165_736_7,
        0.002_866_225_7,
    ];
    let tangent = lesser(x, y) / greater(greater(x, y), f64::MIN_POSITIVE);
    let t2 = tangent * tangent;
    let turn = EVEN.iter().rev().fold(0.0, |sum, c| sum * t2 + c) * tangent * FRAC_2_PI;
    if y > x { 1.0 - turn } else { turn }
}

/// The mean over the sphere of the function whose integral ∫₀^θ f(t) sin t dt is `inner`, by triangles as above.
fn mean_over_triangles(n: u32, inner: impl Fn(f64) -> f64) -> f64 {
    let triangles = 2.0 * f64::from(n) - 4.0;
    let excess = 4.0 * PI / triangles;
    // 1 − 2 cos(π/3 + ε) without cancellation.
    let e = excess / 3.0;
    let tan_half_side = (2.0 * (e / 2.0).sin().powi(2) + 3f64.sqrt() * e.sin()).sqrt();
    let corner = ((PI + excess) / 6.0).min(FRAC_PI_2);
    let sixth = simpson(corner, |phi| inner(tan_half_side.atan2(phi.cos())));
    sixth * 6.0 * triangles / (4.0 * PI)
}

/// Simpson's rule for ∫ f over 0 … end.
fn simpson(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = end / f64::from(INTERVALS);
    let weight = |i| if i == 0 || i == INTERVALS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=INTERVALS).map(|i| weight(i) * f(f64::from(i) * step)).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_those_of_the_library() {
        for i in 0..=1000 {
            let (y, x) = (f64::from(i) * 0.002).sin_cos();
            let (y, x) = (y.abs(), x.abs());
            assert!((quarter_turns(y, x) - y.atan2(x) * FRAC_2_PI).abs() < 2e-8, "{i}");
        }
        assert_eq!(quarter_turns(0.0, 0.0), 0.0);
    }

    #[test]
    fn bound_is_as_published() {
        for (entries, degrees) in [(256, 5.0861), (2048, 1.7974), (16_384, 0.6355)] {
            let found = fejes_toth_rms_rad(entries).to_degrees();
            assert!((found - degrees).abs() < 5e-5, "{entries}: {found}");
        }
    }

    /// Evenly spread points along a spiral.
    fn spiral(count: usize, keep: impl Fn(f64) -> bool) -> Points {
        let point = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let (sin, cos) = (i as f64 * 2.399_963_229_728_653).sin_cos();
            let r = (1.0 - z * z).sqrt();
            ([(r * cos) as f32, (r * sin) as f32, z as f32], 1.0)
        };
        Points::new([(0, (0..count).map(point).filter(|p| keep(f64::from(p.0[2]))).collect())])
    }

    #[test]
    fn zador_tends_to_the_bound_for_an_even_density_and_knows_empty_space() {
        let whole = spiral(200_000, |_| true);
        let estimate = zador_rms_rad(&whole, 2048);
        assert!((estimate / fejes_toth_rms_rad(2048) - 1.0).abs() < 0.01, "{}", estimate.to_degrees());
        // A quarter of the area needs a quarter of the entries. (Cells on the rim are only partly filled.)
        let cap = zador_rms_rad(&spiral(200_000, |z| z > 0.5), 2048);
        assert!((cap / zador_rms_rad(&whole, 8192) - 1.0).abs() < 0.03, "{}", cap.to_degrees());
    }

    #[test]
    fn equal_areas_of_the_sphere_are_equal_areas_of_the_square() {
        let points = spiral(400_000, |_| true);
        let mut cells = [0; 16 * 16];
        for i in 0..points.len() {
            let [u, v] = equal_area(points.at(i).map(f64::from)).map(|c| ((c * 16.0) as usize).min(15));
            cells[v * 16 + u] += 1;
        }
        let expected = 400_000.0 / 256.0;
        assert!(cells.iter().all(|&c| (f64::from(c) / expected - 1.0).abs() < 0.05), "{cells:?}");
    }

    #[test]
    fn triangles_cover_the_sphere() {
        for n in [3, 4, 5, 12, 1000, 65_536, u32::MAX] {
            let area = mean_over_triangles(n, |t| 2.0 * (t / 2.0).sin().powi(2));
            assert!((area - 1.0).abs() < 1e-9, "{n}: {area}");
        }
    }

    #[test]
    fn three_points_are_lunes_and_more_points_are_better() {
        // Three lunes of 120° about their mid-points: ∫∫ over φ in ±π/3 and latitude, done directly.
        let lune = (0..1000).flat_map(|i| (0..1000).map(move |j| (i, j))).map(|(i, j)| {
            let phi: f64 = (f64::from(i) + 0.5) / 1000.0 * PI / 3.0;
            let z: f64 = (f64::from(j) + 0.5) / 1000.0;
            ((1.0 - z * z).sqrt() * phi.cos()).acos().powi(2)
        });
        let expected = (lune.sum::<f64>() / 1e6).sqrt();
        assert!((fejes_toth_rms_rad(3) - expected).abs() < 1e-5, "{expected}");
        let all: Vec<f64> = (0..5000).map(fejes_toth_rms_rad).collect();
        assert!(all.windows(2).all(|w| w[1] < w[0]));
    }

    #[test]
    fn large_tables_follow_zador() {
        let zador = (5.0 / (18.0 * 3f64.sqrt()) * 4.0 * PI / 65_536.0).sqrt();
        assert!((fejes_toth_rms_rad(65_536) / zador - 1.0).abs() < 1e-4);
    }
}
