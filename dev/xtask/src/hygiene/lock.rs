//! Cargo.lock: every package from cargo's own index, none from a mirror, a git repository or another registry.

use crate::run::Run;

const INDEX: &str = concat!("source = \"registry+https://github.com/rust-lang/crates", ".io-index\"");

pub(super) fn check(lock: &str) -> Vec<String> {
    let foreign = lock.lines().enumerate().filter(|(_, line)| line.starts_with("source = ") && *line != INDEX);
    foreign.map(|(number, line)| format!("Cargo.lock:{}: not from the usual index: {line}", number + 1)).collect()
}

/// In a fresh clone cargo completes a stale lock file without a word; then others would build something else.
pub(super) fn check_committed() -> Option<String> {
    let unchanged = Run::new("git").args(["diff", "--quiet", "HEAD", "--", "Cargo.lock"]).output();
    unchanged.err().map(|_| "Cargo.lock: not as committed; commit it as cargo completed it".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_index_and_members_pass() {
        assert!(check(&format!("name = \"a\"\n{INDEX}\n\n[[package]]\nname = \"member\"\n")).is_empty());
    }

    #[test]
    fn git_and_mirrors_do_not() {
        let lock = "source = \"git+https://example.com/a\"\nsource = \"sparse+https://example.com/index/\"\n";
        assert_eq!(check(lock).len(), 2);
    }
}
