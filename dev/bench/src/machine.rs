//! What the figures were measured on.

use crate::clock;

/// One line: version, processor, what the program was compiled for, how time is taken.
pub(crate) fn describe(rounds: usize) -> String {
    let cores = std::thread::available_parallelism().map_or_else(|_| "?".to_owned(), |n| n.to_string());
    let build = if cfg!(debug_assertions) { ", NOT A RELEASE BUILD" } else { "" };
    format!(
        "rilievo {}, {} ({cores} cores, 1 used), compiled for {}-{} with {}{build}; {}, median of {rounds} rounds",
        env!("CARGO_PKG_VERSION"),
        processor().unwrap_or_else(|| "unknown processor".to_owned()),
        std::env::consts::ARCH,
        std::env::consts::OS,
        features(),
        clock::KIND,
    )
}

/// The processor's name, where Linux tells it.
fn processor() -> Option<String> {
    let info = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = info.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// Instruction sets beyond the architecture's minimum that the compiler was allowed to use.
fn features() -> String {
    let known = [
        ("sse4.2", cfg!(target_feature = "sse4.2")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
        ("simd128", cfg!(target_feature = "simd128")),
    ];
    let on: Vec<_> = known.iter().filter(|(_, on)| *on).map(|(name, _)| *name).collect();
    if on.is_empty() { "the baseline instruction set".to_owned() } else { on.join(" ") }
}
