//! Polygons cut into triangles by ear clipping (Meisters 1975), concave ones without flipped area.

use glam::{DVec2, DVec3};

/// Ear clipping takes n² steps, n³ for the worst; a file may hold many such polygons.
const MAX_CONCAVE: usize = 1024;

/// Corner numbers of the triangles of a simple polygon, wound as it is; always n − 2 of them.
///
/// The polygon is looked at along its own mean normal (Newell). Strictly convex ones become a fan from the first corner, except
/// quads, which are cut along the shorter diagonal: independent of the order of corners, as Mikkelsen 2008 advises.
pub(super) fn triangulate(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, String> {
    let n = corners.len();
    let fan = |first: usize| (1..n - 1).map(|k| [first, (first + k) % n, (first + k + 1) % n]).collect();
    let flat = flatten(corners);
    if (0..n).all(|k| turn(flat[k], flat[(k + 1) % n], flat[(k + 2) % n]) > 0.0) && winds_once(&flat) {
        let second_is_shorter =
            n == 4 && corners[1].distance_squared(corners[3]) < corners[0].distance_squared(corners[2]);
        return Ok(fan(usize::from(second_is_shorter)));
    }
    if n > MAX_CONCAVE {
        return Err(format!("a polygon of {n} corners that is not convex"));
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    while left.len() > 3 {
        let k = find_ear(&flat, &left);
        let m = left.len();
        triangles.push([left[(k + m - 1) % m], left[k], left[(k + 1) % m]]);
        left.remove(k);
    }
    triangles.push([left[0], left[1], left[2]]);
    Ok(triangles)
}

/// The polygon seen against its mean normal, counter-clockwise, about 1 in size.
fn flatten(corners: &[DVec3]) -> Vec<DVec2> {
    // Relative to the first corner and to the size: products neither cancel far from the origin nor underflow.
    let size = corners.iter().fold(0.0f64, |s, p| s.max((*p - corners[0]).abs().max_element()));
    let near: Vec<_> = corners.iter().map(|p| (*p - corners[0]) / if size > 0.0 { size } else { 1.0 }).collect();
    let next = near.iter().cycle().skip(1);
    let normal = near.iter().zip(next).fold(DVec3::ZERO, |sum, (a, b)| sum + a.cross(*b));
    let size = normal.abs();
    // Leaving out the axis along which it extends least keeps the turns; the order of the others keeps the winding.
    let (right, up, along): (DVec3, DVec3, f64) = if size.z >= size.x.max(size.y) {
        (DVec3::X, DVec3::Y, normal.z)
    } else if size.y >= size.x {
        (DVec3::Z, DVec3::X, normal.y)
    } else {
        (DVec3::Y, DVec3::Z, normal.x)
    };
    let flip = if along < 0.0 { -1.0 } else { 1.0 };
    near.iter().map(|p| DVec2::new(p.dot(right) * flip, p.dot(up))).collect()
}

/// Positive if a → b → c turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// Whether a polygon of left turns only goes round once (a pentagram goes round twice): its edges head up once.
fn winds_once(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let up = |k: usize| {
        let edge = flat[(k + 1) % n] - flat[k % n];
        edge.y > 0.0 || (edge.y == 0.0 && edge.x > 0.0)
    };
    (0..n).filter(|&k| !up(k) && up(k + 1)).count() == 1
}

/// The first corner whose triangle has an area and holds no other corner; for polygons that cross themselves, or whose
/// rest has no area, the most convex corner, so that the work always ends.
fn find_ear(flat: &[DVec2], left: &[usize]) -> usize {
    let m = left.len();
    let at = |k: usize| flat[left[k % m]];
    let turns: Vec<f64> = (0..m).map(|k| turn(at(k + m - 1), at(k), at(k + 1))).collect();
    let is_ear = |&k: &usize| {
        let (a, b, c) = (at(k + m - 1), at(k), at(k + 1));
        // Only a corner that is not convex can lie in an ear; a copy of one of its own corners does not count.
        let inside = |p: DVec2| {
            let outside = turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0;
            !outside && p != a && p != b && p != c
        };
        turns[k] > 0.0 && !(0..m).any(|j| turns[j] <= 0.0 && inside(at(j)))
    };
    let most_convex = || (0..m).max_by(|&i, &j| turns[i].total_cmp(&turns[j])).unwrap_or(0);
    (0..m).find(is_ear).unwrap_or_else(most_convex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn areas(corners: &[DVec3], triangles: &[[usize; 3]]) -> Vec<DVec3> {
        let area = |t: &[usize; 3]| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]) * 0.5;
        triangles.iter().map(area).collect()
    }

    fn check(corners: &[DVec3], normal: DVec3, area: f64) {
        for start in 0..corners.len() {
            let mut turned = corners.to_vec();
            turned.rotate_left(start);
            let triangles = triangulate(&turned).unwrap();
            assert_eq!(triangles.len(), corners.len() - 2);
            let areas = areas(&turned, &triangles);
            assert!(areas.iter().all(|a| a.dot(normal) >= 0.0), "{start}: {areas:?}");
            let sum: f64 = areas.iter().map(|a| a.length()).sum();
            assert!((sum - area).abs() < 1e-9 * area, "{start}: {sum}");
        }
    }

    #[test]
    fn concave_polygons_keep_their_winding() {
        let dart = [(0.0, 0.0), (2.0, -1.0), (0.5, 0.0), (2.0, 1.0)];
        let comb = [(0., 0.), (5., 0.), (5., 3.), (4., 3.), (4., 1.), (3., 1.), (3., 3.), (2., 3.), (2., 1.), (0., 1.)];
        for (shape, area) in [(&dart[..], 0.5), (&comb[..], 9.0)] {
            let z: Vec<_> = shape.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
            check(&z, DVec3::Z, area);
            for (turn, normal) in [
                ((|p| DVec3::new(p.z, p.x, p.y)) as fn(DVec3) -> DVec3, DVec3::X),
                (|p| DVec3::new(p.y, p.z, p.x), DVec3::Y),
                (|p| DVec3::new(-p.x, p.y, p.z), -DVec3::Z),
                (|p| DVec3::new(p.z, p.y, p.x), -DVec3::X),
            ] {
                let p: Vec<_> = z.iter().map(|&p| turn(p)).collect();
                check(&p, normal, area);
                let far: Vec<_> = p.iter().map(|&p| p * 1e-3 + DVec3::splat(100.0)).collect();
                check(&far, normal, area * 1e-6);
            }
        }
    }

    #[test]
    fn corners_in_a_line_do_not_make_flat_triangles() {
        let p = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        check(&p, DVec3::Z, 4.0);
        let triangles = triangulate(&p).unwrap();
        assert!(areas(&p, &triangles).iter().all(|a| a.z > 0.0), "{triangles:?}");
    }

    #[test]
    fn quads_are_cut_along_the_shorter_diagonal() {
        let p = [(0.0, 0.0), (3.0, 0.0), (4.0, 1.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert_eq!(triangulate(&p).unwrap(), [[1, 2, 3], [1, 3, 0]]);
        let mut q = p;
        q.rotate_left(1);
        assert_eq!(triangulate(&q).unwrap(), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn hopeless_polygons_end() {
        assert_eq!(triangulate(&[DVec3::ZERO; 7]).unwrap().len(), 5);
        let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert_eq!(triangulate(&bow).unwrap().len(), 2);
        let star: Vec<_> = (0..MAX_CONCAVE + 2)
            .map(|k| {
                let (sin, cos) = (k as f64 / (MAX_CONCAVE + 2) as f64 * std::f64::consts::TAU).sin_cos();
                DVec3::new(cos, sin, 0.0) * if k % 2 == 0 { 1.0 } else { 0.5 }
            })
            .collect();
        assert!(triangulate(&star).unwrap_err().contains("1026"));
    }

    proptest! {
        #[test]
        fn star_shapes_are_covered_exactly(radii in prop::collection::vec(0.05f64..1.0, 3..40)) {
            let n = radii.len() as f64;
            let p: Vec<_> = radii
                .iter()
                .enumerate()
                .map(|(k, r)| {
                    let (sin, cos) = (k as f64 / n * std::f64::consts::TAU).sin_cos();
                    DVec3::new(r * cos, 0.0, -r * sin)
                })
                .collect();
            let double: f64 = (0..p.len()).map(|k| p[k].cross(p[(k + 1) % p.len()]).y).sum();
            check(&p, DVec3::Y, double * 0.5);
        }
    }
}
