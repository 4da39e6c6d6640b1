//! How far and in which direction a set of points is spread.

/// Second moments about a point, and their sum of weights.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spread {
    /// xx, xy, xz, yy, yz, zz.
    moments: [f64; 6],
}

impl Spread {
    /// Adds a point that lies `offset` from the centre.
    pub(super) fn add(&mut self, [x, y, z]: [f64; 3], weight: f64) {
        let [wx, wy, wz] = [x * weight, y * weight, z * weight];
        let m = &mut self.moments;
        m[0] += wx * x;
        m[1] += wx * y;
        m[2] += wx * z;
        m[3] += wy * y;
        m[4] += wy * z;
        m[5] += wz * z;
    }

    /// The direction of the largest spread and the sum of weight × offset² along it.
    ///
    /// Powers of the matrix: only the direction matters for where a set is cut, and that converges as soon as one exists.
    pub(super) fn principal(&self) -> ([f64; 3], f64) {
        let trace = self.moments[0] + self.moments[3] + self.moments[5];
        if trace < 1e-200 {
            return ([1.0, 0.0, 0.0], 0.0);
        }
        let mut power = self.moments.map(|m| m / trace);
        for _ in 0..DOUBLINGS {
            power = square(power);
        }
        let [xx, xy, xz, yy, yz, zz] = power;
        // The longest row cannot be orthogonal to the principal direction.
        let row = if xx >= yy && xx >= zz {
            [xx, xy, xz]
        } else if yy >= zz {
            [xy, yy, yz]
        } else {
            [xz, yz, zz]
        };
        let length = (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]).sqrt();
        let axis @ [x, y, z] = row.map(|c| c / length);
        let [xx, xy, xz, yy, yz, zz] = self.moments;
        (axis, xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z))
    }
}

/// How often the matrix is squared: its 16th power. The trace is 1 at first and thus no less than 3⁻¹⁶ in the end.
const DOUBLINGS: u32 = 4;

/// The square of a symmetric matrix.
fn square([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> [f64; 6] {
    [
        xx * xx + xy * xy + xz * xz,
        xx * xy + xy * yy + xz * yz,
        xx * xz + xy * yz + xz * zz,
        xy * xy + yy * yy + yz * yz,
        xy * xz + yy * yz + yz * zz,
        xz * xz + yz * yz + zz * zz,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_finds_the_long_axis() {
        let mut spread = Spread::default();
        for t in [-2.0, -1.0, 1.0, 2.0] {
            spread.add([0.6 * t, 0.0, 0.8 * t], 0.5);
            spread.add([0.0, 0.1 * t, 0.0], 0.5);
        }
        let (axis, along) = spread.principal();
        assert!((axis[0] - 0.6).abs() < 1e-9 && (axis[2] - 0.8).abs() < 1e-9 && (along - 5.0).abs() < 1e-9);
        assert_eq!(Spread::default().principal().1, 0.0);
    }
}
