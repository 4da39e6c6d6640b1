//! Drawing on the CPU.

use std::sync::Arc;

use rilievo::color::Picture;
use rilievo::raster::tile::{Options, Renderer, empty_picture};
use self_cell::self_cell;
use web_time::Instant;

use super::{Set, Times, told};
use crate::look::{Look, Way};

type TileRenderer<'a> = Renderer<'a>;

self_cell! {
    /// A renderer, and the set whose maps it keeps.
    struct Prepared {
        owner: Arc<Set>,
        #[not_covariant]
        dependent: TileRenderer,
    }
}

/// One picture on the CPU.
#[derive(Default)]
pub struct CpuSide {
    prepared: Option<Prepared>,
    picture: Option<Picture>,
}

impl CpuSide {
    /// Draws a frame.
    ///
    /// # Errors
    /// What is wrong with the scene or the size.
    pub fn draw(&mut self, set: &Arc<Set>, look: &Look, size: (u32, u32)) -> Result<Times, String> {
        let known = self.prepared.take().filter(|p| Arc::ptr_eq(p.borrow_owner(), set));
        let prepared = known.unwrap_or_else(|| Prepared::new(Arc::clone(set), |_| Renderer::new()));
        let prepared = self.prepared.insert(prepared);
        let picture = match self.picture.take() {
            Some(picture) if picture.size() == size => picture,
            _ => empty_picture(size.0, size.1).map_err(told)?,
        };
        let picture = self.picture.insert(picture);
        let start = Instant::now();
        prepared.with_dependent_mut(|set, renderer| -> Result<(), String> {
            let scene = set.scene(look, size)?;
            let options = Options { method: set.way().method(), filter: look.filter, ..Options::default() };
            renderer.draw(&scene, &options, picture).map_err(told)?;
            Ok(())
        })?;
        Ok(Times { draw: Some(start.elapsed()), ..Times::default() })
    }

    /// The picture that was drawn last.
    pub fn picture(&self) -> Option<&Picture> {
        self.picture.as_ref()
    }

    /// Whether a way is another one here: without a GPU there is nothing to expand for.
    pub fn differs(way: Way) -> bool {
        way != Way::Expanded
    }
}
