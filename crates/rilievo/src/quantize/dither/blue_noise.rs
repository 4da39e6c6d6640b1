//! Each texel draws one of the three entries around its normal, with a blue-noise mask for a die.

use super::triangles::Triangles;
use super::{Rows, Table, dot, sub};
use crate::normal::BlueNoise;
use crate::par;

/// Replaces nearest entries by drawn ones.
///
/// The three entries are the corners of the Delaunay triangle that holds the normal, each drawn as often as its
/// barycentric weight says: the mean over the mask is the normal itself. Corners are ordered by table index, which
/// follows a Hilbert curve, so that texels next to each other cut the mask at like places.
pub(super) fn choose(table: &Table<'_>, triangles: &Triangles, rows: &Rows<'_>, width: usize, slots: &mut [u16]) {
    let mask = BlueNoise::get();
    let top = rows.first / width;
    par::for_each_row(slots, width, |y, slots| {
        for (x, slot) in slots.iter_mut().enumerate() {
            let texel = y * width + x;
            if table.dithered_group(rows, texel, *slot).is_some() {
                let (own, normal) = (u32::from(*slot), rows.direction(texel));
                let threshold = f64::from(mask.threshold(x, top + y));
                let mut around = triangles.around(normal, own).unwrap_or_else(|| edge(table, normal, own));
                around.sort_unstable_by_key(|a| a.0);
                let [a, b, c] = around;
                let drawn = if threshold < a.1 {
                    a
                } else if threshold < a.1 + b.1 {
                    b
                } else {
                    c
                };
                *slot = drawn.0 as u16;
            }
        }
    });
}

/// Where no triangle holds a normal (beyond the outermost entries, or where entries lie in a line): the nearest entry
/// and the one across, weighted by the foot of the normal on the line between them.
fn edge(table: &Table<'_>, normal: [f64; 3], own: u32) -> [(u32, f64); 3] {
    let from = table.direction(own).map(f64::from);
    let twice = 2.0 * dot(normal, from);
    let mirrored = sub(normal.map(|c| c * twice), from);
    let group = usize::from(table.group_of[own as usize]);
    let other = table.nearest.find(group, mirrored);
    let along = sub(table.direction(other).map(f64::from), from);
    let length2 = dot(along, along);
    let weight = if length2 > 0.0 { (dot(sub(normal, from), along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    [(own, 1.0 - weight), (other, weight), (u32::MAX, 0.0)]
}
