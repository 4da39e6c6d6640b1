//! Progress bars on stderr for whatever takes longer than a second.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rilievo::Progress;

use crate::exit;

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often a bar that is shown says that it is alive.
const TICK: Duration = Duration::from_millis(200);

/// One bar per stage, from a second after the start on.
pub(crate) struct Bars {
    label: String,
    stage: Arc<Mutex<Stage>>,
    /// Ends the wait for [`PATIENCE`] when dropped.
    _waiting: Sender<()>,
}

struct Stage {
    bar: ProgressBar,
    shown: bool,
}

impl Stage {
    fn show(&mut self) {
        self.shown = true;
        self.bar.set_draw_target(ProgressDrawTarget::stderr());
        self.bar.enable_steady_tick(TICK);
    }
}

impl Bars {
    /// Bars labelled with what is worked on.
    pub(crate) fn new(label: impl Into<String>) -> Self {
        let stage = Arc::new(Mutex::new(Stage { bar: ProgressBar::hidden(), shown: false }));
        let (sender, receiver) = mpsc::channel();
        if !exit::is_quiet() {
            let stage = Arc::clone(&stage);
            // A stage may be one long step: something else has to look at the clock.
            std::thread::spawn(move || {
                if receiver.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                    lock(&stage).show();
                }
            });
        }
        Self { label: label.into(), stage, _waiting: sender }
    }

    /// Runs one step that cannot say how far it is.
    pub(crate) fn step<T>(&self, name: &str, work: impl FnOnce() -> T) -> T {
        self.begin(name, 1);
        let done = work();
        self.advance(1);
        done
    }
}

/// A poisoned bar is still a bar.
fn lock(stage: &Mutex<Stage>) -> MutexGuard<'_, Stage> {
    stage.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Progress for Bars {
    fn begin(&self, name: &str, total: u64) {
        let mut stage = lock(&self.stage);
        stage.bar.finish_and_clear();
        stage.bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        stage.bar.set_style(style());
        stage.bar.set_message(format!("{}: {name}", self.label));
        if stage.shown {
            stage.show();
        }
    }

    fn advance(&self, steps: u64) {
        lock(&self.stage).bar.inc(steps);
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        lock(&self.stage).bar.finish_and_clear();
    }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{msg} {spinner} [{bar:30}] {percent}% {eta}")
        .expect("invariant: the template is valid")
        .progress_chars("=> ")
}
