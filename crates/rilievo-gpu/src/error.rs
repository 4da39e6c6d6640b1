//! What can go wrong on the way to a GPU.

/// An error with who must act.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no GPU, or none that will do.
    #[error("no usable graphics adapter: {0}; the CPU renderer needs none")]
    NoAdapter(String),
    /// The GPU does not hold what it should.
    #[error("{what} needs {needs}, and this graphics device has at most {limit}; {remedy}")]
    Limit {
        /// What is too large.
        what: &'static str,
        /// How large it is.
        needs: u64,
        /// The device's limit.
        limit: u64,
        /// What to do.
        remedy: &'static str,
    },
    /// The method does not do this on a GPU.
    #[error("{what} cannot be drawn on the GPU; {remedy}")]
    Unsupported {
        /// What was asked for.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The scene is not the one that was loaded.
    #[error("the scene does not fit what was loaded: {0}; load it again")]
    Changed(&'static str),
    /// The device is gone, or its memory is full.
    #[error("the graphics device failed: {0}; make it anew, or use the CPU renderer")]
    Device(String),
    /// The scene itself is wrong, on any renderer.
    #[error(transparent)]
    Scene(#[from] rilievo::Error),
}

/// What this crate's functions give.
pub type Result<T, E = Error> = std::result::Result<T, E>;
