//! The units, one room each, of one shape: what is made ready once a pixel, each vector to reference space, the inner
//! product with the bump vector.

mod blinn;
mod e1;
mod e2;
mod e3;
mod e4;
mod e4d;
mod exact_z;
mod kim;
mod kugler;
mod peercy;
mod port;
mod published;
mod rotation;

pub(crate) use blinn::Blinn;
pub(crate) use e1::E1;
pub(crate) use e2::E2;
pub(crate) use e3::E3;
pub(crate) use e4::E4;
pub(crate) use e4d::E4d;
pub(crate) use exact_z::ExactZ;
pub(crate) use kim::Kim;
pub(crate) use kugler::Kugler;
pub(crate) use peercy::Peercy;
pub use port::{Bump, Port, Vector};
pub(crate) use published::Published;

use alloc::vec::Vec;

use crate::logic::{Logic, Polar, Stage, word};
use crate::rom::Rom;

/// A unit's data path.
///
/// `N'·L'` and `N'·H'` from 16-bit words in the order of [`Self::PORTS`].
pub(crate) trait Unit {
    /// The words of a pixel.
    const PORTS: &'static [Port];

    /// What is made ready of the surface and the bump vector.
    type Fetched<V: Copy>: Copy;
    /// A vector in reference space, or as much of it as is known before the bump vector.
    type Rotated<V: Copy>: Copy;

    /// Once a pixel.
    fn fetch<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>) -> Self::Fetched<L::Value>;

    /// Takes one of the two vectors to reference space.
    fn rotate<L: Logic>(&self, l: &L, pixel: Pixel<'_, L>, vector: Lit) -> Self::Rotated<L::Value>;

    /// Inner product with the bump vector, Q2.14.
    fn product<L: Logic>(
        &self,
        l: &L,
        fetched: Self::Fetched<L::Value>,
        rotated: Self::Rotated<L::Value>,
        vector: Lit,
    ) -> L::Value;

    /// Its tables, without those of the light.
    fn roms(&self) -> Vec<&Rom>;
}

/// Which of the two vectors of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lit {
    /// Towards the light.
    Light,
    /// Halfway between the light and the eye.
    Half,
}

/// The words at a unit's ports.
pub(crate) struct Pixel<'a, L: Logic>(pub(crate) &'a [L::Value]);

impl<L: Logic> Clone for Pixel<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Logic> Copy for Pixel<'_, L> {}

impl<L: Logic> Pixel<'_, L> {
    /// The angle or raw word at a port.
    #[inline(always)]
    fn raw(self, port: usize) -> L::Value {
        self.0[port]
    }

    /// Two angles from a port on.
    #[inline(always)]
    fn polar(self, port: usize) -> Polar<L::Value> {
        Polar { azimuth: self.raw(port), polar: self.raw(port + 1) }
    }

    /// A number with a sign.
    #[inline(always)]
    fn word(self, l: &L, port: usize) -> L::Value {
        word(l, self.raw(port))
    }

    /// Three numbers from a port on.
    #[inline(always)]
    fn words(self, l: &L, port: usize) -> [L::Value; 3] {
        [0, 1, 2].map(|k| self.word(l, port + k))
    }

    /// The angles of a vector, where all vectors are polar and come first.
    #[inline(always)]
    fn vector(self, vector: Lit) -> Polar<L::Value> {
        self.polar(2 * vector as usize)
    }

    /// The angles of the normal, where all vectors are polar.
    #[inline(always)]
    fn normal(self) -> Polar<L::Value> {
        self.polar(4)
    }
}

/// Both inner products.
#[inline(always)]
pub(crate) fn products<U: Unit, L: Logic>(unit: &U, l: &L, words: &[L::Value]) -> [L::Value; 2] {
    let pixel = Pixel::<L>(words);
    l.stage(Stage::SetUp);
    let fetched = unit.fetch(l, pixel);
    let rotated = [Lit::Light, Lit::Half].map(|vector| (vector, unit.rotate(l, pixel, vector)));
    l.stage(Stage::Illumination);
    rotated.map(|(vector, rotated)| unit.product(l, fetched, rotated, vector))
}
