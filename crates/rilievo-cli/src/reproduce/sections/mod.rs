//! A file for each table or figure.

pub(super) mod accuracy;
pub(super) mod bumps;
pub(super) mod dithering;
pub(super) mod entries;
pub(super) mod interpolation;
pub(super) mod lengths;
pub(super) mod materials;
pub(super) mod models;
pub(super) mod overhead;
pub(super) mod rotation;
pub(super) mod setup;
pub(super) mod torus;
pub(super) mod units;

/// A bump unit as keys of figures call it.
fn unit_key(unit: rilievo::polar::UnitKind) -> String {
    unit.name().replace('-', "_")
}
