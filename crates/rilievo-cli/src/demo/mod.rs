//! The demonstration: every stage of the pipeline on the built-in vase, with sizes, times and degrees.

mod html;
mod stages;

pub(crate) use html::page;
pub(crate) use stages::Demo;

/// A stage of the pipeline and what it left.
pub(crate) struct Section {
    pub(crate) title: &'static str,
    pub(crate) text: String,
    pub(crate) entries: Vec<Entry>,
}

/// A file the demonstration wrote.
pub(crate) struct Entry {
    pub(crate) file: String,
    pub(crate) bytes: usize,
    pub(crate) caption: String,
    /// Whether a browser can show it.
    pub(crate) shown: bool,
}
