//! Progress bars on stderr for whatever takes longer than a second.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rilievo::Progress;

use crate::exit;

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// One bar per stage.
pub(crate) struct Bars {
    started: Instant,
    label: String,
    bar: Mutex<Stage>,
}

struct Stage {
    bar: ProgressBar,
    shown: bool,
}

impl Bars {
    /// Bars labelled with what is worked on.
    pub(crate) fn new(label: impl Into<String>) -> Self {
        let stage = Stage { bar: ProgressBar::hidden(), shown: false };
        Self { started: Instant::now(), label: label.into(), bar: Mutex::new(stage) }
    }

    fn with_stage(&self, f: impl FnOnce(&mut Stage)) {
        // A poisoned bar is still a bar.
        f(&mut self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
    }
}

impl Progress for Bars {
    fn begin(&self, stage: &str, total: u64) {
        let message = format!("{}: {stage}", self.label);
        self.with_stage(|s| {
            s.bar.finish_and_clear();
            s.bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
            s.bar.set_style(style());
            s.bar.set_message(message);
            s.shown = false;
        });
    }

    fn advance(&self, steps: u64) {
        self.with_stage(|s| {
            if !s.shown && !exit::is_quiet() && self.started.elapsed() > PATIENCE {
                s.bar.set_draw_target(ProgressDrawTarget::stderr());
                s.shown = true;
            }
            s.bar.inc(steps);
        });
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        self.with_stage(|s| s.bar.finish_and_clear());
    }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{msg} [{bar:30}] {percent}% {eta}")
        .expect("invariant: the template is valid")
        .progress_chars("=> ")
}
