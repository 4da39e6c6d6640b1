//! The ornaments of the friezes, drawn in cells of height 1.

use super::stroke::{Pen, Point, cubic};
use crate::sample::turn;

/// A figure and the lines engraved into it.
#[derive(Debug, Clone, Default)]
pub(super) struct Ornament {
    /// The painted or reserved figure.
    pub(super) figure: Pen,
    /// Engraved lines.
    pub(super) engraving: Pen,
}

impl Ornament {
    fn stamp(&mut self, other: &Self, origin: Point, scale: f32, hanging: bool) {
        self.figure.stamp(&other.figure, origin, scale, hanging);
        self.engraving.stamp(&other.engraving, origin, scale, hanging);
    }

    fn mirror(&mut self) {
        self.figure.mirror();
        self.engraving.mirror();
    }

    /// A leaf along a curve: pointed at both ends, with an engraved rib.
    fn leaf(&mut self, way: [Point; 4], half: f32) {
        self.figure.curve(way, |t| half * (4.0 * t * (1.0 - t)).max(0.0).sqrt());
        self.engraving.sweep(8, |t| cubic(way, 0.15 + 0.6 * t), |t| half * 0.14 * (1.0 - 0.5 * t));
    }
}

/// A fan of `2 · side + 1` drop-shaped petals over a heart; its base is the origin, its height 1.
///
/// `spread` is the angle between neighbouring petals in radians, `droop` how much shorter the outermost are.
pub(super) fn palmette(side: u32, spread: f32, droop: f32) -> Ornament {
    let mut o = Ornament::default();
    for k in 0..=side {
        let outward = k as f32 / side as f32;
        let angle = k as f32 * spread;
        let reach = 1.0 - droop * 0.5 * outward * (1.0 + outward);
        // Petals would touch where their round ends are widest; 2.6 instead of 2 leaves the gap between them.
        let round = reach * spread / (2.6 + spread);
        let dir = |angle: f32, r: f32| {
            let (sin, cos) = turn::sin_cos(f64::from(angle) / std::f64::consts::TAU);
            [r * sin, 0.1 + (r - 0.1) * cos]
        };
        // Petals rise before they bend outward: the fan of a flame, not of a wheel.
        let way = [
            dir(angle * 0.9, 0.2),
            dir(angle * 0.93, 0.4 * reach),
            dir(angle * 0.96, 0.72 * reach),
            dir(angle * 1.03, reach - round),
        ];
        o.figure.sweep(8, |t| cubic(way, t), |t| 0.014 + (round - 0.014) * t * (0.7 + 0.3 * t));
        o.engraving.sweep(6, |t| cubic(way, 0.35 + 0.6 * t), |t| 0.007 + 0.005 * t);
    }
    // The heart; it must not reach the petals.
    o.figure.line([0.0, 0.05], 0.072, [0.0, 0.12], 0.03);
    o.mirror();
    o
}

/// A lotus flower: two sepals that bend outward, three petals between; base in the origin, height about 1.
pub(super) fn lotus() -> Ornament {
    let mut o = Ornament::default();
    o.leaf([[0.03, 0.02], [0.05, 0.45], [0.16, 0.72], [0.42, 0.92]], 0.105);
    o.leaf([[0.03, 0.28], [0.06, 0.55], [0.12, 0.75], [0.23, 0.98]], 0.062);
    o.figure.line([0.0, 0.02], 0.06, [0.05, 0.05], 0.03);
    o.mirror();
    o.leaf([[0.0, 0.30], [0.0, 0.5], [0.0, 0.8], [0.0, 1.06]], 0.068);
    o
}

/// Palmettes and lotus flowers in turn, tied by arcs: the neck.
pub(super) fn palmette_lotus_chain(width: f32) -> Ornament {
    let mut o = Ornament::default();
    let half = width / 2.0;
    o.stamp(&palmette(4, 0.38, 0.56), [0.0, 0.20], 0.75, false);
    o.stamp(&lotus(), [half, 0.20], 0.70, false);
    // Arcs from bud to bud below, with a bead where they meet.
    let mut arcs = Ornament::default();
    arcs.figure.curve([[0.0, 0.17], [half * 0.25, -0.01], [half * 0.75, -0.01], [half, 0.17]], |_| 0.022);
    arcs.figure.dot([half * 0.5, 0.155], 0.034);
    arcs.mirror();
    o.figure.stamp(&arcs.figure, [0.0, 0.0], 1.0, false);
    o
}

/// The main frieze: great palmettes on volutes, each in a lyre of tendrils; small palmettes and buds between.
pub(super) fn lyre_frieze(width: f32) -> Ornament {
    let mut o = Ornament::default();
    let half = width / 2.0;
    let line = 0.0155;
    // Right half of the lyre: a volute that runs out into the tendril around the palmette.
    let centre = [0.165, 0.175];
    o.figure.spiral(centre, [-2.25, -0.25], [0.018, 0.118], [0.012, line]);
    o.figure.dot(centre, 0.026);
    let foot = [centre[0], centre[1] - 0.118];
    let side = [half * 0.855, 0.50];
    o.figure.curve([foot, [0.30, foot[1]], [half * 0.855, 0.22], side], |_| line);
    o.figure.curve([side, [half * 0.855, 0.78], [0.27, 0.955], [0.0, 0.955]], |_| line);
    // A tendril curls off into the gap and carries a leaf.
    o.figure.curve([[half * 0.80, 0.265], [half * 0.84, 0.36], [half * 0.97, 0.33], [half, 0.42]], |t| {
        line * (0.9 - 0.3 * t)
    });
    o.mirror();
    // Between the volutes: binding, drop and heart.
    o.figure.line([-0.05, 0.235], 0.018, [0.05, 0.235], 0.018);
    o.figure.line([0.0, 0.175], 0.026, [0.0, 0.07], 0.006);
    o.stamp(&palmette(5, 0.315, 0.46), [0.0, 0.288], 0.58, false);
    // Between the lyres: a hanging palmette, a standing one, and a leaf.
    let small = palmette(3, 0.43, 0.32);
    o.stamp(&small, [half, 0.985], 0.265, true);
    o.stamp(&small, [half, 0.02], 0.245, false);
    o.leaf([[half, 0.37], [half, 0.45], [half, 0.53], [half, 0.635]], 0.036);
    o.figure.dot([half, 0.668], 0.020);
    o
}

/// A running spiral (running dog).
pub(super) fn running_spiral(width: f32) -> Ornament {
    let mut o = Ornament::default();
    let half = width / 2.0;
    let centre = [0.0, 0.50];
    o.figure.spiral(centre, [-1.6, -0.25], [0.06, 0.36], [0.05, 0.075]);
    o.figure.dot(centre, 0.10);
    let start = [0.0, 0.14];
    o.figure.curve([start, [half * 0.9, 0.12], [half * 0.6, 0.88], [width - 0.36 * 0.6, 0.80]], |_| 0.075);
    o
}

/// One upright tongue.
pub(super) fn tongue(width: f32) -> Ornament {
    let mut o = Ornament::default();
    let half = width * 0.36;
    o.figure.line([0.0, 1.2], half, [0.0, 0.10 + half], half);
    // The outline runs round it at a small distance, between neighbours.
    o.engraving.line([0.0, 1.2], width * 0.05, [0.0, 0.14 + half], width * 0.05);
    o
}

/// A ray: a pointed leaf with straight sides that rises from the foot.
pub(super) fn ray(width: f32) -> Ornament {
    let mut o = Ornament::default();
    o.figure.line([0.0, -0.05], width * 0.47, [0.0, 0.95], 0.006);
    o.engraving.line([0.0, 0.05], width * 0.035, [0.0, 0.62], width * 0.012);
    o
}
