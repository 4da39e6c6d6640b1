//! What no text of the product may say: paths of one machine, registry hosts, leftovers.
//!
//! The patterns are put together from pieces, so that this file passes its own check.

/// First folders of absolute paths that exist on somebody's machine only.
const MACHINE_FOLDERS: &[&str] = &["work", "root", "home", "Users"];

/// Hosts of package registries: clients know them, and mirrors replace them.
const REGISTRY_HOSTS: &[&str] = &[
    concat!("crates", ".io"),
    concat!("pypi", ".org"),
    concat!("pythonhosted", ".org"),
    concat!("npmjs", ".org"),
    concat!("yarnpkg", ".com"),
    concat!("deb.debian", ".org"),
    concat!("security.debian", ".org"),
    concat!("archive.ubuntu", ".com"),
    concat!("proxy.golang", ".org"),
];

/// Markers of unfinished work, as whole words.
const MARKERS: &[&str] = &[concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X"), concat!("HA", "CK")];

/// Phrases of unfinished or borrowed text, in lower case.
const PHRASES: &[&str] = &[
    concat!("lorem ", "ipsum"),
    concat!("(con", "tract;"),
    concat!("the owner of ", "this folder"),
    concat!("issue", " #"),
    concat!("as an ", "ai "),
    concat!("language ", "model"),
    concat!("work", "tree"),
];

/// Every complaint about a text file, with its line.
pub(super) fn check(name: &str, content: &str) -> Vec<String> {
    // Cargo.lock has to name cargo's own index; `lock` checks that it names nothing else.
    let is_lock = name == "Cargo.lock";
    let mut complaints = Vec::new();
    for (number, line) in content.lines().enumerate() {
        let mut complain = |what: String| complaints.push(format!("{name}:{}: {what}", number + 1));
        for folder in MACHINE_FOLDERS {
            if has_machine_path(line, folder) {
                complain(format!("a path of one machine: /{folder}/"));
            }
        }
        for host in REGISTRY_HOSTS.iter().filter(|host| !is_lock && line.contains(**host)) {
            complain(format!("a registry's host: {host}"));
        }
        for marker in MARKERS.iter().filter(|marker| has_word(line, marker)) {
            complain(format!("unfinished: {marker}"));
        }
        let lower = line.to_lowercase();
        for phrase in PHRASES.iter().filter(|phrase| lower.contains(**phrase)) {
            complain(format!("this does not belong into the product: {phrase}"));
        }
        if name.ends_with(".json") && line.contains(concat!("\"resol", "ved\":")) {
            complain("a lock file with download addresses".to_owned());
        }
        if is_empty_doc(line) {
            complain("a documentation comment that says nothing".to_owned());
        }
    }
    complaints
}

/// Whether `/folder/` starts an absolute path somewhere in the line.
fn has_machine_path(line: &str, folder: &str) -> bool {
    let pattern = format!("/{folder}/");
    // In a longer path or an address something comes right before: a name, `..`, `~`, or a placeholder in brackets.
    let inside = |c: char| c.is_alphanumeric() || "._-~)}>*]".contains(c);
    line.match_indices(&pattern).any(|(at, _)| !line[..at].ends_with(inside))
}

fn has_word(line: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '\\';
    line.match_indices(word).any(|(at, _)| !line[..at].ends_with(part) && !line[at + word.len()..].starts_with(part))
}

/// A placeholder such as `/// x`.
fn is_empty_doc(line: &str) -> bool {
    let line = line.trim_start();
    let text = line.strip_prefix("/// ").or_else(|| line.strip_prefix("//! "));
    text.is_some_and(|text| text.len() == 1 && text.starts_with(char::is_alphabetic))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(line: &str) -> usize {
        check("a.md", line).len()
    }

    #[test]
    fn absolute_paths_of_a_machine() {
        for folder in MACHINE_FOLDERS {
            for before in ["", "see ", "\"", "(", "=", "file://", "a:"] {
                assert_eq!(count(&format!("{before}/{folder}/x")), 1, "{before} {folder}");
            }
        }
    }

    #[test]
    fn relative_paths_and_addresses_are_fine() {
        for line in ["dev/work/x", "../work/x", "~/work/x", "{dir}/root/x", "https://example.com/home/x", "work/x"] {
            assert_eq!(count(line), 0, "{line}");
        }
    }

    #[test]
    fn registry_hosts_are_named_only_in_the_lock_file() {
        let line = format!("source = \"https://index.{}\"", REGISTRY_HOSTS[0]);
        assert_eq!(count(&line), 1);
        assert_eq!(check("Cargo.lock", &line), [] as [String; 0]);
    }

    #[test]
    fn markers_are_whole_words() {
        let marker = MARKERS[0];
        assert_eq!(count(&format!("// {marker}: later")), 1);
        assert_eq!(count(&format!("{marker}S and MASTO{marker}")), 0);
    }

    #[test]
    fn phrases_in_any_case() {
        assert_eq!(count(&PHRASES[0].to_uppercase()), 1);
    }

    #[test]
    fn placeholder_documentation() {
        assert_eq!(check("a.rs", concat!("    //", "/ x")).len(), 1);
        assert_eq!(check("a.rs", "    /// x coordinate").len(), 0);
        assert_eq!(check("a.rs", "/// 1").len(), 0);
    }

    #[test]
    fn download_addresses_in_lock_files() {
        let line = concat!("\"resol", "ved\": \"https://example.com/a.tgz\"");
        assert_eq!(check("package-lock.json", line).len(), 1);
        assert_eq!(check("report.txt", line).len(), 0);
    }

    #[test]
    fn complaint_names_the_line() {
        let content = format!("fine\n{} here\n", MARKERS[1]);
        assert!(check("a.rs", &content)[0].starts_with("a.rs:2: "));
    }
}
