//! `cargo xtask hygiene`: checks over the files themselves, by what git knows and what cargo says.

mod crate_roots;
mod files;
mod licence;
mod lock;
mod manifest;
mod text;

use crate::{run, workspace};
use anyhow::{Context, Result, bail};
use std::path::Path;

pub(crate) fn run() -> Result<()> {
    let root = workspace::root();
    let mut complaints = Vec::new();
    let tracked = workspace::tracked_files()?;
    for name in &tracked {
        let bytes = std::fs::read(root.join(name)).with_context(|| format!("cannot read {name}"))?;
        complaints.extend(files::check(name, &bytes));
        if let Some(content) = as_text(&bytes) {
            complaints.extend(text::check(name, content));
            complaints.extend(crate_roots::check_unsafe(name, content));
            complaints.extend(files::check_length(name, content));
        }
    }
    complaints.extend(lock::check(&read(&root, "Cargo.lock")?));
    if run::is_ci() {
        complaints.extend(lock::check_committed());
    }

    let members = workspace::metadata(false)?;
    for path in manifest::paths(&members) {
        complaints.extend(manifest::check(&shown(&root, path), &read(&root, path)?));
    }
    for path in crate_roots::paths(&members) {
        complaints.extend(crate_roots::check(&shown(&root, path), &read(&root, path)?));
    }
    let allowed = licence::allowed(&read(&root, "deny.toml")?)?;
    complaints.extend(licence::check(&workspace::metadata(true)?, &allowed));

    for complaint in &complaints {
        eprintln!("{complaint}");
    }
    if !complaints.is_empty() {
        bail!("{} complaints about the files", complaints.len());
    }
    eprintln!("{} files are clean", tracked.len());
    Ok(())
}

/// `None` for pictures and other files that are not text.
fn as_text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok().filter(|text| !text.contains('\0'))
}

fn read(root: &Path, name: &str) -> Result<String> {
    std::fs::read_to_string(root.join(name)).with_context(|| format!("cannot read {name}"))
}

/// A path as the complaints show it: from the root.
fn shown(root: &Path, path: &str) -> String {
    Path::new(path).strip_prefix(root).unwrap_or(Path::new(path)).display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_not_text() {
        assert_eq!(as_text(b"\x89PNG\r\n"), None);
        assert_eq!(as_text(b"a\0b"), None);
        assert_eq!(as_text("größe".as_bytes()), Some("größe"));
    }
}
