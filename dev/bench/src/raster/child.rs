//! A renderer in a process of its own: this program again, told by a hidden argument what to be.
//!
//! So a driver's threads are all in that process's clock and in nobody else's, a driver that crashes takes nothing with
//! it, and each driver finds its own environment. Requests and answers are lines.

use super::renderer::{Job, Renderer, unpack};
use super::scene::SIDE;
use anyhow::{Context, Result, bail, ensure};
use rilievo::color::{Picture, Rgba8};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child as Process, ChildStdin, ChildStdout, Command, Stdio};
use tempfile::TempDir;

/// What the process is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Role {
    /// The scene on the Vulkan driver that the environment names.
    Vulkan,
    /// Our own renderer, as this binary was compiled.
    Ours,
}

/// The other end.
pub(super) struct Child {
    process: Process,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    name: String,
    folder: TempDir,
}

impl Child {
    /// Starts `program`; it is ready, or has said why not, when this returns.
    pub(super) fn start(program: &Path, role: &str, environment: &[(&str, String)]) -> Result<Self> {
        let folder = tempfile::tempdir()?;
        // Read by SwiftShader in the folder it is started in.
        fs::write(folder.path().join("SwiftShader.ini"), "[Processor]\nThreadCount=1\n")?;
        let mut process = Command::new(program)
            .args(["--serve", role])
            .envs(environment.iter().map(|(name, value)| (*name, value)))
            // Some drivers complain if there is none.
            .env("XDG_RUNTIME_DIR", folder.path())
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {}", program.display()))?;
        let requests = process.stdin.take();
        let answers = BufReader::new(process.stdout.take().context("invariant: stdout is piped")?);
        let mut child = Self { process, requests, answers, name: String::new(), folder };
        child.name = child.answer()?;
        Ok(child)
    }

    /// What the renderer calls itself.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    fn ask(&mut self, request: &str) -> Result<String> {
        let requests = self.requests.as_mut().context("the process has ended")?;
        writeln!(requests, "{request}")?;
        requests.flush()?;
        self.answer()
    }

    fn answer(&mut self) -> Result<String> {
        let mut line = String::new();
        self.answers.read_line(&mut line)?;
        match line.trim_end().split_once(' ') {
            Some(("ok", answer)) => Ok(answer.to_owned()),
            Some(("error", why)) => bail!("{why}"),
            _ => bail!("the process ended: {}", self.process.wait()?),
        }
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        // The end of its input is the end of the process.
        self.requests = None;
        drop(self.process.wait());
    }
}

impl Renderer for Child {
    fn draw(&mut self, job: Job, view: usize, frames: usize) -> Result<()> {
        self.ask(&format!("draw {} {view} {frames}", job.to_words())).map(drop)
    }

    fn picture(&mut self) -> Result<Picture> {
        let file = self.folder.path().join("picture");
        self.ask(&format!("picture {}", file.display()))?;
        let bytes = fs::read(&file)?;
        ensure!(bytes.len() == (SIDE * SIDE * 4) as usize, "a picture of {} bytes", bytes.len());
        let packed: Vec<u32> = bytes.chunks_exact(4).map(|p| u32::from_le_bytes([p[0], p[1], p[2], p[3]])).collect();
        unpack(SIDE, &packed)
    }

    /// Taken by the process's own clock.
    fn seconds(&mut self, job: Job) -> Result<f64> {
        Ok(self.ask(&format!("seconds {}", job.to_words()))?.parse()?)
    }
}

/// Does what is asked on stdin until it ends.
pub(crate) fn serve(role: Role) -> Result<()> {
    let mut out = std::io::stdout().lock();
    let mut tell = |answer: Result<String>| -> Result<()> {
        match answer {
            Ok(text) => writeln!(out, "ok {text}")?,
            Err(error) => writeln!(out, "error {}", format!("{error:#}").replace('\n', " "))?,
        }
        Ok(out.flush()?)
    };
    let (mut renderer, name) = match open(role) {
        Ok(opened) => opened,
        Err(error) => return tell(Err(error)),
    };
    tell(Ok(name))?;
    for line in std::io::stdin().lock().lines() {
        tell(obey(&mut *renderer, &line?))?;
    }
    Ok(())
}

fn open(role: Role) -> Result<(Box<dyn Renderer>, String)> {
    match role {
        Role::Ours => Ok((Box::new(super::ours::Ours::new()?), "ours".to_owned())),
        #[cfg(feature = "gpu")]
        Role::Vulkan => {
            let vulkan = super::vulkan::Vulkan::new()?;
            let name = vulkan.name().to_owned();
            Ok((Box::new(vulkan), name))
        }
        #[cfg(not(feature = "gpu"))]
        Role::Vulkan => bail!("built without the feature `gpu`; `cargo xtask bench raster` builds with it"),
    }
}

fn obey(renderer: &mut dyn Renderer, request: &str) -> Result<String> {
    let words: Vec<&str> = request.split(' ').collect();
    let job = |words: &[&str]| Job::from_words(words).with_context(|| format!("not a job: {request}"));
    match words.as_slice() {
        ["draw", what @ .., view, frames] => {
            renderer.draw(job(what)?, view.parse()?, frames.parse()?)?;
            Ok("drawn".to_owned())
        }
        ["seconds", what @ ..] => Ok(renderer.seconds(job(what)?)?.to_string()),
        ["picture", ..] => {
            let file = PathBuf::from(request.trim_start_matches("picture "));
            let picture = renderer.picture()?;
            let bytes: Vec<u8> = picture.texels().iter().flat_map(|&Rgba8 { r, g, b, a }| [r, g, b, a]).collect();
            fs::write(&file, bytes).with_context(|| file.display().to_string())?;
            Ok("written".to_owned())
        }
        _ => bail!("not a request: {request}"),
    }
}
