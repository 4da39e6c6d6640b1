//! What tests could not run. A passing test's stderr is not shown, so the testkit also writes each skip to a file.

use anyhow::Result;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The environment variable that names the file to the testkit.
pub(crate) const VARIABLE: &str = "RILIEVO_SKIP_LOG";

/// The file of one run.
pub(crate) struct SkipLog(PathBuf);

impl SkipLog {
    pub(crate) fn new() -> Result<Self> {
        let path = std::env::temp_dir().join(format!("rilievo-skips-{}.log", std::process::id()));
        std::fs::write(&path, "")?;
        Ok(Self(path))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Each skip once, sorted.
    pub(crate) fn lines(&self) -> Result<BTreeSet<String>> {
        Ok(std::fs::read_to_string(&self.0)?.lines().map(str::to_owned).collect())
    }
}

impl Drop for SkipLog {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}
