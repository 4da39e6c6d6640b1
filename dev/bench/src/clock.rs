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

/// Seconds of processor time, user and system, that this thread has used: a software GPU works on threads of its own.
#[cfg(all(unix, feature = "gpu"))]
pub(crate) fn thread_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Seconds since the first call.
#[cfg(all(not(unix), feature = "gpu"))]
pub(crate) fn thread_seconds() -> f64 {
    wall_seconds()
}

/// Seconds of processor time, user and system, of the programs that this process has run and waited for.
///
/// From `/proc/self/stat`, in hundredths of a second: enough for programs that run for a tenth and more. Elsewhere the
/// time since the first call.
pub(crate) fn children_seconds() -> f64 {
    /// Ticks a second; Linux tells this number to programs whatever its own is.
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name of the program, in parentheses, may hold anything; times of children are the 14th and 15th after it.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    match (fields.get(13).and_then(|f| f.parse::<f64>().ok()), fields.get(14).and_then(|f| f.parse::<f64>().ok())) {
        (Some(user), Some(system)) => (user + system) / TICKS,
        _ => wall_seconds(),
    }
}

/// Seconds since the first call.
fn wall_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Seconds since the first call.
#[cfg(not(unix))]
pub(crate) fn cpu_seconds() -> f64 {
    wall_seconds()
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
