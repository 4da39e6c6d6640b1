//! Our own renderer, behind the same door as the others. What a frame is stands here and nowhere else.

use super::renderer::{Job, Renderer, Sampling, Shading};
use super::scene::{REPEAT, SIDE, Size, Subject, View};
use anyhow::{Context, Result, bail};
use rilievo::color::Picture;
use rilievo::raster::{self, Detail, Method, Object, Scene, Target, TextureFilter};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

pub(super) struct Ours {
    subjects: HashMap<Size, Subject>,
    target: Target,
    picture: Option<Picture>,
}

impl Ours {
    pub(super) fn new() -> Result<Self> {
        Ok(Self { subjects: HashMap::new(), target: Target::new(SIDE, SIDE)?, picture: None })
    }
}

impl Renderer for Ours {
    /// A frame is the lighting of the table where there is one, clearing, drawing, and encoding to 8-bit sRGB.
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()> {
        let subject = match self.subjects.entry(job.size) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Subject::new(job.size)?),
        };
        let (method, detail) = match job.shading {
            Shading::Exact => {
                (Method::Exact, Detail::Tangent { normals: &subject.maps.normals, repeat: REPEAT, materials: None })
            }
            Shading::Table => (Method::Table, Detail::Indexed(subject.indexed()?)),
            Shading::Normalized | Shading::Flat => bail!("{:?} is not among the library's methods", job.shading),
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
        for _ in 0..frames {
            self.target.clear();
            raster::draw(&raster::prepare(&scene, method, filter)?, &mut self.target);
            self.picture = Some(self.target.resolve(1, None)?);
        }
        Ok(())
    }

    fn picture(&mut self) -> Result<Picture> {
        self.picture.clone().context("nothing was drawn")
    }
}
