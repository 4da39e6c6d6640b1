//! What goes wrong with files, by who must act.

use std::{fmt, io};

/// The crate's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a file could not be read or written. Each message names the file, the place in it and what to do.
///
/// [`Error::Io`] and [`Error::Invalid`] have a source, which their own messages do not repeat: print the whole chain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refuses: a missing file, a full disk, a broken pipe.
    #[error("{name}: cannot be {action}")]
    Io {
        /// The file.
        name: String,
        /// What was tried.
        action: Action,
        /// What the operating system says.
        source: io::Error,
    },
    /// The file is damaged, or is not what it is used as.
    #[error("{name}: {place}: {reason}")]
    Format {
        /// The file.
        name: String,
        /// Where in the file: a chunk, a line, a texel.
        place: String,
        /// What is wrong there, and what to do.
        reason: String,
    },
    /// The file is larger than it may be.
    #[error("{name}: {what} is more than the limit of {limit}")]
    Limits {
        /// The file.
        name: String,
        /// What is too large, with its size.
        what: String,
        /// The bound it breaks.
        limit: String,
    },
    /// The file is well formed, but of a kind this program does not read.
    #[error("{name}: {what} is not supported; {remedy}")]
    Unsupported {
        /// The file.
        name: String,
        /// The kind or feature.
        what: String,
        /// What to do instead.
        remedy: String,
    },
    /// The contents were read, but the library refuses them.
    #[error("{name}: invalid contents")]
    Invalid {
        /// The file.
        name: String,
        /// What the library says.
        source: rilievo::Error,
    },
}

impl Error {
    /// A fault at a place in `name`.
    pub(crate) fn format(name: &str, place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Format { name: name.to_owned(), place: place.into(), reason: reason.into() }
    }

    /// Something of `name` is too large.
    pub(crate) fn limits(name: &str, what: impl Into<String>, limit: impl ToString) -> Self {
        Self::Limits { name: name.to_owned(), what: what.into(), limit: limit.to_string() }
    }

    /// A kind of file or a feature that is not read.
    pub(crate) fn unsupported(name: &str, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Unsupported { name: name.to_owned(), what: what.into(), remedy: remedy.into() }
    }

    /// The library refuses the contents of `name`.
    pub(crate) fn invalid(name: &str, source: rilievo::Error) -> Self {
        Self::Invalid { name: name.to_owned(), source }
    }

    /// `name` cannot be read.
    pub(crate) fn read(name: &str, source: io::Error) -> Self {
        Self::Io { name: name.to_owned(), action: Action::Read, source }
    }

    /// `name` cannot be written.
    pub(crate) fn write(name: &str, source: io::Error) -> Self {
        Self::Io { name: name.to_owned(), action: Action::Write, source }
    }
}

/// What is done with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Action {
    /// Opening or reading it.
    Read,
    /// Creating, filling or replacing it.
    Write,
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "read",
            Self::Write => "written",
        })
    }
}

#[cfg(test)]
mod tests {
    use std::error::Error as _;

    use super::*;

    #[test]
    fn a_message_and_its_source_say_each_thing_once() {
        let io = || io::Error::from(io::ErrorKind::NotFound);
        let invalid = rilievo::Error::Missing { what: "faces", remedy: "give some" };
        let cases = [
            (Error::read("a.png", io()), "a.png: cannot be read", io().to_string()),
            (Error::write("b.png", io()), "b.png: cannot be written", io().to_string()),
            (Error::invalid("c.obj", invalid.clone()), "c.obj: invalid contents", invalid.to_string()),
        ];
        for (error, message, source) in cases {
            assert_eq!((error.to_string(), error.source().unwrap().to_string()), (message.to_owned(), source));
        }
    }
}
