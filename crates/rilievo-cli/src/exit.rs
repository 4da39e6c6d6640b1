//! Exit codes, and how errors and remarks reach the user.

use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// A negative answer: a comparison over its threshold.
pub(crate) const NEGATIVE: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;
/// A file cannot be read or written.
const IO: u8 = 3;
/// A file does not hold what it should.
const BAD_INPUT: u8 = 4;
/// A file holds something this program does not do.
const UNSUPPORTED: u8 = 5;

static QUIET: AtomicBool = AtomicBool::new(false);

/// How a command ended when nothing went wrong, or when what went wrong has been told already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    Done,
    Negative,
    /// Some input of several failed; the errors have been shown.
    Failed(u8),
}

impl Outcome {
    /// The worse of two outcomes: a failure over a negative answer over success, a higher code over a lower one.
    pub(crate) fn or_worse(self, other: Self) -> Self {
        let rank = |outcome| match outcome {
            Self::Done => 0,
            Self::Negative => NEGATIVE,
            Self::Failed(code) => code,
        };
        if rank(other) > rank(self) { other } else { self }
    }
}

/// The user's command line asks for something impossible.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// A file that is not what it should be; the message names the file and the place in it.
#[derive(Debug)]
pub(crate) struct BadInput(pub(crate) String);

impl std::fmt::Display for BadInput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

/// An error that ends with exit code 2.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    anyhow::Error::new(Usage(message.into()))
}

/// Shows an error and gives its exit code; a closed pipe is the reader's choice, not an error.
pub(crate) fn fail(error: &anyhow::Error) -> ExitCode {
    match show(error) {
        Some(code) => ExitCode::from(code),
        None => ExitCode::SUCCESS,
    }
}

/// Shows an error on stderr; returns its exit code, or `None` for a closed pipe.
pub(crate) fn show(error: &anyhow::Error) -> Option<u8> {
    let code = code(error)?;
    say(&format!("error: {error:#}"));
    Some(code)
}

/// Something the user should know although the work goes on.
pub(crate) fn warn(name: &str, message: &str) {
    say(&format!("warning: {name}: {message}"));
}

/// Something the user may like to know.
pub(crate) fn remark(message: impl AsRef<str>) {
    if !is_quiet() {
        say(message.as_ref());
    }
}

/// One line on stderr. That nobody can be told is no reason to stop working.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Sets whether remarks and progress are wanted.
pub(crate) fn quiet(on: bool) {
    QUIET.store(on, Ordering::Relaxed);
}

/// Whether remarks and progress are unwanted.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

fn code(error: &anyhow::Error) -> Option<u8> {
    for cause in error.chain() {
        if let Some(io) = cause.downcast_ref::<io::Error>() {
            return (io.kind() != io::ErrorKind::BrokenPipe).then_some(IO);
        }
        if cause.is::<Usage>() {
            return Some(USAGE);
        }
        if cause.is::<BadInput>() {
            return Some(BAD_INPUT);
        }
        match cause.downcast_ref::<rilievo_io::Error>() {
            // The cause of an Io error follows in the chain and decides.
            Some(rilievo_io::Error::Io { .. }) | None => {}
            Some(rilievo_io::Error::Unsupported { .. }) => return Some(UNSUPPORTED),
            Some(_) => return Some(BAD_INPUT),
        }
        match cause.downcast_ref::<rilievo::Error>() {
            Some(rilievo::Error::Parameter { .. } | rilievo::Error::Size { .. }) => return Some(USAGE),
            Some(_) => return Some(BAD_INPUT),
            None => {}
        }
    }
    Some(IO)
}
