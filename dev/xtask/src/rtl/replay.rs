//! Replays pixels through the simulated hardware, against the model.

use anyhow::{Context, Result, bail};
use rilievo_polar::Sample;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::{Bench, Unit, sources};
use crate::run::Run;
use crate::workspace::root;

/// Random pixels are the same in every run.
const SEED: u64 = 20_001;

/// A unit as a program that reads pixels.
struct Simulator {
    program: PathBuf,
    /// Where its tables are, in `rom`.
    folder: PathBuf,
}

/// Pixels as words, and what the model makes of them.
struct Expected {
    words: Vec<Vec<u16>>,
    products: Vec<[u16; 2]>,
}

/// Corners and random pixels must agree to the bit, at a pixel a clock and with gaps; and a table with one wrong word must be
/// noticed, or the comparison compares nothing.
pub(super) fn run(bench: &Bench, unit: &Unit, samples: usize) -> Result<()> {
    let simulator = build(bench, unit)?;
    let expected = expected(unit, samples);
    let input = bench.folder.join(format!("{}.txt", unit.kind));
    write_words(&input, &expected.words)?;

    let (found, clocks) = simulator.replay(&input, false)?;
    if let Some(difference) = difference(unit, &expected, &found) {
        bail!("{difference}");
    }
    let [taken, latency] = clocks;
    let count = expected.words.len() as u64;
    if taken != count + latency - 1 {
        bail!("{}: {count} pixels took {taken} clocks: not one a clock after the first {latency}", unit.kind);
    }
    let (with_gaps, _) = simulator.replay(&input, true)?;
    if let Some(difference) = difference(unit, &expected, &with_gaps) {
        bail!("with gaps between pixels: {difference}");
    }
    let guarded = guard(bench, unit, &simulator, &expected, &input)?;
    eprintln!(
        "{}: {count} pixels to the bit, one a clock, latency {latency}; with gaps too; a wrong word in any of {guarded} tables is noticed",
        unit.kind
    );
    Ok(())
}

fn build(bench: &Bench, unit: &Unit) -> Result<Simulator> {
    let folder = bench.folder.join(unit.kind.name());
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let header = folder.join("unit.h");
    fs::write(&header, ports(unit)).with_context(|| header.display().to_string())?;
    Run::new("verilator")
        .args(["--cc", "--exe", "--build", "-O3", "-Wall", "--prefix", "Vunit", "--top-module", unit.kind.name()])
        .arg(format!("-GA={}", bench.width.bits()))
        .arg("--Mdir")
        .arg(&folder)
        .args(["-CFLAGS", "-O2"])
        .args(sources()?)
        .arg(root().join("rtl/bench/replay.cpp"))
        .output()?;
    Ok(Simulator { program: folder.join("Vunit"), folder: bench.folder.clone() })
}

/// How the test bench sets a unit's ports: their names and order are the model's.
fn ports(unit: &Unit) -> String {
    let ports = unit.kind.ports();
    let set: String = ports.iter().enumerate().map(|(i, port)| format!("  unit.{port} = words[{i}];\n")).collect();
    format!(
        "#define UNIT_WORDS {}\nstatic inline void drive(Vunit& unit, const uint16_t* words) {{\n{set}}}\n",
        ports.len()
    )
}

fn expected(unit: &Unit, samples: usize) -> Expected {
    let pixels = Sample::corners().chain(Sample::random(SEED).take(samples));
    let words: Vec<Vec<u16>> = pixels.map(|pixel| pixel.words(unit.kind)).collect();
    let products = words.iter().map(|words| unit.model.products(words).map(|p| p as u16)).collect();
    Expected { words, products }
}

fn write_words(path: &Path, pixels: &[Vec<u16>]) -> Result<()> {
    let mut text = String::new();
    for words in pixels {
        for word in words {
            // Writing to a string cannot fail.
            let _ = write!(text, "{word:04x} ");
        }
        text.push('\n');
    }
    fs::write(path, text).with_context(|| path.display().to_string())
}

impl Simulator {
    /// Products of all pixels; the clocks they took, and how many a pixel takes.
    fn replay(&self, input: &Path, bubbles: bool) -> Result<(Vec<[u16; 2]>, [u64; 2])> {
        let pixels = File::open(input).with_context(|| input.display().to_string())?;
        let mut run = Run::new(&self.program).current_dir(&self.folder).stdin(pixels);
        if bubbles {
            run = run.arg("bubbles");
        }
        let said = run.output()?;
        let (products, clocks) = said.rsplit_once("// ").context("the simulator did not say how long it took")?;
        let clocks = pair(clocks, 10).context("the simulator's last line is not two numbers")?;
        let products = products.lines().map(|line| pair(line, 16).map(|pair| pair.map(|word| word as u16)));
        let products = products.collect::<Option<_>>().context("the simulator printed something else than products")?;
        Ok((products, clocks))
    }
}

fn pair(line: &str, radix: u32) -> Option<[u64; 2]> {
    let (a, b) = line.trim().split_once(' ')?;
    Some([u64::from_str_radix(a, radix).ok()?, u64::from_str_radix(b, radix).ok()?])
}

/// The first pixel that is not as expected, in words.
fn difference(unit: &Unit, expected: &Expected, found: &[[u16; 2]]) -> Option<String> {
    if found.len() != expected.products.len() {
        return Some(format!("{}: {} pixels in, {} out", unit.kind, expected.products.len(), found.len()));
    }
    let at = expected.products.iter().zip(found).position(|(expected, found)| expected != found)?;
    let words = unit.kind.ports().iter().zip(&expected.words[at]).map(|(port, word)| format!("{port} {word:04x}"));
    Some(format!(
        "{}: pixel {at} ({}): the model has {:04x?}, the hardware {:04x?}",
        unit.kind,
        words.collect::<Vec<_>>().join(", "),
        expected.products[at],
        found[at]
    ))
}

/// Flips a bit of each table the unit reads, one at a time, and sees that the pixels show it. Gives how many tables there are.
fn guard(bench: &Bench, unit: &Unit, simulator: &Simulator, expected: &Expected, input: &Path) -> Result<usize> {
    let folder = bench.folder.join("wrong");
    let whole = super::roms::of(&bench.units);
    let mut guarded = 0;
    for (name, text) in &super::roms::of(std::slice::from_ref(unit)) {
        if !is_read(unit, name) {
            continue;
        }
        let mut wrong = whole.clone();
        wrong.insert(name.clone(), with_wrong_word(text));
        super::roms::write(&wrong, &folder.join("rom"))?;
        let broken = Simulator { program: simulator.program.clone(), folder: folder.clone() };
        let (found, _) = broken.replay(input, false)?;
        if difference(unit, expected, &found).is_none() {
            bail!(
                "{}: with a wrong word in {name} all pixels are still right: the replay does not see this table",
                unit.kind
            );
        }
        guarded += 1;
    }
    Ok(guarded)
}

/// Whether the hardware of a unit reads a table: E3 needs no sine beside its cosines.
fn is_read(unit: &Unit, name: &str) -> bool {
    !(unit.kind == rilievo_polar::UnitKind::E3 && name == "sine_cosine.hex")
}

/// A table with one bit flipped in the middle of its second half, where all kinds of tables are read.
fn with_wrong_word(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let at = lines.len() * 5 / 8;
    let flipped = |line: &str| {
        let width = line.len();
        let word = u32::from_str_radix(line, 16).unwrap_or_default() ^ (1 << 7);
        format!("{word:0width$x}\n")
    };
    lines.iter().enumerate().map(|(i, line)| if i == at { flipped(line) } else { format!("{line}\n") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_word_is_made_wrong() {
        let text = "0001\n0002\n0003\n0004\n";
        assert_eq!(with_wrong_word(text), "0001\n0002\n0083\n0004\n");
        assert_eq!(with_wrong_word("40000000\n"), "40000080\n");
    }

    #[test]
    fn pairs_of_numbers() {
        assert_eq!(pair(" 00ff 10\n", 16), Some([255, 16]));
        assert_eq!((pair("1", 10), pair("a b", 10)), (None, None));
    }
}
