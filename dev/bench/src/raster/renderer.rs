//! What all renderers of the bench can do.

use super::scene::{Size, VIEW_COUNT};
use crate::clock::cpu_seconds;
use anyhow::Result;
use rilievo::Grid;
use rilievo::color::{Picture, Rgba8};

/// A sample draws frames for about so long, in seconds of processor time.
const SAMPLE: f64 = 0.04;
/// The most frames of one view in a sample, and so in one submission to a GPU.
const MOST_FRAMES: usize = 16;

/// What is computed for a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Shading {
    /// Frame, position and map's normal of the pixel; three normalisations.
    Exact,
    /// Light and half-way vectors of the vertices, interpolated and normalised.
    Normalized,
    /// The same vectors, interpolated quadratically: no software GPU has that.
    Quadratic,
    /// Index map and table of colours.
    Table,
    /// One colour: what all else costs.
    Flat,
}

/// How maps are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Sampling {
    Nearest,
    Bilinear,
}

/// What to draw and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Job {
    pub(super) size: Size,
    pub(super) shading: Shading,
    pub(super) sampling: Sampling,
    /// Lit from behind.
    pub(super) dark: bool,
}

impl Job {
    /// Lit from the upper left.
    pub(super) fn new(size: Size, shading: Shading, sampling: Sampling) -> Self {
        Self { size, shading, sampling, dark: false }
    }

    /// One word a field, for another process.
    pub(super) fn to_words(self) -> String {
        format!("{} {:?} {:?} {}", self.size.name(), self.shading, self.sampling, self.dark)
    }

    /// The opposite of [`Self::to_words`].
    pub(super) fn from_words(words: &[&str]) -> Option<Self> {
        let [size, shading, sampling, dark] = words else { return None };
        let size = Size::ALL.into_iter().find(|s| s.name() == *size)?;
        let shadings = [Shading::Exact, Shading::Normalized, Shading::Quadratic, Shading::Table, Shading::Flat];
        let shading = shadings.into_iter().find(|s| format!("{s:?}") == *shading)?;
        let samplings = [Sampling::Nearest, Sampling::Bilinear];
        let sampling = samplings.into_iter().find(|s| format!("{s:?}") == *sampling)?;
        Some(Self { size, shading, sampling, dark: dark.parse().ok()? })
    }
}

/// Draws the scene.
pub(super) trait Renderer {
    /// Draws some frames of a view, from clearing to finished colours, and waits for them.
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()>;

    /// The picture that was drawn last; transparent where nothing was drawn.
    fn picture(&mut self) -> Result<Picture>;

    /// Processor seconds of a frame, all threads of the process, the mean over the views. Warm: each view is drawn once
    /// before the clock starts.
    fn seconds(&mut self, job: Job) -> Result<f64> {
        let mut sum = 0.0;
        for view in 0..VIEW_COUNT {
            let start = cpu_seconds();
            self.draw(job, view, 1)?;
            let first = cpu_seconds() - start;
            let frames = ((SAMPLE / first).ceil() as usize).clamp(1, MOST_FRAMES);
            // Once more if the first had to make something: a shader, a map.
            self.draw(job, view, 1)?;
            let start = cpu_seconds();
            self.draw(job, view, frames)?;
            sum += (cpu_seconds() - start) / frames as f64;
        }
        Ok(sum / VIEW_COUNT as f64)
    }
}

/// A picture of packed pixels, red in the lowest byte.
pub(super) fn unpack(side: u32, packed: &[u32]) -> Result<Picture> {
    let pixels = packed.iter().map(|p| {
        let [r, g, b, a] = p.to_le_bytes();
        Rgba8 { r, g, b, a }
    });
    Ok(Grid::new(side, side, pixels.collect())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_back() {
        for size in Size::ALL {
            for shading in [Shading::Exact, Shading::Normalized, Shading::Quadratic, Shading::Table, Shading::Flat] {
                for sampling in [Sampling::Nearest, Sampling::Bilinear] {
                    for dark in [false, true] {
                        let job = Job { size, shading, sampling, dark };
                        let words = job.to_words();
                        assert_eq!(Job::from_words(&words.split(' ').collect::<Vec<_>>()), Some(job), "{words}");
                    }
                }
            }
        }
        assert_eq!(Job::from_words(&["288", "Exact", "Nearest"]), None);
        assert_eq!(Job::from_words(&["288", "Exact", "Nearest", "maybe"]), None);
    }

    #[test]
    fn red_is_the_lowest_byte() {
        let picture = unpack(1, &[0x8003_0201]).unwrap();
        assert_eq!(picture[(0, 0)], Rgba8 { r: 1, g: 2, b: 3, a: 0x80 });
    }
}
