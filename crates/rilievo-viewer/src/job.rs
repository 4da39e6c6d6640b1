//! Long work beside the window.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rilievo::Progress;

use crate::subject::{Recipe, Subject};

/// How far a job is, for a bar.
#[derive(Debug, Default)]
pub struct Meter {
    stage: Mutex<String>,
    done: AtomicU64,
    total: AtomicU64,
}

impl Progress for Meter {
    fn begin(&self, stage: &str, total: u64) {
        stage.clone_into(&mut self.stage.lock().unwrap_or_else(PoisonError::into_inner));
        self.done.store(0, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    fn advance(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }
}

impl Meter {
    /// What another one has read.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn set(&self, stage: &str, share: f32) {
        self.begin(stage, 1000);
        self.advance((share.clamp(0.0, 1.0) * 1000.0) as u64);
    }

    /// What is being done, and which share of it is.
    pub fn read(&self) -> (String, f32) {
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let total = self.total.load(Ordering::Relaxed).max(1);
        (stage, self.done.load(Ordering::Relaxed) as f32 / total as f32)
    }
}

/// Where a subject is put when it is made.
pub(crate) type Made = Arc<Mutex<Option<Result<Subject, String>>>>;

/// A subject in the making.
pub struct Job {
    meter: Arc<Meter>,
    result: Made,
    #[cfg(target_arch = "wasm32")]
    hearer: Hearer,
    /// Nobody waits for what a job makes that is given up.
    #[cfg(target_arch = "wasm32")]
    _work: Option<crate::web::Work>,
}

/// Who is told that a job is done. A page begins its first one before there is anybody.
#[cfg(target_arch = "wasm32")]
type Hearer = std::rc::Rc<std::cell::RefCell<Box<dyn Fn()>>>;

impl Job {
    /// Begins to make a subject; `done` is called when it is there.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn begin(recipe: &Recipe, done: impl FnOnce() + Send + 'static) -> Self {
        let job = Self { meter: Arc::default(), result: Arc::default() };
        let (recipe, meter, result) = (recipe.clone(), Arc::clone(&job.meter), Arc::clone(&job.result));
        let work = move || {
            let made = crate::subject::make(&recipe, meter.as_ref());
            // Nothing has to be carried anywhere: what a method may ask for is made here, beside the window.
            if let Ok(Subject { tangent: Some(tangents), .. }) = &made {
                tangents.levels();
            }
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
            done();
        };
        if std::thread::Builder::new().name("making a subject".into()).spawn(work).is_err() {
            let why = "the system gives no thread to work on".to_owned();
            *job.result.lock().unwrap_or_else(PoisonError::into_inner) = Some(Err(why));
        }
        job
    }

    /// Begins to make a subject, unless the page has begun it already; `done` is called when it is there.
    #[cfg(target_arch = "wasm32")]
    pub fn begin(recipe: &Recipe, done: impl Fn() + 'static) -> Self {
        let job = crate::web::prepared(recipe).unwrap_or_else(|| Self::begin_unheard(None, recipe));
        let is_made = job.result.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        if is_made {
            done();
        }
        *job.hearer.borrow_mut() = Box::new(done);
        job
    }

    /// Begins to make a subject for somebody to come, in a worker that there is or in a new one.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn begin_unheard(worker: Option<web_sys::Worker>, recipe: &Recipe) -> Self {
        let (meter, result): (Arc<Meter>, Made) = Default::default();
        let hearer = Hearer::new(std::cell::RefCell::new(Box::new(|| ())));
        let tell = std::rc::Rc::clone(&hearer);
        let done = Box::new(move || tell.borrow()());
        let work = crate::web::begin(worker, recipe, (Arc::clone(&meter), Arc::clone(&result)), done);
        Self { meter, result, hearer, _work: work }
    }

    /// How far it is.
    pub fn meter(&self) -> &Meter {
        &self.meter
    }

    /// What came of it, once.
    pub fn take(&self) -> Option<Result<Subject, String>> {
        self.result.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}
