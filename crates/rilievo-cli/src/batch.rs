//! Several inputs: one bad file does not stop the rest, and the exit code tells.

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::exit::{self, Outcome, usage};

/// Runs `work` on each input with the output path it gets; keeps going after errors.
///
/// `-o` names a file for one input and a folder for several (or if it is a folder already); without it outputs stand
/// beside their inputs, under the name that `name` makes. Nothing is read before the outputs are known to be apart from
/// each other and from everything that is `also_read`, and to have one of the `extensions`.
pub(crate) fn run(
    inputs: &[PathBuf],
    output: Option<&Path>,
    extensions: &[&str],
    also_read: &[&Path],
    name: impl Fn(&Path) -> String,
    mut work: impl FnMut(&Path, &Path) -> Result<Outcome>,
) -> Result<Outcome> {
    let is_folder = output.is_some_and(Path::is_dir);
    if inputs.len() > 1 && output.is_some() && !is_folder {
        return Err(usage("with several inputs, -o names an existing folder"));
    }
    let output_of = |input: &PathBuf| match output {
        Some(folder) if is_folder => folder.join(name(input)),
        Some(file) => file.to_owned(),
        None if input.as_os_str() == "-" => PathBuf::from("-"),
        None => input.with_file_name(name(input)),
    };
    let outputs: Vec<PathBuf> = inputs.iter().map(output_of).collect();
    for (i, out) in outputs.iter().enumerate() {
        if let Some(first) = outputs[..i].iter().position(|o| same_file(o, out)) {
            let (a, b) = (inputs[first].display(), inputs[i].display());
            return Err(usage(format!("{a} and {b} would both be written to {}; run them apart", out.display())));
        }
        let read: Vec<&Path> = inputs.iter().map(PathBuf::as_path).chain(also_read.iter().copied()).collect();
        check_output(out, extensions, &read)?;
    }
    let mut worst = Outcome::Done;
    for (input, out) in inputs.iter().zip(&outputs) {
        match work(input, out).map_err(|e| named(e, input)) {
            Ok(Outcome::Done) => {}
            Ok(other) => worst = worst.or_worse(other),
            Err(error) if inputs.len() == 1 => return Err(error),
            Err(error) => {
                if let Some(code) = exit::show(&error) {
                    worst = worst.or_worse(Outcome::Failed(code));
                }
            }
        }
    }
    Ok(worst)
}

/// Fails if `output` would replace something that is read, or says by its extension that it is something else.
pub(crate) fn check_output(output: &Path, extensions: &[&str], read: &[&Path]) -> Result<()> {
    if output.as_os_str() == "-" {
        return Ok(());
    }
    if let Some(input) = read.iter().find(|r| same_file(r, output)) {
        return Err(usage(format!("{} would be replaced by the output; choose another -o", input.display())));
    }
    // Devices and pipes have no kind.
    if output.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        return Ok(());
    }
    let extension = output.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if extensions.contains(&extension.as_str()) {
        return Ok(());
    }
    let kinds: Vec<String> = extensions.iter().map(|e| format!(".{e}")).collect();
    Err(usage(format!("{}: write to a {} file", output.display(), kinds.join(" or a "))))
}

/// Whether two paths lead to one file; files that are not there yet are told by their folder and name.
fn same_file(a: &Path, b: &Path) -> bool {
    let real = |p: &Path| {
        let parent = p.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let whole = p.canonicalize().ok();
        whole.or_else(|| Some(parent.canonicalize().ok()?.join(p.file_name()?)))
    };
    a.as_os_str() != "-" && real(a).is_some_and(|a| real(b) == Some(a))
}

/// Errors of the library do not know which file they are about; errors of files do.
pub(crate) fn named(error: anyhow::Error, input: &Path) -> anyhow::Error {
    if error.chain().any(|cause| cause.is::<rilievo_io::Error>() || cause.is::<exit::Usage>()) {
        return error;
    }
    error.context(input.display().to_string())
}

/// The file name without folder and extension; for names of outputs.
pub(crate) fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    // stdin has no name to build on.
    if stem == "-" { "stdin".to_owned() } else { stem.to_string_lossy().into_owned() }
}
