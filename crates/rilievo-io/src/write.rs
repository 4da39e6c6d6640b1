//! Files out: whole, or not at all.

use std::fs::{File, OpenOptions};
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
        return out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| Error::write("standard output", e));
    }
    replace(path, bytes).map_err(|e| Error::write(&path.display().to_string(), e))
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
    let mut options = File::options();
    options.write(true).create_new(true);
    set_permissions(&mut options, &target);
    // Opened and filled by the standard library's own calls: the errors of tempfile's name the temporary file, of which
    // the user knows nothing.
    let mut builder = tempfile::Builder::new();
    let mut file = builder.prefix(".rilievo-").suffix(".part").make_in(folder, |part| options.open(part))?;
    file.as_file_mut().write_all(bytes)?;
    file.persist(&target).map_err(|e| e.error)?;
    Ok(())
}

/// The result should be as readable as any other new file, or as the file it replaces.
#[cfg(unix)]
fn set_permissions(options: &mut OpenOptions, target: &Path) {
    use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
    let mode = target.metadata().map_or(0o666, |about| about.permissions().mode() & 0o777);
    options.mode(mode);
}

#[cfg(not(unix))]
fn set_permissions(_: &mut OpenOptions, _: &Path) {}

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
        let missing = folder.path().join("no/map.png");
        let Err(Error::Io { name, source, .. }) = write_atomic(&missing, b"x") else { panic!("it is written") };
        assert_eq!((name, source.kind()), (missing.display().to_string(), io::ErrorKind::NotFound));
        assert!(!source.to_string().contains(".part"), "{source}");
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
