//! Running other programs: said on stderr before they start, an error when they fail.

use anyhow::{Context, Result, bail};
use std::ffi::OsStr;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};

/// A program to run, from the root of the workspace.
pub(crate) struct Run {
    command: Command,
    shown: String,
}

impl Run {
    pub(crate) fn new(program: impl AsRef<OsStr>) -> Self {
        let shown = program.as_ref().to_string_lossy().into_owned();
        let mut command = Command::new(program);
        command.current_dir(crate::workspace::root()).stdin(Stdio::null());
        Self { command, shown }
    }

    /// The cargo that runs this program, so that a toolchain chosen by `cargo +NAME xtask` stays chosen.
    pub(crate) fn cargo() -> Self {
        let mut run = Self::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        run.shown = "cargo".to_owned();
        run
    }

    pub(crate) fn arg(mut self, arg: impl AsRef<OsStr>) -> Self {
        self.shown.push(' ');
        self.shown.push_str(&arg.as_ref().to_string_lossy());
        self.command.arg(arg);
        self
    }

    pub(crate) fn args<A: AsRef<OsStr>>(self, args: impl IntoIterator<Item = A>) -> Self {
        args.into_iter().fold(self, Self::arg)
    }

    pub(crate) fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.shown = format!("{name}={:?} {}", value.as_ref(), self.shown);
        self.command.env(name, value);
        self
    }

    /// Somewhere else than at the root of the workspace.
    pub(crate) fn current_dir(mut self, folder: &Path) -> Self {
        self.command.current_dir(folder);
        self
    }

    /// With a file to read.
    pub(crate) fn stdin(mut self, file: File) -> Self {
        self.command.stdin(file);
        self
    }

    /// Runs it with its output on the terminal; an error unless it exits with 0.
    pub(crate) fn wait(mut self) -> Result<()> {
        eprintln!("$ {}", self.shown);
        let status = self.command.status().with_context(|| format!("cannot start `{}`", self.shown))?;
        if !status.success() {
            bail!("`{}` failed ({status})", self.shown);
        }
        Ok(())
    }

    /// Runs it unseen and gives what it printed on stdout; an error, with its stderr, unless it exits with 0.
    pub(crate) fn output(mut self) -> Result<String> {
        let output = self.command.output().with_context(|| format!("cannot start `{}`", self.shown))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            bail!("`{}` failed ({}): {}", self.shown, output.status, said.trim());
        }
        String::from_utf8(output.stdout).with_context(|| format!("`{}` printed no UTF-8", self.shown))
    }
}

/// Whether a program of this name is on the search path.
pub(crate) fn on_path(name: &str) -> bool {
    std::env::var_os("PATH").is_some_and(|path| is_in(&path, name))
}

fn is_in(path: &OsStr, name: &str) -> bool {
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(path).any(|folder| folder.join(&file).is_file())
}

/// Whether a cargo subcommand is installed: on the search path, or where `cargo install` puts it.
pub(crate) fn has_cargo_command(name: &str) -> bool {
    Run::cargo().args([name, "--version"]).output().is_ok()
}

/// Whether this is continuous integration, where nothing may be skipped.
pub(crate) fn is_ci() -> bool {
    std::env::var("CI").as_deref() == Ok("true")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn output_of_a_program() {
        assert!(Run::cargo().arg("--version").output().unwrap().starts_with("cargo "));
    }

    #[test]
    fn failing_program_is_an_error_that_names_it() {
        let error = Run::cargo().arg("no-such-command-here").output().unwrap_err().to_string();
        assert!(error.contains("cargo no-such-command-here"), "{error}");
    }

    #[test]
    fn program_in_one_of_the_folders() {
        let me = std::env::current_exe().unwrap();
        let path = std::env::join_paths([Path::new("no-such-folder"), me.parent().unwrap()]).unwrap();
        assert!(is_in(&path, me.file_stem().unwrap().to_str().unwrap()));
        assert!(!is_in(&path, "no-such-program-here"));
    }

    #[test]
    fn subcommand_that_nobody_has() {
        assert!(!has_cargo_command("no-such-command-here"));
    }
}
