//! Our own renderer, behind the same door as the others. What a frame is stands here and nowhere else.

use super::renderer::{Job, Renderer, Sampling, Shading};
use super::scene::{REPEAT, SIDE, Subject, View};
use anyhow::{Result, bail};
use rilievo::Grid;
use rilievo::color::{Picture, Rgba8};
use rilievo::raster::tile::{Options, Renderer as Tiles};
use rilievo::raster::vectors::{Midpoints, Order};
use rilievo::raster::{Detail, Method, Object, Scene, TextureFilter};

pub(super) struct Ours {
    tiles: Tiles<'static>,
    picture: Picture,
}

impl Ours {
    pub(super) fn new() -> Result<Self> {
        Ok(Self { tiles: Tiles::new(), picture: Grid::filled(SIDE, SIDE, Rgba8::default())? })
    }
}

impl Renderer for Ours {
    /// A frame is the lighting of the table where there is one, and drawing all over a picture of 8-bit colours.
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()> {
        let subject = Subject::get(job.size)?;
        let tangent = Detail::Tangent { normals: &subject.maps.normals, repeat: REPEAT, materials: None };
        let quadratic = Method::Quadratic { midpoints: Midpoints::default(), order: Order::default() };
        let (method, detail) = match job.shading {
            Shading::Exact => (Method::Exact, tangent),
            Shading::Normalized => (Method::Normalized, tangent),
            Shading::Quadratic => (quadratic, tangent),
            Shading::Table => (Method::Table, Detail::Indexed(subject.indexed()?)),
            Shading::Flat => bail!("{:?} is not among the library's methods", job.shading),
        };
        let filter = match job.sampling {
            Sampling::Nearest => TextureFilter::Nearest,
            Sampling::Bilinear => TextureFilter::Bilinear,
        };
        let view = View::new(view)?;
        let view = if job.dark { view.dark() } else { view };
        let scene = Scene {
            objects: vec![Object::new(&subject.mesh, detail, &subject.materials)],
            lighting: view.lighting(),
            camera: view.camera,
        };
        let options = Options { method, filter, ..Options::default() };
        for _ in 0..frames {
            self.tiles.draw(&scene, &options, &mut self.picture)?;
        }
        Ok(())
    }

    fn picture(&mut self) -> Result<Picture> {
        Ok(self.picture.clone())
    }
}
