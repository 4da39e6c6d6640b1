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
    /// Power iteration: only the direction matters for where a set is cut, and that converges as soon as one exists.
    pub(super) fn principal(&self) -> ([f64; 3], f64) {
        let [xx, xy, xz, yy, yz, zz] = self.moments;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        // The longest row cannot be orthogonal to the principal direction.
        let largest = if xx >= yy && xx >= zz {
            0
        } else if yy >= zz {
            1
        } else {
            2
        };
        let (mut axis, mut length) = (rows[largest], 0.0);
        for _ in 0..10 {
            let norm = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
            if norm < 1e-200 {
                return ([1.0, 0.0, 0.0], 0.0);
            }
            let unit = axis.map(|c| c / norm);
            axis = rows.map(|r| r[0] * unit[0] + r[1] * unit[1] + r[2] * unit[2]);
            length = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
        }
        (axis.map(|c| c / length.max(1e-300)), length)
    }
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
