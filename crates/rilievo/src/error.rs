//! What can go wrong in the library: always the caller's data or parameters, never files.

use std::fmt;

/// Shorthand for results of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Everything the library refuses, by what the caller has to change.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A parameter is outside its range.
    Parameter {
        /// The parameter's name, as the documentation spells it.
        name: &'static str,
        /// What was given.
        value: String,
        /// What is accepted.
        expected: String,
    },
    /// A grid is empty or larger than [`crate::grid::MAX_SIDE`] or [`crate::grid::MAX_TEXELS`] allow.
    Size {
        /// Width in texels.
        width: u64,
        /// Height in texels.
        height: u64,
    },
    /// The number of values does not fit the size that was given with them.
    Length {
        /// What the values are.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        actual: usize,
    },
    /// Two maps that belong together have different sizes.
    SizeMismatch {
        /// What the second map is.
        what: &'static str,
        /// Width and height of the first.
        expected: (u32, u32),
        /// Width and height of the second.
        actual: (u32, u32),
    },
    /// A value that must be finite is not, or a vector that must have a direction has none.
    NotFinite {
        /// What the value is.
        what: &'static str,
        /// Its index (vertex, texel in row-major order, entry).
        index: usize,
    },
    /// An index points past the end of what it indexes.
    IndexRange {
        /// What is indexed.
        what: &'static str,
        /// Where the index stands.
        at: usize,
        /// The index.
        index: u64,
        /// How many there are.
        len: usize,
    },
    /// The input lacks something the stage needs (texture coordinates, triangles, normals).
    Missing {
        /// What is missing.
        what: &'static str,
        /// What to do about it.
        remedy: &'static str,
    },
}

impl Error {
    /// A parameter outside its range.
    pub fn parameter(name: &'static str, value: impl fmt::Display, expected: impl fmt::Display) -> Self {
        Self::Parameter { name, value: value.to_string(), expected: expected.to_string() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter { name, value, expected } => write!(f, "{name} is {value}; expected {expected}"),
            Self::Size { width, height } => write!(
                f,
                "a grid of {width} × {height} is not possible: each side must be 1 to {} and the area at most {} texels",
                crate::grid::MAX_SIDE,
                crate::grid::MAX_TEXELS
            ),
            Self::Length { what, expected, actual } => write!(f, "{what}: expected {expected} values, got {actual}"),
            Self::SizeMismatch { what, expected: (w, h), actual: (aw, ah) } => {
                write!(f, "{what} is {aw} × {ah}, but the map it belongs to is {w} × {h}; give both the same size")
            }
            Self::NotFinite { what, index } => {
                write!(f, "{what} {index} is not a finite, non-zero value")
            }
            Self::IndexRange { what, at, index, len } => {
                write!(f, "{what} at {at} is {index}, but there are only {len}")
            }
            Self::Missing { what, remedy } => write!(f, "{what} missing: {remedy}"),
        }
    }
}

impl std::error::Error for Error {}
