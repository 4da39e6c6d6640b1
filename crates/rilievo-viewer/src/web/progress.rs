//! How far the work is, in an element of the page and not in the viewer's own picture: where the GPU is software, a
//! frame of that costs as much as a tenth of the work.

use std::cell::Cell;

use web_time::{Duration, Instant};

use super::element;
use crate::job::Meter;

/// How often a share changes. It is seen to move, and little is taken from the work.
const PACE: Duration = Duration::from_millis(300);

thread_local! {
    static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
}

/// Shows how far a work is from now on, or nothing.
pub(crate) fn show(meter: Option<&Meter>) {
    let Some(wait) = element("wait") else { return };
    // No browser refuses these names.
    let _ = wait.toggle_attribute_with_force("hidden", meter.is_none());
    LAST.set(None);
    meter.into_iter().for_each(tell);
}

/// Tells how far a work is: its stage at once, its share now and then.
pub(super) fn tell(meter: &Meter) {
    let (Some(text), Some(bar)) = (element("stage"), element("share")) else { return };
    let (stage, share) = meter.read();
    let stage = if stage.is_empty() { "beginning" } else { &stage };
    let (now, is_new) = (Instant::now(), text.text_content().as_deref() != Some(stage));
    if !is_new && LAST.get().is_some_and(|last| now - last < PACE) {
        return;
    }
    LAST.set(Some(now));
    text.set_text_content(Some(stage));
    let _ = bar.set_attribute("value", &share.clamp(0.0, 1.0).to_string());
}
