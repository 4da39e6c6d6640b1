//! Any of the fields on its way down and along: for pictures, where the light costs more than the choice.

use crate::raster::scanline::difference::{
    LinearEdge, LinearRow, NormalizedEdge, NormalizedRow, OnEdge, OnRow, QuadraticEdge, QuadraticRow, Walk,
};
use crate::raster::vectors::{Field, Rotated};

/// A [`Field`] on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) enum FieldEdge {
    Linear(LinearEdge<Rotated>),
    Normalized(NormalizedEdge),
    Quadratic(QuadraticEdge<Rotated>),
}

/// A [`Field`] along a row.
#[derive(Debug, Clone, Copy)]
pub(super) enum FieldRow {
    Linear(LinearRow<Rotated>),
    Normalized(NormalizedRow),
    Quadratic(QuadraticRow<Rotated>),
}

impl Walk for Field {
    type Edge = FieldEdge;

    fn on_edge(&self, x: f32, y: f32, slope: f32) -> FieldEdge {
        match self {
            Self::Linear(f) => FieldEdge::Linear(f.on_edge(x, y, slope)),
            Self::Normalized(f) => FieldEdge::Normalized(f.on_edge(x, y, slope)),
            Self::Quadratic(f) => FieldEdge::Quadratic(f.on_edge(x, y, slope)),
        }
    }
}

impl OnEdge for FieldEdge {
    type Row = FieldRow;

    fn row(&self, ahead: f32) -> FieldRow {
        match self {
            Self::Linear(f) => FieldRow::Linear(f.row(ahead)),
            Self::Normalized(f) => FieldRow::Normalized(f.row(ahead)),
            Self::Quadratic(f) => FieldRow::Quadratic(f.row(ahead)),
        }
    }

    fn down(&mut self) {
        match self {
            Self::Linear(f) => f.down(),
            Self::Normalized(f) => f.down(),
            Self::Quadratic(f) => f.down(),
        }
    }
}

impl OnRow for FieldRow {
    type Value = Rotated;

    fn value(&self) -> Rotated {
        match self {
            Self::Linear(f) => f.value(),
            Self::Normalized(f) => f.value(),
            Self::Quadratic(f) => f.value(),
        }
    }

    fn right(&mut self) {
        match self {
            Self::Linear(f) => f.right(),
            Self::Normalized(f) => f.right(),
            Self::Quadratic(f) => f.right(),
        }
    }
}
