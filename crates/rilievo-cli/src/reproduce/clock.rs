//! Taking times so that they can be compared: one thread, its own processor time, sides in turns, medians.

use anyhow::{Context, Result};

/// What [`seconds`] counts, for the report.
pub(crate) const KIND: &str = if HAS_CPU_TIME { "processor time of one thread" } else { "wall time of one thread" };

const HAS_CPU_TIME: bool = cfg!(any(target_os = "linux", target_vendor = "apple"));

/// How often and how long work is timed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    rounds: usize,
    /// A sample lasts at least this long, in seconds: short work is repeated, and the clock's own cost disappears.
    shortest_sample: f64,
}

impl Clock {
    /// Enough for figures to be read, or just enough to see that it works.
    pub(crate) fn new(quick: bool) -> Self {
        if quick { Self { rounds: 3, shortest_sample: 2e-4 } } else { Self { rounds: 15, shortest_sample: 5e-3 } }
    }

    /// Rounds of each measurement.
    pub(crate) fn rounds(&self) -> usize {
        self.rounds
    }

    /// Median seconds that one run of each of `sides` kinds of work takes, on a thread of their own.
    ///
    /// The sides take turns, so that whatever else the machine does hits all of them; who begins moves on from round to
    /// round. `work(side)` runs once for warm-up first.
    ///
    /// # Errors
    /// Those of `work`, and if there is no thread to be had.
    pub(crate) fn turns(&self, sides: usize, work: impl FnMut(usize) -> Result<()> + Send) -> Result<Vec<f64>> {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().context("a thread to take times on")?;
        alone.install(|| self.turns_here(sides, work))
    }

    fn turns_here(&self, sides: usize, mut work: impl FnMut(usize) -> Result<()>) -> Result<Vec<f64>> {
        let mut sample = |side: usize, repeats: usize| -> Result<f64> {
            let start = seconds();
            for _ in 0..repeats {
                work(side)?;
            }
            Ok((seconds() - start) / repeats as f64)
        };
        let mut repeats = Vec::with_capacity(sides);
        for side in 0..sides {
            // The first run finds cold caches; the second tells how long it takes.
            sample(side, 1)?;
            repeats.push((self.shortest_sample / sample(side, 1)?.max(1e-9)).ceil() as usize);
        }
        let mut times = vec![Vec::with_capacity(self.rounds); sides];
        for round in 0..self.rounds {
            for turn in 0..sides {
                let side = (turn + round) % sides;
                times[side].push(sample(side, repeats[side])?);
            }
        }
        Ok(times.into_iter().map(median).collect())
    }
}

/// The middle value, or the mean of the two middle ones; NaN of nothing.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let (below, above) = (values.len().saturating_sub(1) / 2, values.len() / 2);
    match (values.get(below), values.get(above)) {
        (Some(a), Some(b)) => (a + b) / 2.0,
        _ => f64::NAN,
    }
}

/// Seconds of processor time that this thread has used.
#[cfg(any(target_os = "linux", target_vendor = "apple"))]
fn seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Seconds since the first call.
#[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
fn seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_even_and_none() {
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0, 4.0]), 3.0);
        assert!(median(vec![]).is_nan());
    }

    #[test]
    fn sides_take_turns_and_each_begins() {
        let clock = Clock { rounds: 3, shortest_sample: 0.0 };
        let mut log = String::new();
        let times = clock.turns(3, |side| {
            log.push(['a', 'b', 'c'][side]);
            Ok(())
        });
        assert_eq!(times.unwrap().len(), 3);
        // Twice for warm-up, then rounds; no repetitions of work that takes less than nothing.
        assert!(log.starts_with("aabbcc"), "{log}");
        assert!(clock.turns(2, |side| if side == 1 { anyhow::bail!("no") } else { Ok(()) }).is_err());
    }

    #[test]
    fn work_makes_time_pass() {
        let start = seconds();
        let mut x = 1u64;
        while seconds() <= start {
            x = std::hint::black_box(x.wrapping_mul(3));
        }
    }
}
