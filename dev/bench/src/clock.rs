//! Processor time of this process.

/// What [`cpu_seconds`] counts, for reports.
#[cfg(unix)]
pub(crate) const KIND: &str = "process CPU time";
/// What [`cpu_seconds`] counts, for reports.
#[cfg(not(unix))]
pub(crate) const KIND: &str = "wall time (this system's CPU time is not read)";

/// Seconds of processor time, user and system, that this process has used.
///
/// POSIX's `CLOCK_PROCESS_CPUTIME_ID`: nanoseconds, where `/proc/self/stat` counts in hundredths of a second.
#[cfg(unix)]
pub(crate) fn cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Seconds since the first call.
#[cfg(not(unix))]
pub(crate) fn cpu_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_makes_it_advance() {
        let start = cpu_seconds();
        let mut x = 1u64;
        while cpu_seconds() <= start {
            x = std::hint::black_box(x.wrapping_mul(3));
        }
    }
}
