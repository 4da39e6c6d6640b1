//! How far the work is, in an element of the page and not in the viewer's own picture: where the GPU is software, a
//! frame of that costs as much as a tenth of the work.

use std::cell::Cell;

use web_sys::Element;
use web_time::{Duration, Instant};

use crate::job::Meter;

/// How often the element changes. It is seen to move, and little is taken from the work.
const PACE: Duration = Duration::from_millis(300);

thread_local! {
    static LAST: Cell<Option<Instant>> = const { Cell::new(None) };
}

fn element(id: &str) -> Option<Element> {
    web_sys::window()?.document()?.get_element_by_id(id)
}

/// Shows how far a work is from now on, or nothing.
pub(crate) fn show(meter: Option<&Meter>) {
    let Some(wait) = element("wait") else { return };
    // The page's own script stands for these names.
    let _ = wait.toggle_attribute_with_force("hidden", meter.is_none());
    LAST.set(None);
    meter.into_iter().for_each(tell);
}

/// Tells how far a work is.
pub(super) fn tell(meter: &Meter) {
    let now = Instant::now();
    if LAST.get().is_some_and(|last| now - last < PACE) {
        return;
    }
    LAST.set(Some(now));
    let (stage, share) = meter.read();
    if let (Some(text), Some(bar)) = (element("stage"), element("share")) {
        text.set_text_content(Some(if stage.is_empty() { "beginning" } else { &stage }));
        let _ = bar.set_attribute("value", &share.clamp(0.0, 1.0).to_string());
    }
}
