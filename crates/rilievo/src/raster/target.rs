//! What is drawn into: linear colour and depth.

use crate::color::{LinearRgb, Picture, Rgba8};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// Depth of a pixel that nothing covers.
const NOTHING: f32 = f32::INFINITY;

/// Linear colour and depth of every pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    pub(super) pixels: Grid<Pixel>,
}

/// One pixel: colour and depth side by side, because they are written together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pixel {
    pub(super) color: LinearRgb,
    /// 0 at the near plane, 1 at the far plane; [`NOTHING`] where nothing was drawn.
    pub(super) depth: f32,
}

impl Target {
    /// An empty target.
    ///
    /// # Errors
    /// [`Error::Size`] for an impossible size.
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Ok(Self { pixels: Grid::filled(width, height, Pixel { color: LinearRgb::BLACK, depth: NOTHING })? })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.pixels.size()
    }

    /// Makes it empty again.
    pub fn clear(&mut self) {
        self.pixels.texels_mut().fill(Pixel { color: LinearRgb::BLACK, depth: NOTHING });
    }

    /// Linear colour of a pixel; black where nothing was drawn.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn color(&self, x: u32, y: u32) -> LinearRgb {
        self.pixels[(x, y)].color
    }

    /// Depth of a pixel: 0 at the near plane, 1 at the far plane, `None` where nothing was drawn.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn depth(&self, x: u32, y: u32) -> Option<f32> {
        Some(self.pixels[(x, y)].depth).filter(|&d| d != NOTHING)
    }

    /// How many pixels something was drawn on.
    pub fn covered_pixels(&self) -> u64 {
        self.pixels.texels().iter().filter(|p| p.depth != NOTHING).count() as u64
    }

    /// The picture, each `samples` × `samples` block of the target averaged to one pixel.
    ///
    /// The average is taken in linear light and encoded once. Where nothing was drawn the picture shows `background`,
    /// or is transparent if there is none.
    ///
    /// # Errors
    /// [`Error::Parameter`] if `samples` does not divide the target's size.
    pub fn resolve(&self, samples: u32, background: Option<LinearRgb>) -> Result<Picture> {
        let (width, height) = self.size();
        if samples == 0 || width % samples != 0 || height % samples != 0 {
            return Err(Error::parameter("samples", samples, format_args!("a divisor of {width} and {height}")));
        }
        let area = (samples * samples) as f32;
        Grid::from_fn(width / samples, height / samples, |x, y| {
            let (mut light, mut count) = (LinearRgb::BLACK, 0.0);
            for sy in 0..samples {
                let row = &self.pixels.row(y * samples + sy)[(x * samples) as usize..][..samples as usize];
                for pixel in row.iter().filter(|p| p.depth != NOTHING) {
                    light += pixel.color;
                    count += 1.0;
                }
            }
            match background {
                Some(color) => ((light + color * (area - count)) * (1.0 / area)).to_srgb(),
                None if count == 0.0 => Rgba8::default(),
                None => Rgba8 { a: (count / area * 255.0 + 0.5) as u8, ..(light * (1.0 / count)).to_srgb() },
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resolve_averages_in_linear_light_and_keeps_coverage() {
        let mut target = Target::new(2, 2).unwrap();
        target.pixels[(0, 0)] = Pixel { color: LinearRgb::WHITE, depth: 0.5 };
        target.pixels[(1, 0)] = Pixel { color: LinearRgb::BLACK, depth: 0.5 };
        assert_eq!(target.covered_pixels(), 2);
        // Half of the light of white is 188 in sRGB, not 128.
        assert_eq!(target.resolve(2, None).unwrap()[(0, 0)], Rgba8::new(188, 188, 188, 128));
        let over_black = target.resolve(2, Some(LinearRgb::BLACK)).unwrap();
        assert_eq!(over_black[(0, 0)], Rgba8::new(137, 137, 137, 255));
        assert_eq!(target.resolve(1, None).unwrap()[(1, 1)], Rgba8::default());
        assert!(target.resolve(3, None).is_err());
    }
}
