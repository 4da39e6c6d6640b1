//! One file per command: raw flags in, library calls, a report out.

pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod demo;
pub(crate) mod normal;
pub(crate) mod polar;
pub(crate) mod quantize;
pub(crate) mod relight;
pub(crate) mod render;
pub(crate) mod reproduce;
pub(crate) mod view;
