//! Files out: whole, or not at all.

use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Writes `bytes` to `path`; `-` is the standard output.
///
/// A temporary file in the same folder is filled and then renamed, so that a full disk or an interruption never
/// leaves half a file under the name asked for.
///
/// # Errors
/// [`Error::Io`]; a closed pipe on the standard output too, with `ErrorKind::BrokenPipe`: the caller decides that
/// nobody is listening.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    if path == Path::new("-") {
        let mut out = io::stdout().lock();
        return out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| Error::io("standard output", e));
    }
    replace(path, bytes).map_err(|e| Error::io(&path.display().to_string(), e))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // Renaming over a device or a pipe would replace it by a file.
    if path.metadata().is_ok_and(|about| !about.is_file() && !about.is_dir()) {
        return std::fs::write(path, bytes);
    }
    // A link keeps pointing where it did: its target is what is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rilievo-").suffix(".part");
    set_permissions(&mut builder, &target);
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.persist(&target).map_err(|e| e.error)?;
    Ok(())
}

/// Temporary files are private by default; the result should be as readable as any other new file, or as the file it
/// replaces.
#[cfg(unix)]
fn set_permissions(builder: &mut tempfile::Builder<'_, '_>, target: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let mode = target.metadata().map_or(0o666, |about| about.permissions().mode() & 0o777);
    builder.permissions(std::fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
fn set_permissions(_: &mut tempfile::Builder<'_, '_>, _: &Path) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_replaces_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn write_to_a_missing_folder_or_a_directory_fails_cleanly() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(write_atomic(&folder.path().join("no/map.png"), b"x"), Err(Error::Io { .. })));
        assert!(matches!(write_atomic(folder.path(), b"x"), Err(Error::Io { .. })));
        assert!(folder.path().is_dir());
    }

    #[cfg(unix)]
    #[test]
    fn written_files_keep_permissions_and_links() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("map.png"), folder.path().join("link.png"));
        write_atomic(&path, b"one").unwrap();
        let mode = |p: &Path| p.metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&path) & 0o600, 0o600);
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_atomic(&link, b"two").unwrap();
        assert_eq!((mode(&path), std::fs::read(&path).unwrap()), (0o640, b"two".to_vec()));
        assert!(link.symlink_metadata().unwrap().is_symlink());
    }
}
