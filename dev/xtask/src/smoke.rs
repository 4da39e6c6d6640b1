//! The real program, as a user starts it: the demo, and every file its page refers to.

use crate::run::Run;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub(crate) fn run() -> Result<()> {
    let folder = Scratch::new()?;
    Run::cargo().args(["run", "--release", "--", "demo", "-o"]).arg(&folder.0).wait()?;
    let files = check(&folder.0)?;
    eprintln!("index.html and the {files} files it refers to are there");
    Ok(())
}

/// Counts the files `index.html` refers to; an error if there is none, or if one is missing or empty.
fn check(folder: &Path) -> Result<usize> {
    let page = std::fs::read_to_string(folder.join("index.html")).context("the demo wrote no index.html")?;
    let names = references(&page);
    if names.is_empty() {
        bail!("index.html refers to no file");
    }
    for name in &names {
        let size = std::fs::metadata(folder.join(name)).with_context(|| format!("index.html refers to {name}"))?.len();
        if size == 0 {
            bail!("{name} is empty");
        }
    }
    Ok(names.len())
}

/// The local files in `src="…"` and `href="…"` of a page.
fn references(page: &str) -> BTreeSet<&str> {
    let values = [" src=\"", " href=\""]
        .into_iter()
        .flat_map(|attribute| page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next()));
    let local = |name: &&str| !name.is_empty() && !name.starts_with('#') && !name.contains(':');
    values.filter(local).collect()
}

/// A fresh folder that goes away again.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Result<Self> {
        let path = std::env::temp_dir().join(format!("rilievo-smoke-{}", std::process::id()));
        std::fs::create_dir(&path).with_context(|| format!("cannot make {}", path.display()))?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str =
        "<a href=\"#top\"><img src=\"a.png\"><img alt=\"\" src=\"a.png\"><a href=\"b/c.png\"><a href=\"https://x.y\">";

    fn scratch(name: &str) -> Scratch {
        let path = std::env::temp_dir().join(format!("rilievo-smoke-test-{name}-{}", std::process::id()));
        std::fs::create_dir_all(path.join("b")).unwrap();
        Scratch(path)
    }

    #[test]
    fn references_are_local_and_counted_once() {
        assert_eq!(references(PAGE).into_iter().collect::<Vec<_>>(), ["a.png", "b/c.png"]);
    }

    #[test]
    fn complete_page_counts_its_files() {
        let folder = scratch("complete");
        for (name, content) in [("index.html", PAGE), ("a.png", "x"), ("b/c.png", "x")] {
            std::fs::write(folder.0.join(name), content).unwrap();
        }
        assert_eq!(check(&folder.0).unwrap(), 2);
    }

    #[test]
    fn missing_page_missing_file_and_empty_file_are_errors() {
        let folder = scratch("faulty");
        assert!(check(&folder.0).is_err());
        std::fs::write(folder.0.join("index.html"), PAGE).unwrap();
        std::fs::write(folder.0.join("a.png"), "x").unwrap();
        assert!(check(&folder.0).unwrap_err().to_string().contains("b/c.png"));
        std::fs::write(folder.0.join("b/c.png"), "").unwrap();
        assert!(check(&folder.0).unwrap_err().to_string().contains("empty"));
    }
}
