//! What goes wrong with files, by who must act.

use std::io;

/// The crate's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a file could not be read or written. Each message names the file, the place in it and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refuses: a missing file, a full disk, a broken pipe.
    #[error("{name}: {source}")]
    Io {
        /// The file.
        name: String,
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
    #[error("{name}: {source}")]
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

    /// The operating system refuses.
    pub(crate) fn io(name: &str, source: io::Error) -> Self {
        Self::Io { name: name.to_owned(), source }
    }
}
