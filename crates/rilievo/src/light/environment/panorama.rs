//! Looking up equirectangular pictures, to resample them.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::color::LinearRgb;
use crate::grid::{Edges, Grid};

/// What a panorama shows in the unit direction `d`, bilinear: around at its sides, the pole's row goes on beyond it.
pub(super) fn at(picture: &Grid<LinearRgb>, d: Vec3) -> LinearRgb {
    let u = d.x.atan2(-d.z) / TAU + 0.5;
    let v = d.y.clamp(-1.0, 1.0).acos() / PI;
    let (x, y) = (u * picture.width() as f32 - 0.5, v * picture.height() as f32 - 0.5);
    let (column, row) = (x.floor(), y.floor());
    let (fx, fy) = (x - column, y - row);
    let texel = |dx: i64, dy: i64| {
        let x = Edges::Wrap.resolve(column as i64 + dx, picture.width());
        picture[(x, Edges::Clamp.resolve(row as i64 + dy, picture.height()))]
    };
    let across = |dy| texel(0, dy) * (1.0 - fx) + texel(1, dy) * fx;
    across(0) * (1.0 - fy) + across(1) * fy
}
