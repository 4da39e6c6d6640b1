//! Licences of all dependencies against the list in deny.toml: the part of `cargo deny` that nobody may go without.

use anyhow::{Context, Result};
use serde_json::Value;

/// The strings of the first `allow = […]` in `[licenses]` of deny.toml.
pub(super) fn allowed(deny: &str) -> Result<Vec<String>> {
    let section = deny.split_once("\n[licenses]").context("deny.toml has no [licenses]")?.1;
    let list = section.split_once("\nallow = [").and_then(|(_, rest)| rest.split_once(']'));
    let list = list.context("deny.toml has no list of allowed licences")?.0;
    let entries = list.lines().map(|line| line.split('#').next().unwrap_or(line));
    Ok(entries.flat_map(|line| line.split('"').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()).collect())
}

pub(super) fn check(metadata: &Value, allowed: &[String]) -> Vec<String> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let refused = packages.filter(|package| !package["license"].as_str().is_some_and(|l| is_allowed(l, allowed)));
    refused
        .map(|package| {
            format!("{} {}: licence {} is not in deny.toml", package["name"], package["version"], package["license"])
        })
        .collect()
}

/// Whether an SPDX expression leaves a choice that is allowed. The slash of old manifests means OR.
fn is_allowed(expression: &str, allowed: &[String]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    any(&mut words, allowed) && words.next().is_none()
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

/// `a OR b OR …`. Every operand is read, also when the answer is known.
fn any(words: &mut Words<'_>, allowed: &[String]) -> bool {
    let mut found = all(words, allowed);
    while words.next_if_eq(&"OR").is_some() {
        found |= all(words, allowed);
    }
    found
}

/// `a AND b AND …`, which binds tighter.
fn all(words: &mut Words<'_>, allowed: &[String]) -> bool {
    let mut every = one(words, allowed);
    while words.next_if_eq(&"AND").is_some() {
        every &= one(words, allowed);
    }
    every
}

/// A licence, with its exception if it has one, or an expression in brackets.
fn one(words: &mut Words<'_>, allowed: &[String]) -> bool {
    let Some(word) = words.next() else { return false };
    if word == "(" {
        let inner = any(words, allowed);
        return words.next() == Some(")") && inner;
    }
    let name = match words.next_if_eq(&"WITH") {
        Some(_) => format!("{word} WITH {}", words.next().unwrap_or_default()),
        None => word.to_owned(),
    };
    allowed.contains(&name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_fine(expression: &str) -> bool {
        is_allowed(expression, &["MIT".to_owned(), "Zlib".to_owned(), "Unicode-3.0".to_owned()])
    }

    #[test]
    fn any_choice_will_do() {
        assert!(is_fine("MIT"));
        assert!(is_fine("GPL-3.0-only OR MIT"));
        assert!(is_fine("Unlicense/MIT"));
        assert!(is_fine("Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT"));
    }

    #[test]
    fn every_part_of_a_conjunction_must() {
        assert!(is_fine("(MIT OR Apache-2.0) AND Unicode-3.0"));
        assert!(is_fine("Zlib AND (GPL-2.0 OR MIT)"));
        assert!(!is_fine("MIT AND GPL-3.0-or-later"));
        assert!(!is_fine("GPL-2.0 OR MIT AND LGPL-2.1"));
        assert!(is_fine("MIT OR GPL-2.0 AND LGPL-2.1"));
    }

    #[test]
    fn copyleft_alone_exceptions_and_nonsense_are_refused() {
        for expression in
            ["GPL-3.0-or-later", "AGPL-3.0", "MIT WITH some-exception", "", "(MIT", "MIT)", "MIT MIT", "OR"]
        {
            assert!(!is_fine(expression), "{expression}");
        }
    }

    #[test]
    fn list_is_read_without_its_comments() {
        let deny =
            "[graph]\n\n[licenses]\n# \"GPL\"\nallow = [\n    \"MIT\", \"0BSD\", # not \"GPL\"\n    \"Zlib\",\n]\n";
        assert_eq!(allowed(deny).unwrap(), ["MIT", "0BSD", "Zlib"]);
        assert!(allowed("[bans]\n").is_err());
    }

    #[test]
    fn package_without_a_licence_is_refused() {
        let metadata = serde_json::json!({"packages": [
            {"name": "a", "version": "1.0.0", "license": "MIT"},
            {"name": "b", "version": "1.0.0", "license": null},
        ]});
        assert_eq!(check(&metadata, &["MIT".to_owned()]).len(), 1);
    }
}
