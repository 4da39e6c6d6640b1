//! Tests that cannot run here, and that say so.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

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
        let written = append_line(Path::new(&log), &message);
        assert!(written.is_ok(), "cannot write {}: {written:?}", log.display());
    }
}

/// In one write, so that lines of tests that run side by side do not mix.
fn append_line(path: &Path, line: &str) -> std::io::Result<()> {
    OpenOptions::new().append(true).create(true).open(path)?.write_all(format!("{line}\n").as_bytes())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_appended() {
        let path = std::env::temp_dir().join(format!("rilievo-testkit-{}.log", std::process::id()));
        append_line(&path, "one").unwrap();
        append_line(&path, "two").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "one\ntwo\n");
        std::fs::remove_file(&path).unwrap();
    }
}
