//! What is laid on a shape: heights and colours.

use crate::color::LinearRgb;
use crate::height::HeightMap;
use crate::{Grid, Result, Rgba8, par};

/// Heights and colours of one size, to lay on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Covering {
    /// Heights of 0 … 1 and their depth, as a share of the map's width.
    pub height: HeightMap,
    /// sRGB base colour, opaque.
    pub color: Grid<Rgba8>,
}

impl Covering {
    /// Asks for height and colour (in linear light) at the middle of each texel, across and down in 0 … 1. Heights outside
    /// 0 … 1 are cut off.
    pub(super) fn paint(
        (width, height): (u32, u32),
        depth: f32,
        texel: impl Fn(f32, f32) -> (f32, LinearRgb) + Sync,
    ) -> Result<Self> {
        let mut texels = Grid::filled(width, height, (0.0, LinearRgb::BLACK))?;
        let middle = |at: usize, side: u32| (at as f32 + 0.5) / side as f32;
        par::for_each_row(texels.texels_mut(), width as usize, |y, row| {
            for (x, out) in row.iter_mut().enumerate() {
                *out = texel(middle(x, width), middle(y, height));
            }
        });
        let heights = texels.map(|(height, _)| height.clamp(0.0, 1.0));
        Ok(Self { height: HeightMap::new(heights, depth)?, color: texels.map(|(_, color)| color.to_srgb()) })
    }
}

/// `a` at 0, `b` at 1.
pub(super) fn blend(a: LinearRgb, b: LinearRgb, t: f32) -> LinearRgb {
    a * (1.0 - t) + b * t
}

/// The whole part and the rest of what is not negative.
pub(super) fn whole(x: f32) -> (u32, f32) {
    let whole = x as u32;
    (whole, x - whole as f32)
}
