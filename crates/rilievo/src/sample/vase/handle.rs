//! The two handles: ribbed straps from the neck to the shoulder, each on its own island of the map.

use glam::{Vec2, Vec3};

use super::stroke::cubic;
use crate::sample::turn;
use crate::surface::MeshParts;

/// Height of the strip of islands below the vase's part of the map, as a map length.
pub(super) const STRIP: f32 = 0.24;
/// Part of the strip's height left free above and below the islands.
const MARGIN: f32 = 0.08;
/// The islands, left to right.
const ISLANDS: [[f32; 2]; 2] = [[0.02, 0.48], [0.52, 0.98]];

/// Middle line in (radius, y), from inside the neck's wall to inside the shoulder's.
const WAY: [[f32; 2]; 4] = [[0.225, 0.755], [0.50, 0.865], [0.635, 0.72], [0.525, 0.365]];
/// Half the strap's thickness and half its width.
const HALF: [f32; 2] = [0.026, 0.052];

/// Adds both handles; `sides` around, `steps` along each.
pub(super) fn add(parts: &mut MeshParts, strip_top: f32, strip_bottom: f32, sides: u32, steps: u32) {
    for (island, mirror) in ISLANDS.into_iter().zip([1.0f32, -1.0]) {
        let first = parts.positions.len() as u32;
        for i in 0..=steps {
            let t = i as f32 / steps as f32;
            let [r, y] = cubic(WAY, t);
            let [r0, y0] = cubic(WAY, t - 1e-3);
            let [r1, y1] = cubic(WAY, t + 1e-3);
            let along = Vec3::new(r1 - r0, y1 - y0, 0.0).normalize();
            let out = Vec3::new(-along.y, along.x, 0.0);
            // The clay was smeared onto the wall: the strap is wider where it is joined.
            let joint = 1.0 + 0.45 * (2.0 * t - 1.0).powi(6);
            for j in 0..=sides {
                // The islands' edges run along the inner side, which nobody sees.
                let around = j as f32 / sides as f32;
                let (sin, cos) = turn::sin_cos(f64::from(around) + 0.5);
                let across = along.cross(out);
                let p = Vec3::new(r, y, 0.0) + joint * (HALF[0] * cos * out + HALF[1] * sin * across);
                let n = (cos / HALF[0] * out + sin / HALF[1] * across).normalize();
                // Half a turn about the axis takes one handle to the other side.
                let turned = |v: Vec3| Vec3::new(v.x * mirror, v.y, v.z * mirror);
                parts.positions.push(turned(p));
                parts.normals.push(turned(n));
                let v = MARGIN + (1.0 - 2.0 * MARGIN) * around;
                let [u0, u1] = island;
                parts.uvs.push(Vec2::new(u0 + (u1 - u0) * t, strip_top + (strip_bottom - strip_top) * v));
            }
        }
        for i in 0..steps {
            for j in 0..sides {
                let a = first + i * (sides + 1) + j;
                let b = a + sides + 1;
                parts.triangles.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
            }
        }
    }
}

/// Height of the three reeds in 0 … 1 at `strip` 0 … 1 down the strip: ribs on the outer side, smooth inside.
pub(super) fn reeds(strip: f32) -> f32 {
    let turn = (strip - MARGIN) / (1.0 - 2.0 * MARGIN);
    // The outer side is the middle of the island.
    let x = (turn - 0.5) * 2.0;
    if x.abs() > 0.46 {
        return 0.6;
    }
    let reed = (x / 0.92 + 0.5) * 3.0;
    let from_middle = (reed - reed.floor()) * 2.0 - 1.0;
    (1.0 - from_middle * from_middle * 0.96).sqrt()
}
