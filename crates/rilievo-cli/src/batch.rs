//! Several inputs: one bad file does not stop the rest, and the exit code tells.

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::exit::{self, Outcome, usage};

/// Runs `work` on each input with the output path it gets; keeps going after errors.
///
/// `-o` names a file for one input and a folder for several (or if it is a folder already); without it outputs stand
/// beside their inputs, named by `suffix` and `extension`.
pub(crate) fn run(
    inputs: &[PathBuf],
    output: Option<&Path>,
    name: impl Fn(&Path) -> String,
    mut work: impl FnMut(&Path, &Path) -> Result<Outcome>,
) -> Result<Outcome> {
    let is_folder = output.is_some_and(Path::is_dir);
    if inputs.len() > 1 && output.is_some() && !is_folder {
        return Err(usage("with several inputs, -o names an existing folder"));
    }
    let mut worst = Outcome::Done;
    for input in inputs {
        let out = match output {
            Some(folder) if is_folder => folder.join(name(input)),
            Some(file) => file.to_owned(),
            None if input.as_os_str() == "-" => PathBuf::from("-"),
            None => input.with_file_name(name(input)),
        };
        match work(input, &out) {
            Ok(Outcome::Done) => {}
            Ok(other) => worst = other,
            Err(error) if inputs.len() == 1 => return Err(error),
            Err(error) => {
                if let Some(code) = exit::show(&error) {
                    worst = Outcome::Failed(code);
                }
            }
        }
    }
    Ok(worst)
}

/// The file name without folder and extension; for names of outputs.
pub(crate) fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    // stdin has no name to build on.
    if stem == "-" { "stdin".to_owned() } else { stem.to_string_lossy().into_owned() }
}
