//! Where the collection of real inputs lies, if it is there.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of real test inputs: `$RILIEVO_DATA`, or `../shared/data` beside the checkout.
///
/// `None` if there is none, after saying so on stderr: a skipped test must be heard. With `CI=true` nothing may be
/// skipped, so there its absence is a failure.
///
/// # Panics
/// If the folder is absent and `CI` is `true`.
pub fn shared_data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("RILIEVO_DATA").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    skip(&format!("no real test data in {} (set RILIEVO_DATA to their folder)", folder.display()));
    None
}

/// Whether an external program is on the search path; if not, the test that asks is skipped as by [`skip`].
///
/// # Panics
/// If it is absent and `CI` is `true`.
pub fn has_program(name: &str) -> bool {
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path).any(|folder| folder.join(&file).is_file());
    if !found {
        skip(&format!("the program {name} is not installed"));
    }
    found
}

/// Says that the running test is skipped and why: on stderr, and as a line of the file `$RILIEVO_SKIP_LOG` if that is
/// set, since runners hide what a passing test prints.
///
/// # Panics
/// If `CI` is `true`: there nothing may be skipped. Or if the log cannot be written.
#[expect(clippy::print_stderr, reason = "a skipped test must be heard")]
pub fn skip(why: &str) {
    let message = format!("SKIPPED {}: {why}", std::thread::current().name().unwrap_or("a test"));
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{message}; with CI=true nothing may be skipped");
    eprintln!("{message}");
    if let Some(log) = std::env::var_os("RILIEVO_SKIP_LOG") {
        // One write of one line, so that lines of tests that run side by side do not mix.
        let file = OpenOptions::new().append(true).create(true).open(&log);
        let written = file.and_then(|mut file| file.write_all(format!("{message}\n").as_bytes()));
        assert!(written.is_ok(), "cannot write {}: {written:?}", log.display());
    }
}

/// One file of [`shared_data`].
///
/// # Panics
/// If the folder is there but the file is not: then the test names the wrong file.
pub fn shared_file(name: &str) -> Option<PathBuf> {
    let path = shared_data()?.join(name);
    assert!(path.exists(), "{} is missing from the test data", path.display());
    Some(path)
}
