//! Every library and program forbids unsafe code in its own first file, where no inner attribute can allow it again.

use crate::workspace::strings;
use serde_json::Value;

const ATTRIBUTE: &str = "#![forbid(unsafe_code)]";

/// The root files of all libraries and programs of the members; tests and examples have the workspace's lints.
pub(super) fn paths(metadata: &Value) -> impl Iterator<Item = &str> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let targets = packages.filter_map(|package| package["targets"].as_array()).flatten();
    targets
        .filter(|target| !strings(&target["kind"]).any(|kind| ["test", "bench", "example"].contains(&kind)))
        .filter_map(|target| target["src_path"].as_str())
}

pub(super) fn check(name: &str, source: &str) -> Option<String> {
    (!source.lines().any(|line| line.trim() == ATTRIBUTE)).then(|| format!("{name}: `{ATTRIBUTE}` is missing"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_libraries_and_programs() {
        let metadata = serde_json::json!({"packages": [{"targets": [
            {"kind": ["lib"], "src_path": "lib.rs"},
            {"kind": ["bin"], "src_path": "main.rs"},
            {"kind": ["test"], "src_path": "test.rs"},
        ]}]});
        assert_eq!(paths(&metadata).collect::<Vec<_>>(), ["lib.rs", "main.rs"]);
    }

    #[test]
    fn attribute_in_a_comment_does_not_count() {
        assert_eq!(check("lib.rs", "//! Docs.\n#![forbid(unsafe_code)]\n"), None);
        assert!(check("lib.rs", "// #![forbid(unsafe_code)]\n").is_some());
    }
}
