//! Frames that are timed: by the tile renderer, texels filtered bilinearly.

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::raster::tile::{Options, Renderer, empty_picture};
use rilievo::raster::{Method, Scene, TextureFilter};

/// A picture, and who draws into it.
pub(crate) struct Easel<'a> {
    renderer: Renderer<'a>,
    picture: Picture,
}

impl<'a> Easel<'a> {
    /// A square picture.
    pub(crate) fn new(side: u32) -> Result<Self> {
        Ok(Self { renderer: Renderer::new(), picture: empty_picture(side.max(1), side.max(1))? })
    }

    /// Draws a frame; returns how many pixels it covers.
    pub(crate) fn draw(&mut self, scene: &Scene<'a>, method: Method) -> Result<u64> {
        let options = Options { method, filter: TextureFilter::Bilinear, ..Options::default() };
        Ok(self.renderer.draw(scene, &options, &mut self.picture)?.covered_pixels)
    }
}
