//! What is painted where along the silhouette: stripes, friezes and raised rings, from the mouth to the foot.

use super::handle;
use super::meander;
use super::ornament::{self, Ornament};
use super::profile::Profile;
use super::stroke::Motif;
use crate::sample::noise::smoothstep;

/// Length of the map's width on the vase: once around the widest place.
pub(super) fn circumference() -> f32 {
    std::f32::consts::TAU * 0.6285
}

/// Length of the map's height on the vase: the silhouette and the strip of the handles.
pub(super) fn map_length() -> f32 {
    Profile::get().length() + handle::STRIP
}

/// What lies under the ornament.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ground {
    Clay,
    Glaze,
    /// Glaze with added purple-red.
    Red,
}

/// The ornament of a frieze.
pub(super) enum Pattern {
    /// Figure and engraved lines of one cell.
    Strokes {
        figure: Motif,
        engraving: Motif,
    },
    Meander,
}

/// A repeated ornament on a zone.
pub(super) struct Frieze {
    pub(super) pattern: Pattern,
    /// Cells around the vase.
    pub(super) repeats: u32,
    /// Every second cell is red.
    pub(super) red_turns: bool,
    /// Length from its lower to its upper edge.
    pub(super) height: f32,
}

/// A ring of the vase from map length `from` to `to`.
pub(super) struct Zone {
    pub(super) from: f32,
    pub(super) to: f32,
    pub(super) ground: Ground,
    pub(super) frieze: Option<Frieze>,
}

/// A raised ring.
struct Ridge {
    at: f32,
    half: f32,
    height: f32,
}

/// The whole plan.
pub(super) struct Layout {
    zones: Vec<Zone>,
    ridges: Vec<Ridge>,
    cursor: f32,
    /// Distances are known up to here; beyond, only their sign.
    reach: f32,
}

/// Width of a thin painted line.
const LINE: f32 = 0.0085;

impl Layout {
    /// The plan; distances are exact up to `reach`.
    pub(super) fn new(reach: f32) -> Self {
        use Ground::{Clay, Glaze, Red};
        let p = Profile::get();
        let mut l = Self { zones: Vec::new(), ridges: Vec::new(), cursor: 0.0, reach };
        // Mouth and lip: black, with a reserved line below.
        l.until(p.end(3) - 0.022, Glaze);
        l.stripe(0.014, Clay);
        l.stripe(0.010, Glaze);
        // Neck.
        l.stripe(0.010, Clay);
        l.stripe(LINE, Glaze);
        let frieze = p.end(4) - l.cursor - 0.052;
        l.strokes(frieze, Clay, 5, ornament::palmette_lotus_chain);
        l.stripe(LINE, Glaze);
        l.stripe(0.010, Clay);
        l.stripe(0.008, Glaze);
        l.until(p.end(4), Red);
        // On the neck, not over the crease below it, where the normals of two surfaces meet.
        l.ridge(p.end(4) - 0.015, 0.015, 0.012);
        // Shoulder: tongues, then the meander between double lines.
        l.stripe(0.008, Glaze);
        l.strokes(0.125, Clay, 40, ornament::tongue);
        l.last_frieze(|f| f.red_turns = true);
        l.double_line();
        l.meander(0.104, 7);
        l.double_line();
        // The main frieze, reserved in black.
        l.stripe(0.012, Glaze);
        l.strokes(0.63, Glaze, 6, ornament::lyre_frieze);
        l.stripe(0.012, Glaze);
        // Below: running spirals, a black zone with red lines, rays.
        l.double_line();
        l.strokes(0.078, Clay, 30, ornament::running_spiral);
        l.double_line();
        l.stripe(0.045, Glaze);
        l.stripe(0.012, Red);
        l.stripe(0.014, Glaze);
        l.stripe(0.012, Red);
        l.stripe(0.035, Glaze);
        l.stripe(LINE, Clay);
        l.stripe(LINE, Glaze);
        let rays = p.end(6) - l.cursor - 0.055;
        // As many as the default mesh has segments: on a tapering body each then falls on faces in the same way.
        l.strokes(rays, Clay, 24, ornament::ray);
        l.stripe(LINE, Glaze);
        l.stripe(0.010, Clay);
        // Stem and foot.
        l.stripe(0.010, Glaze);
        l.until(p.end(6), Red);
        l.ridge(p.end(6) - 0.014, 0.014, 0.011);
        l.until(p.end(8) - 0.020, Glaze);
        l.until(p.length() + 1.0, Clay);
        l
    }

    /// Index of the zone at map length `s`.
    fn zone_index(&self, s: f32) -> usize {
        self.zones.partition_point(|z| z.to <= s).min(self.zones.len() - 1)
    }

    /// The zone at map length `s`.
    pub(super) fn zone(&self, s: f32) -> &Zone {
        &self.zones[self.zone_index(s)]
    }

    /// Signed distance to the black ground at map length `s`, positive inside, clamped to ± reach.
    pub(super) fn black(&self, s: f32) -> f32 {
        let i = self.zone_index(s);
        let is_black = |k: usize| self.zones[k].ground != Ground::Clay;
        let same = |k: &usize| is_black(*k) == is_black(i);
        let from = (0..=i).rev().take_while(same).last().map_or(s, |k| self.zones[k].from);
        let to = (i..self.zones.len()).take_while(same).last().map_or(s, |k| self.zones[k].to);
        // The map's ends are no edges.
        let above = if from <= 0.0 { self.reach } else { s - from };
        let distance = above.min(to - s).min(self.reach);
        if is_black(i) { distance } else { -distance }
    }

    /// Height of the raised rings at map length `s`.
    pub(super) fn relief(&self, s: f32) -> f32 {
        let of = |r: &Ridge| r.height * smoothstep(1.0, 0.15, ((s - r.at) / r.half).abs());
        self.ridges.iter().map(of).sum()
    }

    fn push(&mut self, to: f32, ground: Ground, frieze: Option<Frieze>) {
        self.zones.push(Zone { from: self.cursor, to, ground, frieze });
        self.cursor = to;
    }

    fn until(&mut self, to: f32, ground: Ground) {
        self.push(to, ground, None);
    }

    fn stripe(&mut self, length: f32, ground: Ground) {
        self.push(self.cursor + length, ground, None);
    }

    fn double_line(&mut self) {
        self.stripe(LINE, Ground::Glaze);
        self.stripe(0.009, Ground::Clay);
        self.stripe(LINE, Ground::Glaze);
    }

    fn ridge(&mut self, at: f32, half: f32, height: f32) {
        self.ridges.push(Ridge { at, half, height });
    }

    /// A frieze of `height` with `repeats` cells; `draw` gets the cell's width in heights, at the frieze's middle.
    fn strokes(&mut self, height: f32, ground: Ground, repeats: u32, draw: impl Fn(f32) -> Ornament) {
        let radius = Profile::get().at(self.cursor + 0.5 * height).radius;
        let width = std::f32::consts::TAU * radius / (repeats as f32 * height);
        let ornament = draw(width);
        let reach = self.reach / height;
        let pattern = Pattern::Strokes {
            figure: Motif::new(&ornament.figure, width, reach),
            engraving: Motif::new(&ornament.engraving, width, reach),
        };
        let frieze = Frieze { pattern, repeats, red_turns: false, height };
        self.push(self.cursor + height, ground, Some(frieze));
    }

    fn last_frieze(&mut self, change: impl FnOnce(&mut Frieze)) {
        if let Some(frieze) = self.zones.last_mut().and_then(|z| z.frieze.as_mut()) {
            change(frieze);
        }
    }

    /// A meander of line height `height` on clay with a gap above and below.
    fn meander(&mut self, height: f32, repeats: u32) {
        let gap = 0.011;
        self.stripe(gap, Ground::Clay);
        let frieze = Frieze { pattern: Pattern::Meander, repeats, red_turns: false, height };
        self.push(self.cursor + height, Ground::Clay, Some(frieze));
        self.stripe(gap, Ground::Clay);
    }
}

/// What a frieze says of one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    /// Signed distance to the figure, positive inside.
    pub(super) figure: f32,
    /// Signed distance to the engraved lines, positive inside.
    pub(super) engraving: f32,
    /// In a red cell.
    pub(super) red: bool,
}

impl Frieze {
    /// At `u` around and `up` above the frieze's lower edge.
    pub(super) fn draw(&self, u: f32, up: f32, reach: f32) -> Drawn {
        // Half a cell is added so that the middle of a cell faces +Z (u = 1/2) for any number of cells.
        let cell = u * self.repeats as f32 + if self.repeats.is_multiple_of(2) { 0.5 } else { 0.0 };
        let x = cell - cell.floor();
        match &self.pattern {
            Pattern::Strokes { figure, engraving } => {
                let p = [(x - 0.5) * figure.width(), up / self.height];
                let red = self.red_turns && !(cell.floor() as u32).is_multiple_of(2);
                Drawn { figure: figure.inside(p) * self.height, engraving: engraving.inside(p) * self.height, red }
            }
            Pattern::Meander => {
                let unit = self.height / meander::HEIGHT;
                let figure = meander::inside(x * meander::WIDTH, up / unit) * unit;
                Drawn { figure: figure.max(-reach), engraving: -reach, red: false }
            }
        }
    }
}
