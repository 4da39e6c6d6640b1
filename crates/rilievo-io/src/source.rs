//! Bytes with a name for messages.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::error::{Error, Result};
use crate::limits::Limits;

/// A whole file in memory, and what to call it in messages.
#[derive(Debug, Clone)]
pub struct Source {
    name: String,
    bytes: Vec<u8>,
}

impl Source {
    /// Reads a file; `-` is the standard input.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read (a directory, too), [`Error::Limits`] if it is longer than allowed; the size
    /// is checked before anything is read, and again while reading, since pipes do not tell theirs.
    pub fn open(path: &Path, limits: &Limits) -> Result<Self> {
        if path == Path::new("-") {
            return Self::read("standard input", io::stdin().lock(), limits);
        }
        let name = path.display().to_string();
        let file = File::open(path).map_err(|e| Error::read(&name, e))?;
        let about = file.metadata().map_err(|e| Error::read(&name, e))?;
        if about.is_dir() {
            let e = io::Error::new(io::ErrorKind::IsADirectory, "is a directory; name a file in it");
            return Err(Error::read(&name, e));
        }
        check_length(&name, about.len(), limits)?;
        Self::read(&name, file, limits)
    }

    /// Wraps bytes that are already in memory.
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes }
    }

    /// What the file is called in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The contents.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn read(name: &str, from: impl Read, limits: &Limits) -> Result<Self> {
        let mut bytes = Vec::new();
        let most = limits.max_file_bytes.saturating_add(1);
        from.take(most).read_to_end(&mut bytes).map_err(|e| Error::read(name, e))?;
        check_length(name, bytes.len() as u64, limits)?;
        Ok(Self { name: name.to_owned(), bytes })
    }
}

fn check_length(name: &str, length: u64, limits: &Limits) -> Result<()> {
    if length > limits.max_file_bytes {
        return Err(Error::limits(name, format!("a file of {length} bytes"), limits.max_file_bytes));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_refuses_directories_missing_and_long_files() {
        let folder = tempfile::tempdir().unwrap();
        let limits = Limits { max_file_bytes: 4, ..Limits::default() };
        let message = |p: &Path| Source::open(p, &limits).unwrap_err().to_string();
        let Err(Error::Io { source, .. }) = Source::open(folder.path(), &limits) else { panic!("a directory opens") };
        assert!(source.kind() == io::ErrorKind::IsADirectory && source.to_string().contains("name a file"));
        let file = folder.path().join("a");
        assert!(matches!(Source::open(&file, &limits), Err(Error::Io { .. })));
        std::fs::write(&file, b"12345").unwrap();
        assert!(matches!(Source::open(&file, &limits), Err(Error::Limits { .. })));
        assert!(message(&file).contains("5 bytes"));
        std::fs::write(&file, b"1234").unwrap();
        assert_eq!(Source::open(&file, &limits).unwrap().bytes(), b"1234");
    }

    #[test]
    fn a_stream_longer_than_allowed_is_cut_off() {
        let limits = Limits { max_file_bytes: 10, ..Limits::default() };
        assert!(matches!(Source::read("pipe", io::repeat(0), &limits), Err(Error::Limits { .. })));
    }
}
