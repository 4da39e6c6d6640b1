//! Which flags the user wrote, as against those that have a default.

use std::collections::HashSet;

use clap::ArgMatches;
use clap::parser::ValueSource;

use crate::exit;

/// The flags of a command that stand on the command line, by their long names with underscores.
#[derive(Debug, Default)]
pub(crate) struct Given(HashSet<String>);

impl Given {
    /// The flags of the subcommand.
    pub(crate) fn of(matches: &ArgMatches) -> Self {
        let Some((_, command)) = matches.subcommand() else { return Self::default() };
        let written = |id: &&clap::Id| command.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        Self(command.ids().filter(written).map(ToString::to_string).collect())
    }

    /// Whether the user wrote this flag.
    pub(crate) fn has(&self, flag: &str) -> bool {
        self.0.contains(flag)
    }

    /// Warns of flags that were written but play no part, so that none is silently ignored.
    pub(crate) fn unused(&self, flags: &[&str], why: &str) {
        for flag in flags.iter().filter(|f| self.has(f)) {
            let name = if *flag == "entries" { "-n".to_owned() } else { format!("--{}", flag.replace('_', "-")) };
            exit::warn(&name, &format!("not used: {why}"));
        }
    }
}
