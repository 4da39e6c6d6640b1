//! The two renderers behind one door: the fast one, kept over all frames, and the reference.

use std::time::Instant;

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::raster::tile::{self, Renderer, Samples, Skipped, empty_picture};
use rilievo::raster::{self, Scene, Target, average_samples};

use crate::exit::usage;
use crate::scene::PictureSpec;

/// Draws frame after frame.
pub(crate) struct Painter<'a> {
    spec: &'a PictureSpec,
    brush: Brush<'a>,
    /// How long the fast renderer took to make the maps its own, once it has seen them.
    map_seconds: Option<f64>,
}

enum Brush<'a> {
    /// The renderer knows the maps from the frames before.
    Tiles {
        renderer: Box<Renderer<'a>>,
        samples: Picture,
    },
    Reference(Target),
}

/// A frame and what it took.
pub(crate) struct Painting {
    pub(crate) picture: Picture,
    /// Pixels of the picture that something was drawn on.
    pub(crate) covered_pixels: u64,
    /// Triangles that were left out; the reference renderer does not tell.
    pub(crate) skipped: Option<Skipped>,
    /// All of the frame, without averaging samples.
    pub(crate) seconds: f64,
    /// Making ready: lighting the tables of all objects. Part of `seconds`.
    pub(crate) table_seconds: f64,
}

/// Refuses pictures that cannot be drawn, before anything is read or allocated.
///
/// # Errors
/// A usage error that names the limit.
pub(crate) fn check_size(spec: &PictureSpec) -> Result<()> {
    let (width, height) = sample_size(spec);
    let max = tile::MAX_SIDE;
    if width.max(height) > max {
        let (w, h, n) = (spec.size.width, spec.size.height, spec.samples);
        let with = if n > 1 { format!(" with {n} x {n} samples a pixel") } else { String::new() };
        return Err(usage(format!(
            "a picture of {w} x {h}{with} is drawn {width} x {height} pixels large, and {max} a side is the limit"
        )));
    }
    if spec.antialias && (spec.samples > 1 || spec.reference) {
        let why = if spec.reference {
            "the reference renderer has no such samples"
        } else {
            "its samples smooth outlines already"
        };
        return Err(usage(format!(
            "--antialias goes without {}: {why}",
            if spec.reference { "--reference" } else { "--supersample" }
        )));
    }
    rilievo::grid::check_size(width.into(), height.into())?;
    Ok(())
}

fn sample_size(spec: &PictureSpec) -> (u32, u32) {
    (spec.size.width.saturating_mul(spec.samples), spec.size.height.saturating_mul(spec.samples))
}

impl<'a> Painter<'a> {
    /// A painter of such pictures.
    pub(crate) fn new(spec: &'a PictureSpec) -> Result<Self> {
        check_size(spec)?;
        let (width, height) = sample_size(spec);
        let brush = if spec.reference {
            Brush::Reference(Target::new(width, height)?)
        } else {
            Brush::Tiles { renderer: Box::default(), samples: empty_picture(width, height)? }
        };
        Ok(Self { spec, brush, map_seconds: None })
    }

    /// How long the maps took to be brought into the form the fast renderer reads, which it does once for all frames.
    pub(crate) fn map_seconds(&self) -> Option<f64> {
        self.map_seconds
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// Those of the renderers: an object that lacks what the method needs.
    pub(crate) fn paint(&mut self, scene: &Scene<'a>) -> Result<Painting> {
        let spec = self.spec;
        let (method, filter) = (spec.method(), spec.filter());
        let area = u64::from(spec.samples).pow(2);
        let started = Instant::now();
        let frame = raster::prepare(scene, method, filter)?;
        let table_seconds = started.elapsed().as_secs_f64();
        match &mut self.brush {
            Brush::Reference(target) => {
                target.clear();
                raster::draw(&frame, target);
                let seconds = started.elapsed().as_secs_f64();
                let picture = target.resolve(spec.samples, spec.background)?;
                let covered_pixels = target.covered_pixels() / area;
                Ok(Painting { picture, covered_pixels, skipped: None, seconds, table_seconds })
            }
            Brush::Tiles { renderer, samples } => {
                // The renderer makes its own tables and does not tell how long it takes: the same was done above only to
                // see the clock, and does not count twice.
                drop(frame);
                let background = spec.background.filter(|_| spec.samples == 1);
                let samples_in_pixel = if spec.antialias { Samples::Four } else { Samples::One };
                let options = tile::Options { method, filter, samples: samples_in_pixel, background };
                if self.map_seconds.is_none() {
                    // On a picture of one pixel there is nothing else to do.
                    let started = Instant::now();
                    renderer.draw(scene, &options, &mut empty_picture(1, 1)?)?;
                    self.map_seconds = Some(started.elapsed().as_secs_f64());
                }
                let started = Instant::now();
                let drawn = renderer.draw(scene, &options, samples)?;
                let seconds = started.elapsed().as_secs_f64();
                let picture = if spec.samples == 1 {
                    samples.clone()
                } else {
                    average_samples(samples, spec.samples, spec.background)?
                };
                let covered_pixels = drawn.covered_pixels / area;
                Ok(Painting { picture, covered_pixels, skipped: Some(drawn.skipped), seconds, table_seconds })
            }
        }
    }
}
