//! What holds for a whole frame: directions of a distant light and viewer.

/// A direction in binary angles: a full turn is 2¹⁶.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Direction {
    /// φ, from the x axis in the xy plane.
    pub azimuth: u16,
    /// θ, from the z axis, up to half a turn.
    pub polar: u16,
}

/// The vectors of a frame, for units that hold them in tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Towards the light.
    pub light: Direction,
    /// Halfway between the light and the viewer.
    pub half: Direction,
}

impl Default for Frame {
    /// A light over the viewer's shoulder; where directions do not matter, as in costs.
    fn default() -> Self {
        let deg = |degrees: u32| (degrees * 65536 / 360) as u16;
        Self {
            light: Direction { azimuth: deg(30), polar: deg(45) },
            half: Direction { azimuth: deg(30), polar: deg(22) },
        }
    }
}
