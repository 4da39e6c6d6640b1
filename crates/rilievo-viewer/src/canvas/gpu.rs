//! Drawing on the GPU.

use std::sync::Arc;

use rilievo::color::Picture;
use rilievo::raster::TextureFilter;
use rilievo_gpu::{Loaded, Renderer, Target};
use web_time::{Duration, Instant};

use super::{Set, Times, told};
use crate::look::Look;

/// One picture on the GPU.
#[derive(Default)]
pub struct GpuSide {
    loaded: Option<(Arc<Set>, TextureFilter, Loaded)>,
    target: Option<Target>,
}

impl GpuSide {
    /// Draws a frame; whether the target is a new one comes back with what it took.
    ///
    /// # Errors
    /// What the GPU cannot do, for the user.
    pub fn draw(
        &mut self,
        renderer: &Renderer,
        set: &Arc<Set>,
        look: &Look,
        size: (u32, u32),
    ) -> Result<(Times, bool), rilievo_gpu::Error> {
        let scene = set.scene(look, size).map_err(rilievo_gpu::Error::Device)?;
        let is_new = self.target.as_ref().is_none_or(|t| t.size() != size);
        let target = match self.target.take() {
            Some(target) if !is_new => target,
            _ => Target::new(renderer.gpu(), size)?,
        };
        let target = self.target.insert(target);
        let known = self.loaded.take().filter(|(s, filter, _)| Arc::ptr_eq(s, set) && *filter == look.filter);
        let loaded = match known {
            Some(known) => known,
            None => {
                let loaded = renderer.load(&scene, set.way().gpu_method(), look.filter)?;
                (Arc::clone(set), look.filter, loaded)
            }
        };
        let (.., loaded) = self.loaded.insert(loaded);
        let start = Instant::now();
        let uploaded = renderer.update(loaded, &scene, size)?;
        let table = start.elapsed();
        renderer.draw(loaded, target, None);
        Ok((Times { table, bytes: uploaded.bytes, draw: renderer.draw_time(loaded) }, is_new))
    }

    /// How long the GPU drew, as far as it has told.
    pub fn draw_time(&self, renderer: &Renderer) -> Option<Duration> {
        self.loaded.as_ref().and_then(|(.., loaded)| renderer.draw_time(loaded))
    }

    /// What was drawn into.
    pub fn target(&self) -> Option<&Target> {
        self.target.as_ref()
    }

    /// The picture that was drawn last.
    ///
    /// # Errors
    /// If there is none, or the device fails.
    pub async fn picture(&self) -> Result<Picture, String> {
        let target = self.target.as_ref().ok_or("nothing was drawn yet")?;
        target.read().await.map_err(told)
    }
}
