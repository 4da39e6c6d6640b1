//! Where the workspace is and what is in it.

use crate::run::Run;
use anyhow::{Context, Result};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The root of the workspace. Cargo tells at run time, so a moved checkout is found too.
pub(crate) fn root() -> PathBuf {
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    here.ancestors().nth(2).map_or_else(|| here.clone(), Path::to_path_buf)
}

/// The files that git knows and that are still there, as paths from the root with `/`.
pub(crate) fn tracked_files() -> Result<Vec<String>> {
    let listed = Run::new("git").args(["ls-files", "-z"]).output().context("hygiene looks at the files git knows")?;
    let root = root();
    Ok(listed.split('\0').filter(|name| !name.is_empty() && root.join(name).is_file()).map(str::to_owned).collect())
}

/// What `cargo metadata` says of the members, or with `dependencies` of every package in Cargo.lock.
pub(crate) fn metadata(dependencies: bool) -> Result<Value> {
    let mut run = Run::cargo().args(["metadata", "--format-version", "1"]);
    if !dependencies {
        run = run.arg("--no-deps");
    }
    serde_json::from_str(&run.output()?).context("cargo metadata printed something else than JSON")
}

/// The strings of a JSON array; nothing if it is none.
pub(crate) fn strings(value: &Value) -> impl Iterator<Item = &str> {
    value.as_array().into_iter().flatten().filter_map(Value::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_is_the_workspace() {
        assert!(root().join("dev/xtask/Cargo.toml").is_file());
        assert!(root().join("Cargo.lock").is_file());
    }
}
