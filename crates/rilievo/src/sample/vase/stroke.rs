//! Brush strokes as signed distances: every ornament is a union of tapered strokes.
//!
//! One primitive is enough for palmettes, lotus flowers, spirals, tongues and rays, and its distance gives crisp
//! materials, antialiased colours and bevels of a fixed width from the same number, at any resolution.

use crate::sample::turn;

/// A point in an ornament's cell: x to the right, y up.
pub(super) type Point = [f32; 2];

/// A tapered stroke: all discs between disc (a, ra) and disc (b, rb).
#[derive(Debug, Clone, Copy)]
struct Stroke {
    a: Point,
    ab: Point,
    /// 1 / |ab|², or 0 for a dot.
    inverse_square: f32,
    ra: f32,
    rb: f32,
}

impl Stroke {
    fn new(a: Point, ra: f32, b: Point, rb: f32) -> Self {
        let ab = [b[0] - a[0], b[1] - a[1]];
        let square = ab[0] * ab[0] + ab[1] * ab[1];
        Self { a, ab, inverse_square: if square > 0.0 { 1.0 / square } else { 0.0 }, ra, rb }
    }

    /// Signed distance, positive inside. The disc nearest along the axis stands for the nearest disc, which is exact for
    /// even strokes and off by the cosine of the taper for others: curves are cut so fine that it does not show.
    fn inside(&self, p: Point) -> f32 {
        let d = [p[0] - self.a[0], p[1] - self.a[1]];
        let t = ((d[0] * self.ab[0] + d[1] * self.ab[1]) * self.inverse_square).clamp(0.0, 1.0);
        let e = [d[0] - t * self.ab[0], d[1] - t * self.ab[1]];
        self.ra + t * (self.rb - self.ra) - (e[0] * e[0] + e[1] * e[1]).sqrt()
    }
}

/// Collects strokes.
#[derive(Debug, Clone, Default)]
pub(super) struct Pen {
    strokes: Vec<Stroke>,
}

impl Pen {
    /// A straight stroke.
    pub(super) fn line(&mut self, a: Point, ra: f32, b: Point, rb: f32) {
        self.strokes.push(Stroke::new(a, ra, b, rb));
    }

    /// A dot.
    pub(super) fn dot(&mut self, centre: Point, radius: f32) {
        self.line(centre, radius, centre, radius);
    }

    /// A stroke through points `way(t)` of half-width `half(t)`, t = 0 … 1 in `n` pieces.
    pub(super) fn sweep(&mut self, n: u32, way: impl Fn(f32) -> Point, half: impl Fn(f32) -> f32) {
        for i in 0..n {
            let (t0, t1) = (i as f32 / n as f32, (i + 1) as f32 / n as f32);
            self.line(way(t0), half(t0), way(t1), half(t1));
        }
    }

    /// A stroke along a cubic Bézier curve.
    pub(super) fn curve(&mut self, control: [Point; 4], half: impl Fn(f32) -> f32) {
        self.sweep(24, |t| cubic(control, t), half);
    }

    /// A spiral about `centre`, from start to end: `turns` (counter-clockwise from +x), `radius` and `half` width.
    pub(super) fn spiral(&mut self, centre: Point, turns: [f32; 2], radius: [f32; 2], half: [f32; 2]) {
        let between = |[from, to]: [f32; 2], t: f32| from + (to - from) * t;
        let n = ((turns[1] - turns[0]).abs() * 32.0).ceil() as u32;
        let way = |t: f32| {
            let (sin, cos) = turn::sin_cos(f64::from(between(turns, t)));
            let r = between(radius, t);
            [centre[0] + r * cos, centre[1] + r * sin]
        };
        self.sweep(n, way, |t| between(half, t));
    }

    /// Adds the strokes of `other`, moved and turned by `place`: a point p goes to `origin + scale · p`, y flipped if
    /// `hanging`.
    pub(super) fn stamp(&mut self, other: &Self, origin: Point, scale: f32, hanging: bool) {
        let flip = if hanging { -scale } else { scale };
        let place = |p: Point| [origin[0] + scale * p[0], origin[1] + flip * p[1]];
        for s in &other.strokes {
            let b = [s.a[0] + s.ab[0], s.a[1] + s.ab[1]];
            self.line(place(s.a), scale * s.ra, place(b), scale * s.rb);
        }
    }

    /// Adds the mirror image about x = 0.
    pub(super) fn mirror(&mut self) {
        for i in 0..self.strokes.len() {
            let s = self.strokes[i];
            let b = [s.a[0] + s.ab[0], s.a[1] + s.ab[1]];
            self.line([-s.a[0], s.a[1]], s.ra, [-b[0], b[1]], s.rb);
        }
    }
}

/// A point of a cubic Bézier curve.
pub(super) fn cubic(c: [Point; 4], t: f32) -> Point {
    let q = 1.0 - t;
    let at =
        |i: usize| q * q * q * c[0][i] + 3.0 * q * q * t * c[1][i] + 3.0 * q * t * t * c[2][i] + t * t * t * c[3][i];
    [at(0), at(1)]
}

/// Buckets along the longer side of a cell.
const BUCKETS: f32 = 40.0;

/// The strokes of one cell of a frieze, sorted into buckets; cells repeat to the left and to the right.
#[derive(Debug, Clone)]
pub(super) struct Motif {
    strokes: Vec<Stroke>,
    /// Strokes of bucket (column, row) are `lists[starts[k]..starts[k + 1]]`, k = row · columns + column.
    lists: Vec<u16>,
    starts: Vec<u32>,
    columns: u32,
    rows: u32,
    width: f32,
    reach: f32,
}

impl Motif {
    /// A cell of `width` × 1, x from −width / 2 to width / 2, y from 0 to 1; distances are right up to `reach`.
    pub(super) fn new(pen: &Pen, width: f32, reach: f32) -> Self {
        let bucket = width.max(1.0) / BUCKETS;
        let (columns, rows) = ((width / bucket).ceil() as u32, (1.0 / bucket).ceil() as u32);
        let mut strokes = Vec::with_capacity(pen.strokes.len() * 3);
        for shift in [-width, 0.0, width] {
            strokes.extend(pen.strokes.iter().map(|s| Stroke { a: [s.a[0] + shift, s.a[1]], ..*s }));
        }
        let (mut lists, mut starts) = (Vec::new(), vec![0]);
        for k in 0..columns * rows {
            let (column, row) = ((k % columns) as f32, (k / columns) as f32);
            let centre = [(column + 0.5) * width / columns as f32 - width / 2.0, (row + 0.5) / rows as f32];
            let near = -reach - bucket * std::f32::consts::FRAC_1_SQRT_2;
            let touching = strokes.iter().enumerate().filter(|(_, s)| s.inside(centre) > near);
            lists.extend(touching.map(|(i, _)| i as u16));
            starts.push(lists.len() as u32);
        }
        Self { strokes, lists, starts, columns, rows, width, reach }
    }

    /// The cell's width in its heights.
    pub(super) fn width(&self) -> f32 {
        self.width
    }

    /// Signed distance to the strokes, positive inside, never below −reach. `p` is inside the cell.
    pub(super) fn inside(&self, p: Point) -> f32 {
        let column = (p[0] / self.width + 0.5) * self.columns as f32;
        let row = p[1] * self.rows as f32;
        // Float to integer saturates, so places a hair outside the cell use its border buckets.
        let k = (row as u32).min(self.rows - 1) * self.columns + (column as u32).min(self.columns - 1);
        let list = &self.lists[self.starts[k as usize] as usize..self.starts[k as usize + 1] as usize];
        list.iter().fold(-self.reach, |d, &i| d.max(self.strokes[usize::from(i)].inside(p)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_change_nothing_within_reach() {
        let mut pen = Pen::default();
        pen.spiral([0.1, 0.5], [0.0, 1.5], [0.02, 0.4], [0.01, 0.03]);
        pen.curve([[-0.5, 0.0], [0.2, 0.3], [0.0, 0.9], [0.3, 1.0]], |t| 0.04 * t);
        pen.dot([0.55, 0.2], 0.1);
        let motif = Motif::new(&pen, 1.2, 0.1);
        for i in 0..5000 {
            let p = [(i as f32 * 0.754_877_7).fract() * 1.2 - 0.6, (i as f32 * 0.569_840_3).fract()];
            let brute = motif.strokes.iter().fold(-0.1f32, |d, s| d.max(s.inside(p)));
            assert_eq!(motif.inside(p), brute, "{p:?}");
        }
    }

    #[test]
    fn cells_repeat() {
        let mut pen = Pen::default();
        pen.dot([0.5, 0.5], 0.1);
        let motif = Motif::new(&pen, 1.0, 0.2);
        assert!((motif.inside([-0.499, 0.5]) - motif.inside([0.499, 0.5])).abs() < 1e-6);
        assert!(motif.inside([-0.5, 0.5]) > 0.099);
        assert_eq!(motif.inside([0.0, 0.5]), -0.2);
    }

    #[test]
    fn strokes_taper() {
        let s = Stroke::new([0.0, 0.0], 0.2, [1.0, 0.0], 0.1);
        assert!((s.inside([0.5, 0.0]) - 0.15).abs() < 1e-6);
        assert!((s.inside([0.5, 0.25]) + 0.1).abs() < 1e-6);
        assert!((s.inside([-0.3, 0.0]) + 0.1).abs() < 1e-6);
    }
}
