//! The units by name, and a unit that runs.

use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use crate::cost::{KIM_SET_UP, KUGLER_ILLUMINATION, KUGLER_SET_UP, Printed, StageCost, UnitCost};
use crate::frame::Frame;
use crate::light::{Diffuse, LightTables, illuminate};
use crate::limit::limit;
use crate::logic::{Count, Logic, Numbers, Stage};
use crate::rom::{Rom, Width};
use crate::unit::{Blinn, E1, E2, E3, E4, E4d, ExactZ, Kim, Kugler, Peercy, Port, Published, Unit, products};

/// The units there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UnitKind {
    /// Blinn's method, eq. (1).
    Blinn,
    /// Peercy's set-up, Ernst's illumination: a matrix and normalisation.
    Peercy,
    /// Kugler's IMEM: a map for the rotation, light maps.
    Kugler,
    /// Kim's: a matrix between polar vectors.
    Kim,
    /// The paper's, with its equations mended.
    Published,
    /// The paper's with exact Z.
    ExactZ,
    /// Exact, polar results.
    E1,
    /// Exact, Cartesian bump vectors.
    E2,
    /// Exact, bump vectors as (ξ, ρ, y).
    E3,
    /// Exact, bump vectors as (ξ, η).
    E4,
    /// E4 for distant lights and viewers.
    E4d,
}

/// How a unit copes with a texture frame that is turned by α about the normal, against its meridian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Twist {
    /// α is added to φ': one adder, and the map holds tangent-space normals as they are.
    Added,
    /// The map holds normals of the meridian frame: α is baked into it.
    Baked,
    /// The unit is given the frame itself.
    Framed,
}

impl UnitKind {
    /// All of them, in the order of history.
    pub const ALL: [Self; 11] = [
        Self::Blinn,
        Self::Peercy,
        Self::Kugler,
        Self::Kim,
        Self::Published,
        Self::ExactZ,
        Self::E1,
        Self::E2,
        Self::E3,
        Self::E4,
        Self::E4d,
    ];

    /// Its name, as in commands and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Blinn => "blinn",
            Self::Peercy => "peercy",
            Self::Kugler => "kugler",
            Self::Kim => "kim",
            Self::Published => "published",
            Self::ExactZ => "exact-z",
            Self::E1 => "e1",
            Self::E2 => "e2",
            Self::E3 => "e3",
            Self::E4 => "e4",
            Self::E4d => "e4d",
        }
    }

    /// What each word of a pixel is, in their order.
    pub fn ports(self) -> &'static [Port] {
        match self {
            Self::Blinn => Blinn::PORTS,
            Self::Peercy => Peercy::PORTS,
            Self::Kugler => Kugler::PORTS,
            Self::Kim => Kim::PORTS,
            Self::Published => Published::PORTS,
            Self::ExactZ => ExactZ::PORTS,
            Self::E1 => E1::PORTS,
            Self::E2 => E2::PORTS,
            Self::E3 => E3::PORTS,
            Self::E4 => E4::PORTS,
            Self::E4d => E4d::PORTS,
        }
    }

    /// Whether the vectors are in tables or maps of the frame: the light and the viewer must be far away.
    pub const fn is_distant(self) -> bool {
        matches!(self, Self::Kugler | Self::E4d)
    }

    /// [`Model::limit`] of a model with tables of a width, without making one.
    pub fn limit(self, width: Width) -> Option<u32> {
        limit(self, width)
    }

    /// How it copes with a turned texture frame.
    pub const fn twist(self) -> Twist {
        match self {
            Self::Blinn | Self::Peercy => Twist::Framed,
            Self::Kugler | Self::Kim | Self::Published | Self::ExactZ | Self::E1 => Twist::Added,
            Self::E2 | Self::E3 | Self::E4 | Self::E4d => Twist::Baked,
        }
    }

    /// Its row of the paper's Table 1. Peercy's illumination is Ernst's, whose set-up is the same.
    pub const fn printed(self) -> Option<Printed> {
        match self {
            Self::Peercy => Some(Printed { set_up: [27, 18, 0], illumination: [7, 5, 1] }),
            Self::Kugler => Some(Printed { set_up: [5, 2, 3], illumination: [8, 4, 5] }),
            Self::Kim => Some(Printed { set_up: [31, 18, 6], illumination: [6, 5, 12] }),
            Self::Published => Some(Printed { set_up: [6, 16, 12], illumination: [2, 11, 8] }),
            _ => None,
        }
    }

    const fn diffuse(self) -> Diffuse {
        match self {
            Self::Blinn | Self::Peercy => Diffuse::Multiplier,
            _ => Diffuse::Table,
        }
    }
}

impl fmt::Display for UnitKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A name that no unit has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnknownUnit;

impl fmt::Display for UnknownUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no such unit; there are ")?;
        for (i, unit) in UnitKind::ALL.into_iter().enumerate() {
            let separator = match i {
                0 => "",
                i if i + 1 == UnitKind::ALL.len() => " and ",
                _ => ", ",
            };
            write!(f, "{separator}{unit}")?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownUnit {}

impl FromStr for UnitKind {
    type Err = UnknownUnit;

    fn from_str(name: &str) -> Result<Self, UnknownUnit> {
        Self::ALL.into_iter().find(|unit| unit.name() == name).ok_or(UnknownUnit)
    }
}

/// A unit with its tables.
#[derive(Debug)]
pub struct Model {
    kind: UnitKind,
    width: Width,
    unit: AnyUnit,
}

#[derive(Debug)]
enum AnyUnit {
    Blinn(Blinn),
    Peercy(Peercy),
    Kugler(Kugler),
    Kim(Kim),
    Published(Published),
    ExactZ(ExactZ),
    E1(E1),
    E2(E2),
    E3(E3),
    E4(E4),
    E4d(E4d),
}

/// Does the same with whichever unit it is.
macro_rules! with_unit {
    ($any:expr, $unit:ident => $do:expr) => {
        match $any {
            AnyUnit::Blinn($unit) => $do,
            AnyUnit::Peercy($unit) => $do,
            AnyUnit::Kugler($unit) => $do,
            AnyUnit::Kim($unit) => $do,
            AnyUnit::Published($unit) => $do,
            AnyUnit::ExactZ($unit) => $do,
            AnyUnit::E1($unit) => $do,
            AnyUnit::E2($unit) => $do,
            AnyUnit::E3($unit) => $do,
            AnyUnit::E4($unit) => $do,
            AnyUnit::E4d($unit) => $do,
        }
    };
}

impl Model {
    /// A unit with tables of a width. `frame` matters only to units that hold the vectors of a frame
    /// ([`UnitKind::is_distant`]).
    pub fn new(kind: UnitKind, width: Width, frame: Frame) -> Self {
        let unit = match kind {
            UnitKind::Blinn => AnyUnit::Blinn(Blinn),
            UnitKind::Peercy => AnyUnit::Peercy(Peercy),
            UnitKind::Kugler => AnyUnit::Kugler(Kugler::new(frame)),
            UnitKind::Kim => AnyUnit::Kim(Kim::new(width)),
            UnitKind::Published => AnyUnit::Published(Published::new(width)),
            UnitKind::ExactZ => AnyUnit::ExactZ(ExactZ::new(width)),
            UnitKind::E1 => AnyUnit::E1(E1::new(width)),
            UnitKind::E2 => AnyUnit::E2(E2::new(width)),
            UnitKind::E3 => AnyUnit::E3(E3::new(width)),
            UnitKind::E4 => AnyUnit::E4(E4::new(width)),
            UnitKind::E4d => AnyUnit::E4d(E4d::new(width, frame)),
        };
        Self { kind, width, unit }
    }

    /// Which unit it is.
    pub fn kind(&self) -> UnitKind {
        self.kind
    }

    /// Address bits of its tables.
    pub fn width(&self) -> Width {
        self.width
    }

    /// `N'·L'` and `N'·H'`, Q2.14, of one pixel.
    ///
    /// # Panics
    /// Unless there is a word for each of the unit's ports.
    #[inline]
    pub fn products(&self, words: &[u16]) -> [i16; 2] {
        let mut out = [[0; 2]];
        self.products_of(words, &mut out);
        let [out] = out;
        out
    }

    /// The same of many pixels, whose words follow one another.
    ///
    /// # Panics
    /// Unless there are as many words as the unit has ports, times the pixels.
    pub fn products_of(&self, words: &[u16], out: &mut [[i16; 2]]) {
        with_unit!(&self.unit, unit => run(unit, words, out));
    }

    /// Diffuse and specular intensity of one pixel, Q0.16, and their sum, Q1.16.
    ///
    /// # Panics
    /// Unless there is a word for each of the unit's ports.
    pub fn illuminate(&self, words: &[u16], tables: &LightTables) -> [u32; 3] {
        let products = self.products(words).map(i64::from);
        illuminate(&Numbers, tables, self.kind.diffuse(), products).map(|word| word as u32)
    }

    /// What it is built of, with tables of the light.
    pub fn cost(&self, tables: &LightTables) -> UnitCost {
        let count = Count::new();
        let words = [(); MOST_PORTS];
        let products = with_unit!(&self.unit, unit => products(unit, &count, &words));
        count.stage(Stage::Illumination);
        let [(), (), ()] = illuminate(&count, tables, self.kind.diffuse(), products);
        let [set_up, illumination] =
            [Stage::SetUp, Stage::Illumination].map(|stage| StageCost::counted(count.cost(stage)));
        match self.kind {
            UnitKind::Kim => UnitCost { set_up: KIM_SET_UP, illumination },
            UnitKind::Kugler => UnitCost { set_up: KUGLER_SET_UP, illumination: KUGLER_ILLUMINATION },
            _ => UnitCost { set_up, illumination },
        }
    }

    /// How far an inner product can be from the exact one, in units of 2⁻¹⁴; derived from the word lengths alone.
    ///
    /// Against exact arithmetic on the exact angles and bump vector of which the words are the nearest. None where no
    /// limit follows: the error of the published unit and of the one with exact Z is the method's, and Blinn's slopes end at ±8.
    pub fn limit(&self) -> Option<u32> {
        self.kind.limit(self.width)
    }

    /// Its tables, each once, without those of the light.
    pub fn roms(&self) -> Vec<&Rom> {
        with_unit!(&self.unit, unit => unit.roms())
    }
}

/// The most ports a unit has: Peercy's.
const MOST_PORTS: usize = 18;

fn run<U: Unit>(unit: &U, words: &[u16], out: &mut [[i16; 2]]) {
    let ports = U::PORTS.len();
    assert_eq!(words.len(), ports * out.len(), "a pixel has {ports} words");
    for (words, out) in words.chunks_exact(ports).zip(out) {
        let mut values = [0; MOST_PORTS];
        for (value, word) in values.iter_mut().zip(words) {
            *value = i64::from(*word);
        }
        *out = products(unit, &Numbers, &values).map(|product| product as i16);
    }
}
