//! Where the collection of real inputs lies, if it is there.

use crate::skip;
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

/// One file of [`shared_data`].
///
/// # Panics
/// If the folder is there but the file is not: then the test names the wrong file.
pub fn shared_file(name: &str) -> Option<PathBuf> {
    let path = shared_data()?.join(name);
    assert!(path.exists(), "{} is missing from the test data", path.display());
    Some(path)
}
