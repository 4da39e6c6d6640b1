//! What is drawn into: linear colour and depth.

use crate::color::{LinearRgb, Picture, Rgba8, srgb_decode};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::par;

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

    /// The picture, each `samples` × `samples` block of the target averaged to one pixel, as [`average_samples`] does.
    ///
    /// Light brighter than white is averaged as it is, and clipped afterwards.
    ///
    /// # Errors
    /// As [`average_samples`].
    pub fn resolve(&self, samples: u32, background: Option<LinearRgb>) -> Result<Picture> {
        average_blocks(self.size(), samples, background, |x, y| {
            let pixel = &self.pixels[(x, y)];
            (pixel.depth != NOTHING).then_some(pixel.color)
        })
    }
}

/// Each `samples` × `samples` block of a picture averaged to one pixel.
///
/// The average is taken in linear light and encoded once. Pixels without alpha count as not drawn: there the result shows
/// `background`, or is transparent by their share if there is none. All others count as opaque.
///
/// # Errors
/// [`Error::Parameter`] if `samples` does not divide the picture's size.
pub fn average_samples(picture: &Picture, samples: u32, background: Option<LinearRgb>) -> Result<Picture> {
    let decoded: Vec<f32> = (0..=u8::MAX).map(|v| srgb_decode(f32::from(v) / 255.0)).collect();
    let light = |v: u8| decoded[usize::from(v)];
    average_blocks(picture.size(), samples, background, |x, y| {
        let pixel = picture[(x, y)];
        (pixel.a != 0).then(|| LinearRgb::new(light(pixel.r), light(pixel.g), light(pixel.b)))
    })
}

/// The one place where samples become pixels; `sample` has no colour where nothing was drawn.
fn average_blocks(
    (width, height): (u32, u32),
    samples: u32,
    background: Option<LinearRgb>,
    sample: impl Fn(u32, u32) -> Option<LinearRgb> + Sync,
) -> Result<Picture> {
    if samples == 0 || width % samples != 0 || height % samples != 0 {
        return Err(Error::parameter("samples", samples, format_args!("a divisor of {width} and {height}")));
    }
    let area = (samples * samples) as f32;
    let average = |x: u32, y: u32| {
        let (mut light, mut count) = (LinearRgb::BLACK, 0.0);
        for sy in y * samples..(y + 1) * samples {
            for color in (x * samples..(x + 1) * samples).filter_map(|sx| sample(sx, sy)) {
                light += color;
                count += 1.0;
            }
        }
        match background {
            Some(color) => ((light + color * (area - count)) * (1.0 / area)).to_srgb(),
            None if count == 0.0 => Rgba8::default(),
            None => Rgba8 { a: (count / area * 255.0 + 0.5) as u8, ..(light * (1.0 / count)).to_srgb() },
        }
    };
    let mut picture = Grid::filled(width / samples, height / samples, Rgba8::default())?;
    let columns = picture.width() as usize;
    par::for_each_row(picture.texels_mut(), columns, |y, row| {
        for (x, pixel) in row.iter_mut().enumerate() {
            *pixel = average(x as u32, y as u32);
        }
    });
    Ok(picture)
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

    #[test]
    fn samples_of_a_picture_are_averaged_like_those_of_a_target() {
        let mut target = Target::new(8, 6).unwrap();
        for y in 0..6 {
            for x in (0..8).filter(|x| (x + y) % 3 != 0) {
                // Colours that eight bits hold exactly.
                let color = LinearRgb::from_srgb([x as u8 * 31, y as u8 * 40, 200]);
                target.pixels[(x, y)] = Pixel { color, depth: 0.5 };
            }
        }
        let drawn = target.resolve(1, None).unwrap();
        for background in [None, Some(LinearRgb::gray(0.3))] {
            for samples in [1, 2] {
                let averaged = average_samples(&drawn, samples, background).unwrap();
                assert_eq!(averaged, target.resolve(samples, background).unwrap());
            }
        }
        assert!(average_samples(&drawn, 4, None).is_err() && average_samples(&drawn, 0, None).is_err());
    }
}
