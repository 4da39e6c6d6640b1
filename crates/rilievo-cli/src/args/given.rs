//! What the user wrote, as against what has a default: flags, or keys of a scene file.

use std::collections::HashMap;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};

use crate::exit;

/// What was written, by the long names of flags with underscores, and how each is called in messages.
#[derive(Debug, Clone, Default)]
pub(crate) struct Given {
    written: HashMap<String, String>,
    /// What is not warned of.
    excused: Vec<String>,
}

impl Given {
    /// The flags of the subcommand of `program`.
    pub(crate) fn of(program: &Command, matches: &ArgMatches) -> Self {
        let Some((name, matches)) = matches.subcommand() else { return Self::default() };
        let flags = program.find_subcommand(name).into_iter().flat_map(Command::get_arguments);
        let written =
            flags.filter(|flag| matches.value_source(flag.get_id().as_str()) == Some(ValueSource::CommandLine));
        let written = written.map(|flag| (flag.get_id().to_string(), called(flag))).collect();
        Self { written, excused: Vec::new() }
    }

    /// Notes that something was written, and how messages call it.
    pub(crate) fn add(&mut self, name: &str, called: impl Into<String>) {
        self.written.insert(name.to_owned(), called.into());
    }

    /// Does not warn of these: what makes them play no part was decided elsewhere.
    pub(crate) fn excuse(&mut self, names: &[&str]) {
        self.excused.extend(names.iter().map(ToString::to_string));
    }

    /// Whether the user wrote this.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.written.contains_key(name)
    }

    /// How messages call what was written: `--depth`, or the place in a scene file.
    pub(crate) fn called<'a>(&'a self, name: &'a str) -> &'a str {
        self.written.get(name).map_or(name, String::as_str)
    }

    /// Warns of what was written but plays no part, so that nothing is silently ignored.
    pub(crate) fn unused(&self, names: &[&str], why: &str) {
        let told = names.iter().filter(|name| !self.excused.iter().any(|e| e == *name));
        for called in told.filter_map(|name| self.written.get(*name)) {
            exit::warn(called, &format!("not used: {why}"));
        }
    }

    /// [`Self::unused`] for everything that was written but `used`.
    pub(crate) fn unused_but(&self, used: &[&str], why: &str) {
        let mut names: Vec<&str> =
            self.written.keys().map(String::as_str).filter(|name| !used.contains(name)).collect();
        names.sort_unstable();
        self.unused(&names, why);
    }
}

/// How messages call a flag: by its short name if that is the better known one.
fn called(flag: &Arg) -> String {
    match (flag.get_id().as_str(), flag.get_long()) {
        ("entries", _) => "-n".to_owned(),
        (_, Some(long)) => format!("--{long}"),
        (id, None) => id.to_owned(),
    }
}
