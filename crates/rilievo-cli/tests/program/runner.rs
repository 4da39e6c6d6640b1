//! Runs the program in a fresh folder.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::{Convention, Edges, Grid};

/// A folder of its own, gone when dropped.
pub(crate) struct Room {
    folder: tempfile::TempDir,
}

/// What the program said.
#[derive(Debug)]
pub(crate) struct Said {
    pub(crate) code: i32,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

impl Said {
    /// The one JSON object on stdout.
    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.stdout).unwrap_or_else(|e| panic!("{e}: {self:?}"))
    }

    /// Fails the test unless the program ended well.
    pub(crate) fn ok(self) -> Self {
        assert_eq!(self.code, 0, "{}", self.stderr);
        self
    }

    /// Fails the test unless the program ended well and named all of `words` on stderr.
    pub(crate) fn warns(self, words: &[&str]) {
        self.fails(0, words);
    }

    /// Fails the test unless the program ended with this code and named all of `words` on stderr.
    pub(crate) fn fails(self, code: i32, words: &[&str]) {
        assert_eq!(self.code, code, "{}", self.stderr);
        for word in words {
            assert!(self.stderr.contains(word), "no {word:?} in: {}", self.stderr);
        }
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
    }
}

impl Room {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}; there is {:?}", self.files()))
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs `rilievo` with arguments separated by spaces.
    pub(crate) fn run(&self, args: &str) -> Said {
        self.run_with(&args.split_whitespace().map(Path::new).collect::<Vec<_>>(), &[])
    }

    /// Runs `rilievo` with these arguments and this standard input.
    pub(crate) fn run_with(&self, args: &[&Path], stdin: &[u8]) -> Said {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rilievo"))
            .args(args)
            .current_dir(self.folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut input = child.stdin.take().unwrap();
        let bytes = stdin.to_vec();
        // The program may end without reading all of it.
        let feeding = std::thread::spawn(move || drop(input.write_all(&bytes)));
        let output = child.wait_with_output().unwrap();
        feeding.join().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        Said { code: output.status.code().unwrap_or(-1), stdout: output.stdout, stderr }
    }

    /// Writes a 64 × 48 height map with a round bump off the centre.
    pub(crate) fn bump(&self, name: &str) -> PathBuf {
        self.write(name, &rilievo_io::encode_gray_png16(&bump()).unwrap())
    }

    /// Writes the tangent-space normal map of [`Room::bump`].
    pub(crate) fn bump_normals(&self, name: &str) -> PathBuf {
        let map = HeightMap::new(bump(), 0.1).unwrap();
        let normals = to_normals(&map, Filter::Plane4, Edges::Wrap);
        self.write(name, &rilievo_io::encode_normals_png16(&normals, Convention::Gl, None).unwrap())
    }
}

/// A smooth hill: highest at (20, 20), flat beyond a radius of 16.
fn bump() -> Grid<f32> {
    Grid::from_fn(64, 48, |x, y| {
        let r = (x as f32 - 20.0).hypot(y as f32 - 20.0) / 16.0;
        if r < 1.0 { (1.0 - r * r).powi(2) } else { 0.0 }
    })
    .unwrap()
}
