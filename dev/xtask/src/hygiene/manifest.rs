//! Manifests of the members: lints and versions stand in the workspace's, once.
//!
//! Read line by line, as `cargo metadata` has already resolved what is inherited.

use serde_json::Value;

/// The manifests of all members.
pub(super) fn paths(metadata: &Value) -> impl Iterator<Item = &str> {
    metadata["packages"].as_array().into_iter().flatten().filter_map(|package| package["manifest_path"].as_str())
}

pub(super) fn check(name: &str, manifest: &str) -> Vec<String> {
    let mut complaints = Vec::new();
    let mut inherits_lints = false;
    for (number, section, line) in entries(manifest) {
        let (key, value) = line.split_once('=').map_or((line, ""), |(key, value)| (key.trim(), value.trim()));
        inherits_lints |= section == "lints" && key == "workspace" && value == "true";
        inherits_lints |= section.is_empty() && key == "lints.workspace" && value == "true";
        let own_version = match section {
            "package" => key == "version",
            _ if is_dependencies(section) => {
                value.starts_with('"') && !key.contains('.') || key.ends_with(".version") || has_key(value, "version")
            }
            // [dependencies.NAME]
            _ => section.rsplit_once('.').is_some_and(|(table, _)| is_dependencies(table)) && key == "version",
        };
        if own_version {
            complaints.push(format!("{name}:{number}: versions stand in the workspace's manifest: {line}"));
        }
    }
    if !inherits_lints {
        complaints.push(format!("{name}: `[lints] workspace = true` is missing"));
    }
    complaints
}

/// `dependencies`, `dev-dependencies`, `build-dependencies`, also of one target.
fn is_dependencies(section: &str) -> bool {
    section == "dependencies" || section.ends_with("-dependencies") || section.ends_with(".dependencies")
}

/// Whether an inline table has this key.
fn has_key(value: &str, key: &str) -> bool {
    let fields = value.trim_start_matches('{').split(',');
    value.starts_with('{') && fields.filter_map(|field| field.split_once('=')).any(|(name, _)| name.trim() == key)
}

/// The lines that say something: number from 1, section, text.
fn entries(manifest: &str) -> impl Iterator<Item = (usize, &str, &str)> {
    let mut section = "";
    manifest.lines().enumerate().filter_map(move |(index, line)| {
        let line = line.trim();
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            section = name;
            return None;
        }
        (!line.is_empty() && !line.starts_with('#')).then_some((index + 1, section, line))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str =
        "[package]\nversion.workspace = true\n[features]\ndefault = []\n[dependencies]\na.workspace = true
b = { workspace = true, features = [\"version\"] }\n[lints]\nworkspace = true\n";

    #[test]
    fn everything_inherited() {
        assert_eq!(check("Cargo.toml", GOOD), [] as [String; 0]);
    }

    #[test]
    fn own_versions() {
        for line in
            ["a = \"1\"", "a = { version = \"1\" }", "a = { features = [], version = \"1\" }", "a.version = \"1\""]
        {
            for table in ["dependencies", "dev-dependencies", "target.'cfg(unix)'.dependencies"] {
                let manifest = format!("{GOOD}[{table}]\n{line}\n");
                assert_eq!(check("Cargo.toml", &manifest).len(), 1, "[{table}] {line}");
            }
        }
        assert_eq!(check("Cargo.toml", &format!("{GOOD}[dependencies.a]\nversion = \"1\"\n")).len(), 1);
        assert_eq!(check("Cargo.toml", &GOOD.replace("version.workspace = true", "version = \"1\"")).len(), 1);
    }

    #[test]
    fn missing_lints() {
        assert_eq!(check("Cargo.toml", &GOOD.replace("[lints]", "[other]")).len(), 1);
    }
}
