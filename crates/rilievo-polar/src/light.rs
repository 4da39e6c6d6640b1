//! From inner products to intensities: where all units end.

use crate::logic::{Logic, Numbers, Reading};
use crate::rom::{Rom, Width};

/// What a light gives: `kd·max(0, N'·L')` and `ks·max(0, N'·H')ⁿ`, tables over the inner products.
///
/// The paper's have 2⁸ to 2¹⁰ words; at an exponent of 50 the error of a table of 2⁸ is 0.093, of 2¹⁰ 0.024.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LightTables {
    diffuse_scale: u16,
    diffuse: Rom,
    specular: Rom,
}

/// How a unit gets from `N'·L'` to the diffuse light; the specular light is a table in all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Diffuse {
    /// A table, as the polar units.
    Table,
    /// A multiplier, as Ernst's.
    Multiplier,
}

impl LightTables {
    /// A reflectance of 1.
    pub const FULL: u16 = u16::MAX;

    /// Tables of two reflectances (Q0.16, 65535 is 1) and Phong's exponent.
    pub fn new(width: Width, diffuse: u16, specular: u16, exponent: u32) -> Self {
        Self {
            diffuse_scale: diffuse,
            diffuse: Rom::light("diffuse", width, diffuse, 1),
            specular: Rom::light("specular", width, specular, exponent),
        }
    }

    /// Diffuse and specular intensity, Q0.16, for two inner products in Q2.14.
    #[inline]
    pub fn look_up(&self, [diffuse, specular]: [i16; 2]) -> [u16; 2] {
        [look_up(&Numbers, &self.diffuse, diffuse.into()), look_up(&Numbers, &self.specular, specular.into())]
            .map(|word| word as u16)
    }

    /// Both tables.
    pub fn roms(&self) -> [&Rom; 2] {
        [&self.diffuse, &self.specular]
    }
}

/// The word of a product; nothing below the horizon, though the first word is of the middle of its interval.
#[inline(always)]
fn look_up<L: Logic>(l: &L, rom: &Rom, product: L::Value) -> L::Value {
    let bits = rom.address_bits();
    let at = l.gates([product], |[product]| (product.max(0) >> (14 - bits)).min((1 << bits) - 1));
    let [word] = l.read(rom, Reading::Single, [at]);
    l.gates([product, word], |[product, word]| if product > 0 { word } else { 0 })
}

/// Diffuse and specular intensity of a pixel and their sum, Q1.16.
#[inline(always)]
pub(crate) fn illuminate<L: Logic>(
    l: &L,
    tables: &LightTables,
    diffuse: Diffuse,
    products: [L::Value; 2],
) -> [L::Value; 3] {
    let [light, half] = products;
    let diffuse = match diffuse {
        Diffuse::Table => look_up(l, &tables.diffuse, light),
        Diffuse::Multiplier => {
            let lit = l.gates([light], |[light]| light.clamp(0, 1 << 14));
            let scale = l.gates([light], |_| i64::from(tables.diffuse_scale));
            l.multiply(lit, scale, 14)
        }
    };
    let specular = look_up(l, &tables.specular, half);
    [diffuse, specular, l.add(diffuse, specular)]
}
