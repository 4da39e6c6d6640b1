//! Every library and program forbids unsafe code in its own first file, where no inner attribute can allow it again; but
//! for one, which denies it and allows it in one file.

use crate::workspace::strings;
use serde_json::Value;

const ATTRIBUTE: &str = "#![forbid(unsafe_code)]";

/// The crate with an island of unsafe code: its root, what stands there instead, and the island.
const ISLAND_ROOT: &str = "crates/rilievo/src/lib.rs";
const ISLAND_ATTRIBUTE: &str = "#![deny(unsafe_code)]";
const ISLAND: &str = "crates/rilievo/src/simd/gather.rs";
/// The only things there that may be unsafe are blocks.
const KEYWORDS: [&str; 4] =
    [concat!("unsafe", " {"), concat!("unsafe", " fn"), concat!("unsafe", " impl"), concat!("unsafe", " trait")];

/// The root files of all libraries and programs of the members; tests and examples have the workspace's lints.
pub(super) fn paths(metadata: &Value) -> impl Iterator<Item = &str> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let targets = packages.filter_map(|package| package["targets"].as_array()).flatten();
    targets
        .filter(|target| !strings(&target["kind"]).any(|kind| ["test", "bench", "example"].contains(&kind)))
        .filter_map(|target| target["src_path"].as_str())
}

pub(super) fn check(name: &str, source: &str) -> Option<String> {
    let wanted = if name == ISLAND_ROOT { ISLAND_ATTRIBUTE } else { ATTRIBUTE };
    (!source.lines().any(|line| line.trim() == wanted)).then(|| format!("{name}: `{wanted}` is missing"))
}

/// Unsafe code outside of the island, and in it whatever is no block or says no reason.
pub(super) fn check_unsafe(name: &str, source: &str) -> Vec<String> {
    if !name.ends_with(".rs") {
        return Vec::new();
    }
    let mut reasons = 0;
    let mut complaints = Vec::new();
    for (number, line) in source.lines().enumerate() {
        reasons += usize::from(line.trim_start().starts_with("// SAFETY:"));
        let Some(keyword) = KEYWORDS.iter().find(|k| line.contains(**k)) else { continue };
        if name == ISLAND && *keyword == KEYWORDS[0] && reasons > 0 {
            reasons -= 1;
        } else {
            complaints.push(format!("{name}:{}: `{keyword}` is not for this place", number + 1));
        }
    }
    complaints
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
    fn unsafe_code_stays_on_its_island_and_says_why() {
        let block = format!("let x = {} y }};", KEYWORDS[0]);
        let explained = format!("// SAFETY: because.\n{block}");
        assert_eq!(check_unsafe(ISLAND, &explained), [""; 0]);
        assert_eq!(check_unsafe(ISLAND, &block).len(), 1);
        assert_eq!(check_unsafe("other.rs", &explained).len(), 1);
        assert_eq!(check_unsafe(ISLAND, &format!("// SAFETY: no.\n{} f() {{}}", KEYWORDS[1])).len(), 1);
        assert_eq!(check_unsafe("notes.md", &block), [""; 0]);
        assert_eq!(check(ISLAND_ROOT, ISLAND_ATTRIBUTE), None);
        assert!(check(ISLAND_ROOT, "").is_some());
    }

    #[test]
    fn attribute_in_a_comment_does_not_count() {
        assert_eq!(check("lib.rs", "//! Docs.\n#![forbid(unsafe_code)]\n"), None);
        assert!(check("lib.rs", "// #![forbid(unsafe_code)]\n").is_some());
    }
}
