//! The sine: a quarter wave in the table, a whole one where it is run.

use alloc::vec::Vec;

use super::{ONE, Rom, Width};

/// A quarter wave of the sine, and what becomes of it when it is folded.
///
/// Which quadrant an angle is in decides about the address (from the other end) and the sign. Angles are rounded to the
/// nearest of 2^(a+2) steps a turn.
#[derive(Debug, Clone)]
pub(crate) struct Sine {
    rom: Rom,
    /// The folded table at every step of a turn: programs look up faster than they fold.
    wave: Vec<i16>,
    /// Bits of an angle below a step.
    dropped: u32,
}

impl Sine {
    pub(crate) fn new(width: Width) -> Self {
        let rom = Rom::sine(width);
        let wave = (0..4 * width.entries()).map(|step| fold(&rom, step)).collect();
        Self { rom, wave, dropped: 14 - width.bits() }
    }

    pub(crate) fn rom(&self) -> &Rom {
        &self.rom
    }

    /// Sine of an angle, Q2.14.
    #[inline(always)]
    pub(crate) fn at(&self, angle: i64) -> i64 {
        let step = (angle + ((1 << self.dropped) >> 1)) >> self.dropped;
        i64::from(self.wave[step as usize & (self.wave.len() - 1)])
    }
}

/// The value at a step of a turn, from the quarter that is stored. The end of the quarter is wired to 1.
fn fold(rom: &Rom, step: usize) -> i16 {
    let entries = rom.words().len();
    let (quadrant, within) = (step / entries, step % entries);
    let within = if quadrant & 1 == 1 { entries - within } else { within };
    let magnitude = rom.words().get(within).map_or(ONE as i16, |word| *word as i16);
    if quadrant & 2 == 2 { -magnitude } else { magnitude }
}
