//! `rilievo view`: the interactive viewer.

#[cfg(not(feature = "view"))]
mod absent;
#[cfg(feature = "view")]
mod window;

#[cfg(not(feature = "view"))]
pub(crate) use absent::{Args, run};
#[cfg(feature = "view")]
pub(crate) use window::{Args, run};
