//! The silhouette: a chain of cubic Bézier curves in (radius, y), from inside the mouth over the lip to the foot.

use std::sync::OnceLock;

/// One curve of the silhouette.
pub(super) struct Piece {
    /// Control points (radius, y); the outside lies to the left of the way.
    control: [[f32; 2]; 4],
    /// Faces along it in a mesh of [`super::DEFAULT_SEGMENTS`].
    pub(super) rings: u32,
    /// Map length per length of the curve: parts nobody looks at get less.
    share: f32,
}

/// The curves, in order. The mouth, wall, lip and foot of an Attic neck amphora: mouth about 2/5 and foot about 1/3 of
/// the height wide, the neck a quarter of the height, the widest place at 3/5 of it.
pub(super) const PIECES: [Piece; 10] = [
    piece([[0.0, 0.40], [0.12, 0.40], [0.20, 0.45], [0.203, 0.55]], 1, 0.30),
    piece([[0.203, 0.55], [0.210, 0.72], [0.24, 0.86], [0.320, 0.980]], 1, 0.40),
    piece([[0.320, 0.980], [0.333, 0.995], [0.356, 0.997], [0.371, 0.980]], 1, 1.0),
    piece([[0.371, 0.980], [0.377, 0.915], [0.330, 0.882], [0.282, 0.868]], 2, 1.0),
    piece([[0.282, 0.868], [0.250, 0.80], [0.232, 0.68], [0.262, 0.556]], 2, 1.0),
    piece([[0.262, 0.556], [0.45, 0.525], [0.620, 0.41], [0.628, 0.19]], 5, 1.0),
    piece([[0.628, 0.19], [0.636, -0.12], [0.425, -0.49], [0.196, -0.872]], 6, 1.0),
    piece([[0.196, -0.872], [0.198, -0.897], [0.225, -0.905], [0.265, -0.910]], 1, 1.0),
    piece([[0.265, -0.910], [0.310, -0.918], [0.328, -0.968], [0.306, -1.0]], 2, 1.0),
    piece([[0.306, -1.0], [0.24, -0.978], [0.14, -0.97], [0.0, -0.97]], 1, 0.45),
];

const fn piece(control: [[f32; 2]; 4], rings: u32, share: f32) -> Piece {
    Piece { control, rings, share }
}

/// Samples per curve in the arc length table.
const STEPS: usize = 64;

/// A place on the silhouette.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// Distance from the axis.
    pub(super) radius: f32,
    /// Height.
    pub(super) y: f32,
    /// The outward unit normal (radius, y).
    pub(super) normal: [f32; 2],
    /// Map length from the start of the first curve.
    pub(super) s: f32,
}

impl Piece {
    fn at(&self, t: f32) -> ([f32; 2], [f32; 2]) {
        let q = 1.0 - t;
        let [a, b, c, d] = self.control;
        let point = |i: usize| q * q * q * a[i] + 3.0 * q * q * t * b[i] + 3.0 * q * t * t * c[i] + t * t * t * d[i];
        let slope = |i: usize| q * q * (b[i] - a[i]) + 2.0 * q * t * (c[i] - b[i]) + t * t * (d[i] - c[i]);
        let (x, y) = (slope(0), slope(1));
        let length = (x * x + y * y).sqrt();
        ([point(0), point(1)], [-y / length, x / length])
    }
}

/// The silhouette with its map lengths.
pub(super) struct Profile {
    /// Per curve, `STEPS + 1` points evenly spaced in its parameter.
    samples: Vec<Vec<Point>>,
}

impl Profile {
    /// The vase's one silhouette.
    pub(super) fn get() -> &'static Self {
        static PROFILE: OnceLock<Profile> = OnceLock::new();
        PROFILE.get_or_init(|| {
            let mut s = 0.0f64;
            let samples = PIECES.iter().map(|piece| {
                let mut last: Option<[f32; 2]> = None;
                let points = (0..=STEPS).map(|i| {
                    let ([radius, y], normal) = piece.at(i as f32 / STEPS as f32);
                    if let Some([r0, y0]) = last {
                        let (dr, dy) = (f64::from(radius - r0), f64::from(y - y0));
                        s += f64::from(piece.share) * (dr * dr + dy * dy).sqrt();
                    }
                    last = Some([radius, y]);
                    Point { radius, y, normal, s: s as f32 }
                });
                points.collect::<Vec<_>>()
            });
            Self { samples: samples.collect() }
        })
    }

    /// Map length of the whole silhouette.
    pub(super) fn length(&self) -> f32 {
        self.end(PIECES.len() - 1)
    }

    /// Map length where a curve starts.
    pub(super) fn start(&self, piece: usize) -> f32 {
        self.samples[piece][0].s
    }

    /// Map length where a curve ends.
    pub(super) fn end(&self, piece: usize) -> f32 {
        self.samples[piece][STEPS].s
    }

    /// `n + 1` points that cut a curve into `n` parts, shorter where it bends and where it tapers.
    ///
    /// Equal lengths would draw the outline's bends as corners;
    /// and where a face is much narrower below than above, its two triangles shear the texture by as much. So parts are
    /// equal in the sum of their length, twice their bend (radians) and twice their taper (the radii's logarithm),
    /// roughly; on the axis, where the taper has no bound, its slope is held.
    pub(super) fn cut(&self, piece: usize, n: u32) -> impl Iterator<Item = Point> + '_ {
        let points = &self.samples[piece];
        let cost = |w: &[Point]| {
            let d = [w[1].normal[0] - w[0].normal[0], w[1].normal[1] - w[0].normal[1]];
            let bend = (d[0] * d[0] + d[1] * d[1]).sqrt();
            let taper = (w[1].radius - w[0].radius).abs() / w[0].radius.max(w[1].radius).max(0.1);
            (w[1].s - w[0].s) + 2.0 * bend + 2.0 * taper
        };
        let mut sums = vec![0.0f32];
        for w in points.windows(2) {
            sums.push(sums[sums.len() - 1] + cost(w));
        }
        (0..=n).map(move |i| {
            let goal = sums[STEPS] * i as f32 / n as f32;
            let right = sums.partition_point(|&x| x < goal).clamp(1, STEPS);
            let t = (goal - sums[right - 1]) / (sums[right] - sums[right - 1]);
            self.on_piece(piece, points[right - 1].s + t * (points[right].s - points[right - 1].s))
        })
    }

    /// The place at map length `s`, clamped to the ends.
    pub(super) fn at(&self, s: f32) -> Point {
        let last = PIECES.len() - 1;
        let piece = (0..last).find(|&i| s < self.end(i)).unwrap_or(last);
        self.on_piece(piece, s)
    }

    fn on_piece(&self, piece: usize, s: f32) -> Point {
        let points = &self.samples[piece];
        let right = points.partition_point(|p| p.s < s).clamp(1, STEPS);
        let (a, b) = (points[right - 1], points[right]);
        let t = ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0);
        let ([radius, y], normal) = PIECES[piece].at(((right - 1) as f32 + t) / STEPS as f32);
        Point { radius, y, normal, s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_meet_and_the_vase_is_two_high() {
        for pair in PIECES.windows(2) {
            assert_eq!(pair[0].control[3], pair[1].control[0]);
        }
        let p = Profile::get();
        let ys = p.samples.iter().flatten().map(|p| p.y);
        let (low, high) = ys.fold((0.0f32, 0.0f32), |(l, h), y| (l.min(y), h.max(y)));
        assert!(low == -1.0 && (0.985..=1.0).contains(&high), "{low} {high}");
    }

    #[test]
    fn normals_point_out_and_lengths_rise() {
        let p = Profile::get();
        let widest = p.on_piece(6, p.start(6));
        assert!(widest.normal[0] > 0.999, "{widest:?}");
        assert!(p.on_piece(1, p.start(1)).normal[0] < -0.9, "the inside faces the axis");
        assert!(p.on_piece(9, p.end(9)).normal[1] < -0.99, "the bottom faces down");
        for points in &p.samples {
            assert!(points.windows(2).all(|w| w[0].s < w[1].s));
        }
    }
}
