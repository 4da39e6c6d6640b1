//! Other people's quantisers, run as their users run them: whole processes on files, one thread each.
//!
//! They are made for colours; a normal map is a picture to them. faiss gets the distinct directions with their weights.
//! A peer that is not installed is told and left out.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use rilievo::normal::decode_u8;
use rilievo::{Convention, Grid, NormalMap, Object};
use rilievo_io::{Limits, Source, decode_normals};

/// A program, ready to quantise the map to a number of entries.
pub(super) struct Peer {
    pub(super) name: &'static str,
    /// The most entries it can, or can in a time that one would wait for.
    pub(super) most: u32,
    /// What to install where it is missing.
    pub(super) install: &'static str,
    pub(super) note: &'static str,
    probe: &'static [&'static str],
    command: fn(&Files, u32) -> Command,
    result: fn(&Files) -> PathBuf,
}

/// The input in two formats and a place for outputs; removed when dropped.
pub(super) struct Files {
    folder: PathBuf,
}

impl Drop for Files {
    fn drop(&mut self) {
        // What is left behind in a temporary folder harms nobody.
        drop(fs::remove_dir_all(&self.folder));
    }
}

impl Files {
    /// Writes the map where peers find it.
    pub(super) fn new(codes: &Grid<[u8; 3]>) -> Result<Self> {
        let shm = Path::new("/dev/shm");
        let parent = if shm.is_dir() { shm.to_owned() } else { std::env::temp_dir() };
        let folder = parent.join(format!("rilievo-bench-{}", std::process::id()));
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        let files = Self { folder };
        let mut ppm = format!("P6\n{} {}\n255\n", codes.width(), codes.height()).into_bytes();
        ppm.extend(codes.texels().as_flattened());
        fs::write(files.path("in.ppm"), ppm)?;
        fs::write(files.path("kmeans.py"), KMEANS)?;
        Ok(files)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

/// Spherical k-means on the distinct normals; every texel then has the nearest centroid.
const KMEANS: &str = "
import sys, numpy as np, faiss
faiss.omp_set_num_threads(1)
data = open(sys.argv[1], 'rb').read()
w, h = map(int, data.split(b'\\n', 2)[1].split())
px = np.frombuffer(data[-w * h * 3:], dtype=np.uint8).reshape(-1, 3)
codes = px.astype(np.uint32) @ np.array([65536, 256, 1], dtype=np.uint32)
distinct, where, counts = np.unique(codes, return_inverse=True, return_counts=True)
rgb = np.stack([distinct >> 16, distinct >> 8 & 255, distinct & 255], axis=1)
n = rgb.astype(np.float32) * 2 - 255
n /= np.linalg.norm(n, axis=1, keepdims=True)
k = int(sys.argv[3])
km = faiss.Kmeans(3, k, niter=20, spherical=True, seed=1, max_points_per_centroid=10**9, min_points_per_centroid=1)
km.train(np.ascontiguousarray(n), weights=counts.astype(np.float32))
_, who = km.index.search(np.ascontiguousarray(n), 1)
km.centroids.reshape(k, 3)[who[where.ravel(), 0]].astype('<f4').tofile(sys.argv[2])
";

pub(super) const PEERS: [Peer; 4] = [
    Peer {
        name: "netpbm",
        most: 65_536,
        install: "apt-get install netpbm",
        note: "pnmquant -nofloyd, PPM to PPM",
        probe: &["pnmquant", "--version"],
        command: |files, entries| {
            let mut command = Command::new("sh");
            command.arg("-c").arg("pnmquant -nofloyd \"$1\" \"$2\" > \"$3\"").arg("sh").arg(entries.to_string());
            command.args([files.path("in.ppm"), files.path("out.ppm")]);
            command
        },
        result: |files| files.path("out.ppm"),
    },
    Peer {
        name: "pngquant",
        most: 256,
        install: "apt-get install pngquant",
        note: "libimagequant, --nofs --speed 4, PNG to PNG",
        probe: &["pngquant", "--version"],
        command: |files, entries| {
            let mut command = Command::new("pngquant");
            command.args(["--nofs", "--speed", "4", "--force", "--output"]).arg(files.path("out.png"));
            command.arg(entries.to_string()).arg(files.path("in.png"));
            // Its thread pool would hide what it costs from nobody, but waits in it would count.
            command.env("OMP_NUM_THREADS", "1");
            command
        },
        result: |files| files.path("out.png"),
    },
    Peer {
        name: "imagemagick",
        most: 256,
        install: "apt-get install imagemagick",
        note: "convert +dither -colors K",
        probe: &["/usr/bin/convert", "-version"],
        command: |files, entries| {
            let mut command = Command::new("/usr/bin/convert");
            command.arg(files.path("in.ppm")).args(["-limit", "thread", "1", "+dither", "-colors"]);
            command.arg(entries.to_string()).args(["-depth", "8"]).arg(files.path("out.ppm"));
            command
        },
        result: |files| files.path("out.ppm"),
    },
    Peer {
        name: "faiss",
        most: 2048,
        install: "pip install faiss-cpu numpy",
        note: "spherical k-means of 20 rounds on the distinct normals, through Python",
        probe: &["python3", "-c", "import faiss, numpy"],
        command: |files, entries| {
            let mut command = Command::new("python3");
            command.args([files.path("kmeans.py"), files.path("in.ppm"), files.path("out.f32")]);
            command.arg(entries.to_string());
            command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
            command
        },
        result: |files| files.path("out.f32"),
    },
];

impl Peer {
    /// Whether the program is there.
    pub(super) fn is_installed(&self) -> bool {
        let [program, arguments @ ..] = self.probe else { return false };
        let quiet = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
        quiet.is_ok_and(|status| status.success())
    }

    /// Quantises the map once.
    pub(super) fn run(&self, files: &Files, entries: u32) -> Result<()> {
        let done = (self.command)(files, entries).stdout(Stdio::null()).stderr(Stdio::piped()).output();
        let done = done.with_context(|| self.name.to_owned())?;
        ensure!(done.status.success(), "{} failed: {}", self.name, String::from_utf8_lossy(&done.stderr));
        Ok(())
    }

    /// What it made of the map, as unit normals.
    pub(super) fn result(&self, files: &Files, size: (u32, u32)) -> Result<NormalMap<Object>> {
        let path = (self.result)(files);
        let texels = size.0 as usize * size.1 as usize;
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        let normals = match path.extension().and_then(|e| e.to_str()) {
            Some("ppm") => {
                ensure!(bytes.starts_with(b"P6") && bytes.len() > 3 * texels, "{}: not a PPM of 8 bits", self.name);
                bytes[bytes.len() - 3 * texels..].as_chunks().0.iter().map(|&c| decode_u8(c)).collect()
            }
            Some("f32") => {
                let floats: Vec<f32> = bytes.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect();
                floats.as_chunks().0.iter().map(|&v| rilievo::Normal::new_or(v.into(), rilievo::Normal::Z)).collect()
            }
            _ => {
                let limits = Limits::default();
                return Ok(decode_normals(&Source::from_bytes(self.name, bytes), Convention::Gl, &limits)?.normals);
            }
        };
        Ok(Grid::new(size.0, size.1, normals)?)
    }

    /// Gives the peers that read PNG the same file as it was.
    pub(super) fn give_png(files: &Files, png: &Path) -> Result<()> {
        fs::copy(png, files.path("in.png")).with_context(|| png.display().to_string()).map(drop)
    }
}
