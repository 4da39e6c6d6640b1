//! How fast frames follow each other.

use std::collections::VecDeque;
use std::time::Duration;

use web_time::Instant;

/// Frames that the figure is of.
const FRAMES: usize = 15;

/// Times from frame to frame while every frame shows something new.
#[derive(Debug, Default)]
pub(super) struct Pace {
    last: Option<Instant>,
    times: VecDeque<Duration>,
}

impl Pace {
    /// A frame was drawn at this moment.
    pub(super) fn drawn(&mut self, now: Instant) {
        if let Some(last) = self.last.replace(now) {
            self.times.truncate(FRAMES - 1);
            self.times.push_front(now - last);
        }
    }

    /// A frame showed what the one before it did.
    pub(super) fn rested(&mut self) {
        self.last = None;
    }

    /// What was measured is of something else now.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// The median, once there are frames enough for one.
    pub(super) fn frame(&self) -> Option<Duration> {
        let mut times: Vec<Duration> = self.times.iter().copied().collect();
        times.sort_unstable();
        times.get(times.len() / 2).copied().filter(|_| times.len() >= 5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_frames_that_follow_each_other() {
        let (mut pace, mut now) = (Pace::default(), Instant::now());
        let mut after = |pace: &mut Pace, milliseconds: u64| {
            now += Duration::from_millis(milliseconds);
            pace.drawn(now);
        };
        after(&mut pace, 0);
        for milliseconds in [16, 17, 16, 90] {
            after(&mut pace, milliseconds);
            assert_eq!(pace.frame(), None, "too few");
        }
        // A pause is nobody's frame time.
        pace.rested();
        after(&mut pace, 5_000);
        after(&mut pace, 17);
        assert_eq!(pace.frame(), Some(Duration::from_millis(17)));
        (0..2 * FRAMES).for_each(|_| after(&mut pace, 40));
        assert_eq!(pace.frame(), Some(Duration::from_millis(40)), "old frames are forgotten");
        pace.forget();
        assert_eq!(pace.frame(), None);
    }
}
