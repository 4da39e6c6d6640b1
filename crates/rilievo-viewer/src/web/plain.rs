//! A viewer of one picture, drawn by the CPU: for browsers that have no GPU to give, and for pages of one's own.

use std::sync::Arc;

use rilievo::raster::TextureFilter;
use wasm_bindgen::prelude::*;

use super::page::shown;
use crate::canvas::{CpuSide, Set};
use crate::job::Job;
use crate::look::{Lamp, Look, Orbit, Way};
use crate::subject::{File, Recipe, Subject};

/// One picture and what it depends on.
#[wasm_bindgen]
pub struct Plain {
    recipe: Recipe,
    /// What the subject was made by.
    made_by: Recipe,
    subject: Option<Arc<Subject>>,
    look: Look,
    side: CpuSide,
    set: Option<Arc<Set>>,
    milliseconds: f64,
    job: Option<Job>,
    refines: bool,
}

#[wasm_bindgen]
impl Plain {
    /// Begins with what the viewer showed, if there was one on this page, else with the vase.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default, reason = "a page calls it")]
    pub fn new() -> Self {
        let (recipe, mut look) = shown().unwrap_or_else(|| {
            let look = Look {
                way: Way::Table,
                other: None,
                filter: TextureFilter::Bilinear,
                finishes: Vec::new(),
                orbit: Orbit::default(),
                lamp: Lamp::default(),
                colored: true,
            };
            (Recipe::default().preview(), look)
        });
        look.other = None;
        let side = CpuSide::default();
        Self {
            made_by: recipe.clone(),
            recipe,
            subject: None,
            look,
            side,
            set: None,
            milliseconds: 0.0,
            job: None,
            refines: false,
        }
    }

    /// Begins to make what is to be seen, instead of what is being made.
    pub fn make(&mut self) {
        // What comes is asked for by `take`.
        self.job = Some(Job::begin(&self.recipe, || ()));
        self.refines = false;
    }

    /// Takes in a file; `make` comes next.
    pub fn open(&mut self, name: String, bytes: Vec<u8>) {
        self.recipe.take_in(File { name, bytes: bytes.into() });
    }

    /// The stage of the work.
    pub fn stage(&self) -> String {
        self.progress().0
    }

    /// The share of the stage that is done.
    pub fn share(&self) -> f32 {
        self.progress().1
    }

    /// Takes what was made, if it is there, and says what went wrong with it: an empty text if nothing did.
    pub fn take(&mut self) -> Option<String> {
        let made = self.job.as_ref().and_then(Job::take)?;
        (self.job, self.refines) = (None, false);
        match made {
            Ok(subject) => {
                let finishes = subject.finishes();
                if self.look.finishes.len() != finishes.len() {
                    self.look.finishes = finishes;
                }
                self.made_by = self.recipe.clone();
                self.subject = Some(Arc::new(subject));
                if let Some(refined) = self.recipe.refined() {
                    self.recipe = refined;
                    self.make();
                    self.refines = true;
                }
                Some(String::new())
            }
            Err(why) => {
                self.recipe = self.made_by.clone();
                Some(why)
            }
        }
    }

    /// Whether what is seen is being made in more detail.
    pub fn refines(&self) -> bool {
        self.refines
    }

    /// Moves the eye, in radians.
    pub fn turn(&mut self, across: f32, up: f32) {
        self.look.orbit.turn(across, up);
    }

    /// Moves the light, in radians.
    pub fn light(&mut self, across: f32, up: f32) {
        self.look.lamp.turn(across, up);
    }

    /// Comes nearer by a factor.
    pub fn zoom(&mut self, factor: f32) {
        self.look.orbit.zoom(factor);
    }

    /// Chooses a way by its name.
    pub fn way(&mut self, name: &str) {
        if let Some(way) = Way::ALL.into_iter().find(|way| way.name() == name) {
            self.look.way = way;
        }
    }

    /// The way that was chosen.
    pub fn chosen(&self) -> String {
        self.look.way.name().to_owned()
    }

    /// The names of the ways that the subject can be drawn in.
    pub fn ways(&self) -> Vec<String> {
        let can = |way: &Way| {
            CpuSide::differs(*way)
                && self.subject.as_ref().is_some_and(|s| s.can(*way).is_ok())
                && self.look.suits(*way)
        };
        Way::ALL.into_iter().filter(can).map(|way| way.name().to_owned()).collect()
    }

    /// Draws a frame: red, green, blue and alpha of all pixels.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn draw(&mut self, width: u32, height: u32) -> Result<Vec<u8>, String> {
        let subject = self.subject.clone().ok_or("nothing was made yet")?;
        let size = (width.max(1), height.max(1));
        let known = self.set.take().filter(|set| set.fits(&subject, &self.look, self.look.way));
        let set = match known {
            Some(set) => set,
            None => Arc::new(Set::new(&subject, &self.look, self.look.way, size)?),
        };
        self.set = Some(Arc::clone(&set));
        let times = self.side.draw(&set, &self.look, size)?;
        self.milliseconds = times.draw.map_or(0.0, |t| t.as_secs_f64() * 1e3);
        let picture = self.side.picture().ok_or("nothing was drawn")?;
        Ok(bytemuck::cast_slice(picture.texels()).to_vec())
    }

    /// What the last frame took.
    pub fn milliseconds(&self) -> f64 {
        self.milliseconds
    }
}

impl Plain {
    fn progress(&self) -> (String, f32) {
        self.job.as_ref().map(|job| job.meter().read()).unwrap_or_default()
    }
}
