//! What the canvas shows, in words beside it: for those who do not see it.

use web_time::{Duration, Instant};

use super::element;

/// How long figures stay, so that they can be read and heard.
const STAY: Duration = Duration::from_millis(500);

/// The words, as the page has them.
#[derive(Default)]
pub(crate) struct Words {
    subject: String,
    all: String,
    when: Option<Instant>,
}

impl Words {
    /// Says what is to be seen at once, and its figures now and then. Gives how long others have to wait.
    pub(crate) fn tell(&mut self, subject: String, figures: &str) -> Option<Duration> {
        let all = format!("{subject}; {figures}");
        if all == self.all {
            return None;
        }
        let said = self.when.map_or(STAY, |when| when.elapsed());
        if subject == self.subject && said < STAY {
            return Some(STAY - said);
        }
        if let Some(element) = element("state") {
            element.set_text_content(Some(&all));
        }
        (self.subject, self.all, self.when) = (subject, all, Some(Instant::now()));
        None
    }
}
