//! From a subject and a look to a picture, by GPU or by CPU.

mod cpu;
mod gpu;

use std::sync::Arc;

use rilievo::MipChain;
use rilievo::light::{Material, Shade};
use rilievo::raster::{Scene, bake_light_map};
use web_time::Duration;

pub use cpu::CpuSide;
pub use gpu::GpuSide;

use crate::look::{Finish, Look, Way};
use crate::subject::Subject;

/// What one way of drawing keeps from frame to frame: the subject, its materials, and a light map if the way has one.
pub struct Set {
    subject: Arc<Subject>,
    way: Way,
    finishes: Vec<Finish>,
    colored: bool,
    materials: Vec<Material>,
    baked: Option<MipChain<Shade>>,
}

impl Set {
    /// Prepares a subject for a way of drawing; a light map is baked by the look's lamp.
    ///
    /// # Errors
    /// What the way or the subject lacks.
    pub fn new(subject: &Arc<Subject>, look: &Look, way: Way, size: (u32, u32)) -> Result<Self, String> {
        subject.can(way)?;
        if !look.suits(way) {
            return Err(format!("{} takes matte and Blinn-Phong materials", way.name()));
        }
        let mut set = Self {
            subject: Arc::clone(subject),
            way,
            finishes: look.finishes.clone(),
            colored: look.colored,
            materials: look.finishes.iter().map(Finish::material).collect(),
            baked: None,
        };
        if way == Way::Static {
            // Baked of what the exact way draws.
            let object = subject.object(Way::Exact, &set.materials, None);
            let eye = look.orbit.camera(&subject.mesh, size).map_err(told)?.eye();
            set.baked = Some(bake_light_map(&object, &look.lamp.lighting(look.mirrors()), eye).map_err(told)?);
        }
        Ok(set)
    }

    /// Whether it is still what a look asks for.
    pub fn fits(&self, subject: &Arc<Subject>, look: &Look, way: Way) -> bool {
        Arc::ptr_eq(&self.subject, subject)
            && self.way == way
            && self.finishes == look.finishes
            && self.colored == look.colored
    }

    /// The scene of a frame.
    ///
    /// # Errors
    /// If there is no camera for it.
    pub fn scene(&self, look: &Look, size: (u32, u32)) -> Result<Scene<'_>, String> {
        let mut object = self.subject.object(self.way, &self.materials, self.baked.as_ref());
        if !self.colored {
            object.base_color = None;
        }
        let camera = look.orbit.camera(&self.subject.mesh, size).map_err(told)?;
        Ok(Scene { objects: vec![object], lighting: look.lamp.lighting(look.mirrors()), camera })
    }

    /// The way it is drawn.
    pub fn way(&self) -> Way {
        self.way
    }
}

/// What a frame took.
#[derive(Debug, Clone, Copy, Default)]
pub struct Times {
    /// Lighting tables and handing them over, on this thread.
    pub table: Duration,
    /// Bytes that went to the GPU.
    pub bytes: u64,
    /// Drawing: of the GPU by its own clock if it has one, of the CPU by ours.
    pub draw: Option<Duration>,
}

fn told(error: impl std::fmt::Display) -> String {
    error.to_string()
}
