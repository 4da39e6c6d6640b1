//! The sphere as a square (Meyer et al. 2010, "On Floating-Point Normal Vectors"): an octahedron whose lower half is unfolded.

use glam::{Vec2, Vec3};

/// The point of the square (−1 … 1) for a direction of any length; its middle is +Z.
pub(in crate::light) fn to_square(d: Vec3) -> Vec2 {
    let sum = d.x.abs() + d.y.abs() + d.z.abs();
    let (s, t) = (d.x / sum, d.y / sum);
    if d.z >= 0.0 {
        return Vec2::new(s, t);
    }
    Vec2::new((1.0 - t.abs()).copysign(s), (1.0 - s.abs()).copysign(t))
}

/// The point of the octahedron |x| + |y| + |z| = 1 for one of the square, or for one a little beyond its border.
pub(super) fn to_direction(p: Vec2) -> Vec3 {
    // Past a border the map goes on from the same border, mirrored at its middle.
    let p = if p.x.abs() > 1.0 { Vec2::new((2.0 - p.x.abs()).copysign(p.x), -p.y) } else { p };
    let p = if p.y.abs() > 1.0 { Vec2::new(-p.x, (2.0 - p.y.abs()).copysign(p.y)) } else { p };
    let z = 1.0 - p.x.abs() - p.y.abs();
    if z >= 0.0 {
        return p.extend(z);
    }
    Vec3::new((1.0 - p.y.abs()).copysign(p.x), (1.0 - p.x.abs()).copysign(p.y), z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_and_the_sphere_are_inverse() {
        for i in 0..3000 {
            let t = i as f32;
            let d = Vec3::new((t * 0.37).sin(), (t * 0.91).cos(), (t * 0.113).sin()).normalize();
            let p = to_square(d);
            assert!(p.abs().max_element() <= 1.0);
            assert!((to_direction(p).normalize() - d).length() < 1e-5, "{d}");
        }
    }

    /// A step over the border is as small on the sphere as one inside.
    #[test]
    fn the_border_goes_on_where_the_map_does() {
        for i in -9..=9 {
            let along = i as f32 / 10.0;
            for (inside, outside) in [
                (Vec2::new(0.99, along), Vec2::new(1.01, along)),
                (Vec2::new(-0.99, along), Vec2::new(-1.01, along)),
                (Vec2::new(along, 0.99), Vec2::new(along, 1.01)),
                (Vec2::new(along, -0.99), Vec2::new(along, -1.01)),
            ] {
                let (a, b) = (to_direction(inside).normalize(), to_direction(outside).normalize());
                assert!((a - b).length() < 0.06, "{inside} {a}, {outside} {b}");
            }
        }
    }
}
