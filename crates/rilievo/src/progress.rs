//! How long work tells how far it is.

/// Hears of progress. The library draws nothing itself.
pub trait Progress: Sync {
    /// A stage begins; it will report up to `total` steps.
    fn begin(&self, stage: &str, total: u64) {
        let _ = (stage, total);
    }

    /// `steps` more are done.
    fn advance(&self, steps: u64) {
        let _ = steps;
    }
}

/// Says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {}
