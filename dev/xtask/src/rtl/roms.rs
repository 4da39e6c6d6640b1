//! The contents of the tables, as files for `$readmemh`.

use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::Unit;

/// File names and contents.
pub(super) type Roms = BTreeMap<String, String>;

/// All tables of some units, each once, and the sine and cosine side by side that those read which need both.
pub(super) fn of(units: &[Unit]) -> Roms {
    let mut roms = Roms::new();
    for rom in units.iter().flat_map(|unit| unit.model.roms()) {
        let name = format!("{}.hex", rom.name().replace('-', "_"));
        if rom.name() == "sine" {
            roms.insert("sine_cosine.hex".to_owned(), pairs(rom.words()));
        }
        roms.insert(name, rom.words().iter().map(|word| format!("{word:04x}\n")).collect());
    }
    roms
}

/// Cosine and sine of each step of a quarter turn, in one word of 32 bits. The cosine is the sine read from the other end, and 1 at
/// the first step.
fn pairs(sine: &[u16]) -> String {
    let cosine = |at: usize| if at == 0 { 1 << rilievo_polar::FRACTION } else { sine[sine.len() - at] };
    (0..sine.len()).map(|at| format!("{:04x}{:04x}\n", cosine(at), sine[at])).collect()
}

/// Writes all tables; what else is in the folder is left alone.
pub(super) fn write(roms: &Roms, folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    for (name, text) in roms {
        let path = folder.join(name);
        fs::write(&path, text).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// An error unless the folder holds these tables and no others.
pub(super) fn check(roms: &Roms, folder: &Path) -> Result<()> {
    const REMEDY: &str = "run `cargo xtask rtl --write` and look at the difference";
    for (name, text) in roms {
        let path = folder.join(name);
        let found = fs::read_to_string(&path).with_context(|| format!("{}: {REMEDY}", path.display()))?;
        if let Some(line) = first_difference(&found, text) {
            bail!("{}, line {line}: not what the model has; {REMEDY}", path.display());
        }
    }
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if !roms.contains_key(&name) {
            bail!("{}: no unit reads this table; remove it", folder.join(name).display());
        }
    }
    Ok(())
}

/// The first line, from 1, in which two texts differ. A checkout may have changed the ends of lines.
fn first_difference(a: &str, b: &str) -> Option<usize> {
    let (mut a, mut b) = (a.lines(), b.lines());
    (1..).find_map(|line| match (a.next(), b.next()) {
        (None, None) => Some(None),
        (x, y) if x != y => Some(Some(line)),
        _ => None,
    })?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_differences_are_found() {
        assert_eq!(first_difference("a\nb\n", "a\r\nb\r\n"), None);
        assert_eq!(first_difference("a\nb\n", "a\nc\n"), Some(2));
        assert_eq!(first_difference("a\n", "a\nb\n"), Some(2));
        assert_eq!(first_difference("", ""), None);
    }

    #[test]
    fn sine_and_cosine_stand_side_by_side() {
        assert_eq!(pairs(&[0, 0x1000, 0x2000, 0x3000]), "40000000\n30001000\n20002000\n10003000\n");
    }
}
