//! Clipping in homogeneous coordinates.
//!
//! Triangles are clipped to the near and far planes and to a guard band well outside the picture, which keeps
//! fixed-point coordinates in range. A new corner is always computed from the inside end of an edge to its outside
//! end, so two triangles that share an edge get the same corner to the last bit and no crack opens.

use glam::DVec4;

/// A corner of a clipped triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corner {
    /// Clip-space position.
    pub(super) position: DVec4,
    /// Barycentric coordinates in the triangle that was clipped.
    pub(super) weights: [f64; 3],
}

/// At most six planes each add one corner to the three.
const MAX_CORNERS: usize = 9;

/// The part of a triangle inside the clip volume, as a convex polygon of 0 or 3 … 9 corners in the same orientation.
///
/// Clip coordinates x and y may reach `guard_band` times w before the triangle is cut there.
pub(super) fn clip(triangle: [DVec4; 3], guard_band: f64) -> Vec<Corner> {
    let mut polygon: Vec<Corner> = Vec::with_capacity(MAX_CORNERS);
    for (i, position) in triangle.into_iter().enumerate() {
        let mut weights = [0.0; 3];
        weights[i] = 1.0;
        polygon.push(Corner { position, weights });
    }
    let distance = |plane: usize, p: DVec4| match plane {
        0 => p.z,
        1 => p.w - p.z,
        2 => guard_band * p.w - p.x,
        3 => guard_band * p.w + p.x,
        4 => guard_band * p.w - p.y,
        _ => guard_band * p.w + p.y,
    };
    for plane in (0..6).map(|i| move |p| distance(i, p)) {
        if polygon.iter().all(|c| plane(c.position) >= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(MAX_CORNERS);
        for (i, &corner) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let (here, there) = (plane(corner.position), plane(next.position));
            if here >= 0.0 {
                kept.push(corner);
            }
            if (here >= 0.0) != (there >= 0.0) {
                kept.push(if here >= 0.0 { cut(corner, here, next, there) } else { cut(next, there, corner, here) });
            }
        }
        polygon = kept;
        if polygon.is_empty() {
            break;
        }
    }
    polygon
}

/// Where the edge from `inside` (distance ≥ 0) to `outside` (distance < 0) meets the plane.
fn cut(inside: Corner, distance_in: f64, outside: Corner, distance_out: f64) -> Corner {
    let t = distance_in / (distance_in - distance_out);
    let mix = |a: f64, b: f64| a + t * (b - a);
    let mut weights = inside.weights;
    for (w, o) in weights.iter_mut().zip(outside.weights) {
        *w = mix(*w, o);
    }
    Corner { position: inside.position + t * (outside.position - inside.position), weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inside_is_untouched_and_outside_vanishes() {
        let p = |x, y, z| DVec4::new(x, y, z, 1.0);
        let inside = [p(0.0, 0.0, 0.5), p(1.0, 0.0, 0.5), p(0.0, 1.0, 0.5)];
        let kept = clip(inside, 8.0);
        assert_eq!(kept.iter().map(|c| c.position).collect::<Vec<_>>(), inside);
        assert!(clip(inside.map(|v| v - DVec4::Z), 8.0).is_empty());
    }

    #[test]
    fn weights_reproduce_the_cut_corners() {
        let t = [DVec4::new(-30.0, 0.3, 0.4, 1.0), DVec4::new(9.0, 22.0, 0.5, 1.2), DVec4::new(0.1, -0.2, 0.5, 1.0)];
        let polygon = clip(t, 8.0);
        assert!(polygon.len() > 3);
        for c in polygon {
            let sum = t[0] * c.weights[0] + t[1] * c.weights[1] + t[2] * c.weights[2];
            assert!((sum - c.position).length() < 1e-12);
            assert!((c.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn shared_edges_are_cut_at_the_same_bits() {
        let (a, b) = (DVec4::new(0.3, 0.1, 0.7, 1.3), DVec4::new(-0.9, 0.77, -0.31, 0.2));
        let new_corner = |t: [DVec4; 3]| {
            let on_edge = |c: &Corner| c.position.z.abs() < 1e-12 && c.weights[2] == 0.0;
            clip(t, 8.0).into_iter().find(on_edge).unwrap().position
        };
        let one = new_corner([a, b, DVec4::new(0.5, 0.5, 0.5, 1.0)]);
        let two = new_corner([b, a, DVec4::new(-0.5, -0.5, 0.9, 1.0)]);
        assert_eq!(one, two);
    }
}
