//! Quantised maps in files: indexed PNG (up to 256 entries) and KTX2 (any number, with mip levels).
//!
//! # Table record
//! Both carry the exact table as the same bytes; integers are in network byte order, as PNG has them:
//!
//! | bytes | contents |
//! |---|---|
//! | 1 | version: 1 |
//! | 1 | space: 0 tangent, 1 object |
//! | 1 | convention of the normals: 0 gl (+Y up), 1 dx (+Y down) |
//! | 1 | reserved: 0 |
//! | 4 | number of entries K, 1 … 65 536 |
//! | 4 | number of material spans S, 1 … 256 |
//! | S × 5 | per span: material (1 byte), number of entries (4); materials rise, the numbers add up to K |
//! | K × 6 | per entry: x, y, z of the normal, 16 bits each, `floor((n + 1) / 2 · 65535 + 0.5)` |
//!
//! In a **PNG** the record stands in the private chunk `nrTB` (ancillary, private, unsafe to copy) between PLTE and
//! IDAT, after the CRC-32 of the PLTE payload (4 bytes). The palette itself holds the normals in 8 bits, in the same
//! convention, so any program shows the file as a normal map, and the palette of any other program's file can be read
//! as normals. If the checksum is not that of the palette, another program re-sorted it, or it was relit: the normals
//! of the chunk are then ignored with a warning.
//!
//! In a **KTX2** the record is the value of the key `rilievo:table`. Levels are `R8_UINT` (K ≤ 256) or `R16_UINT`
//! (little endian), Zstandard-compressed, the smallest first.

mod ktx2;
mod palette;
mod png;
mod record;
mod zstandard;

pub use self::ktx2::encode_ktx2;
pub use self::png::encode_indexed_png;
pub use palette::{PalettePng, PaletteTable, relight_in_place};

use rilievo::normal::Normal;
use rilievo::{Convention, IndexMap, MaterialSpan, MipChain, NormalTable, Object, QuantizedMap, Space, Tangent};

use crate::error::{Error, Result};
use crate::image::{Format, not_read, sniff};
use crate::limits::Limits;
use crate::source::Source;

/// The spaces a stored map can be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SpaceKind {
    /// The frame of the surface.
    #[default]
    Tangent,
    /// The space of the mesh.
    Object,
}

impl SpaceKind {
    /// The kind of a space that is known to the compiler; `None` for spaces that maps are not stored in.
    pub fn of<S: Space>() -> Option<Self> {
        [Self::Tangent, Self::Object].into_iter().find(|kind| kind.name() == S::NAME)
    }

    /// The space's name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tangent => Tangent::NAME,
            Self::Object => Object::NAME,
        }
    }
}

/// A quantised map of either space.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyIndexed {
    /// In tangent space.
    Tangent(QuantizedMap<Tangent>),
    /// In object space.
    Object(QuantizedMap<Object>),
}

impl AnyIndexed {
    /// The space of its normals.
    pub fn space(&self) -> SpaceKind {
        match self {
            Self::Tangent(_) => SpaceKind::Tangent,
            Self::Object(_) => SpaceKind::Object,
        }
    }

    /// The name of the space, as on the command line.
    pub fn space_name(&self) -> &'static str {
        self.space().name()
    }

    /// The index maps, largest first.
    pub fn indices(&self) -> &MipChain<u16> {
        match self {
            Self::Tangent(map) => map.indices(),
            Self::Object(map) => map.indices(),
        }
    }

    /// The full-size index map.
    pub fn base(&self) -> &IndexMap {
        self.indices().base()
    }

    /// Width and height of the full-size level, in texels.
    pub fn size(&self) -> (u32, u32) {
        self.base().size()
    }

    /// How many mip levels there are; at least 1.
    pub fn levels(&self) -> usize {
        self.indices().levels().len()
    }

    /// How many entries the table has.
    pub fn entries(&self) -> usize {
        match self {
            Self::Tangent(map) => map.table().len(),
            Self::Object(map) => map.table().len(),
        }
    }

    /// The materials and their entries.
    pub fn spans(&self) -> &[MaterialSpan] {
        match self {
            Self::Tangent(map) => map.table().spans(),
            Self::Object(map) => map.table().spans(),
        }
    }

    fn new(name: &str, table: AnyTable, indices: MipChain<u16>) -> Result<Self> {
        let map = match table {
            AnyTable::Tangent(table) => QuantizedMap::new(table, indices).map(Self::Tangent),
            AnyTable::Object(table) => QuantizedMap::new(table, indices).map(Self::Object),
        };
        map.map_err(|e| Error::invalid(name, e))
    }
}

/// A table of normals of either space.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyTable {
    /// In tangent space.
    Tangent(NormalTable<Tangent>),
    /// In object space.
    Object(NormalTable<Object>),
}

impl AnyTable {
    /// How many entries there are; never zero.
    #[expect(clippy::len_without_is_empty, reason = "a table is never empty")]
    pub fn len(&self) -> usize {
        match self {
            Self::Tangent(table) => table.len(),
            Self::Object(table) => table.len(),
        }
    }

    /// The space of its normals.
    pub fn space(&self) -> SpaceKind {
        match self {
            Self::Tangent(_) => SpaceKind::Tangent,
            Self::Object(_) => SpaceKind::Object,
        }
    }

    /// Normals that are +Y up already, said to be in `space`.
    fn new(name: &str, space: SpaceKind, normals: &[Normal<Object>], spans: Vec<MaterialSpan>) -> Result<Self> {
        fn table<S: Space>(normals: &[Normal<Object>], spans: Vec<MaterialSpan>) -> rilievo::Result<NormalTable<S>> {
            NormalTable::with_materials(normals.iter().map(|n| n.relabel()).collect(), spans)
        }
        let table = match space {
            SpaceKind::Tangent => table(normals, spans).map(Self::Tangent),
            SpaceKind::Object => table(normals, spans).map(Self::Object),
        };
        table.map_err(|e| Error::invalid(name, e))
    }
}

/// What the user says of a palette PNG that other tools made.
///
/// What is left open is tangent space and gl. A file that says these things itself is believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ImportAs {
    /// The space of its normals.
    pub space: Option<SpaceKind>,
    /// Where its green channel points.
    pub convention: Option<Convention>,
}

/// A quantised map as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexedFile {
    /// The map, +Y up.
    pub map: AnyIndexed,
    /// The convention of the file.
    pub convention: Convention,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Decodes an indexed PNG or a KTX2, told apart by content.
///
/// # Errors
/// [`Error::Format`], [`Error::Limits`], [`Error::Unsupported`]; [`Error::Invalid`] if an index has no entry.
pub fn decode_indexed(source: &Source, import: &ImportAs, limits: &Limits) -> Result<IndexedFile> {
    match sniff(source.bytes()) {
        Some(Format::Png) => png::decode(source, import, limits),
        Some(Format::Ktx2) => ktx2::decode(source, import, limits),
        Some(Format::Jpeg | Format::Tiff | Format::Exr | Format::Npy) => Err(Error::format(
            source.name(),
            "byte 0",
            "an indexed map is a PNG with a palette or a KTX2; quantize this",
        )),
        other => Err(not_read(source, other)),
    }
}

/// Says where the user and a file that knows disagree.
fn disagreements(import: &ImportAs, space: SpaceKind, convention: Convention) -> Vec<String> {
    let mut warnings = Vec::new();
    if import.space.is_some_and(|s| s != space) {
        warnings.push(format!("the file says that its normals are in {} space; that is believed", space.name()));
    }
    if import.convention.is_some_and(|c| c != convention) {
        let name = if convention == Convention::Gl { "gl" } else { "dx" };
        warnings.push(format!("the file says that its convention is {name}; that is believed"));
    }
    warnings
}
