//! From points to a table of normals that files hold, and the entry of each point.

use super::cells::Cells;
use super::entries::{self, Entries};
use super::nearest::Nearest;
use super::points::Points;
use super::{Effort, lloyd, octahedral, round};
use crate::indexed::{MaterialSpan, NormalTable};
use crate::measure::{AngleStats, angle_of_chord, weighted_angle_stats};
use crate::normal::encode_u16;
use crate::{Error, Object, Progress, Result, par};

/// A table, and what every point has of it.
pub(super) struct Made {
    pub table: NormalTable<Object>,
    pub entries: Entries,
    /// The entry nearest to each point.
    pub owners: Vec<u32>,
}

/// Makes the best table of `count` entries, or of as many as there are points.
pub(super) fn make(points: &Points, count: u32, effort: Effort, progress: &dyn Progress) -> Result<Made> {
    let in_use = points.groups.len();
    if in_use == 0 {
        return Err(Error::Missing { what: "covered texels", remedy: "give a coverage mask that is true somewhere" });
    }
    if in_use > count as usize {
        let expected = format_args!("at least {in_use}, one for each material in use").to_string();
        return Err(Error::parameter("entries", count, expected));
    }
    let (shaped, mut cells) = if count as usize >= points.len() {
        let groups = points.groups.iter().map(|g| g.points.clone().map(|i| points.unit(i)).collect());
        let owners: Vec<u32> = (0..points.len() as u32).collect();
        (Entries::from_groups(groups), Cells::new(points, &owners, points.len()))
    } else {
        lloyd::shape(points, count as usize, lloyd::Schedule::new(effort, count), progress)
    };
    let (table, entries, new_of) = finish_table(points, shaped)?;
    cells.renumber(&new_of);
    cells.assign_exact(&entries);
    Ok(Made { table, entries, owners: cells.owners(points.len()) })
}

/// The angular error over all covered texels: over the points, each as often as it occurs.
pub(super) fn error_of(points: &Points, entries: &Entries, owners: &[u32]) -> AngleStats {
    let angles = par::map_range(points.len(), |i| {
        let chord2 = entries::squared_f64(points.at(i).map(f64::from), entries.directions[owners[i] as usize]);
        (angle_of_chord(chord2), points.weight[i] as u64)
    });
    weighted_angle_stats(&angles)
}

/// The entry of a texel that is not covered: the nearest of its group, or of all if it has none.
pub(super) fn gutter(entries: &Entries, nearest: &Nearest, group: Option<usize>, normal: [f32; 3]) -> u32 {
    let direction = normal.map(f64::from);
    let find = |group| nearest.find(group, direction);
    let distance = |&e: &u32| entries::squared_f64(direction, entries.directions[e as usize]);
    let of_any = || (0..entries.spans.len()).map(find).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    group.map(find).or_else(of_any).unwrap_or(0)
}

/// Rounds the entries to what files hold and puts them in table order; the last result is the new number of each.
fn finish_table(points: &Points, shaped: Entries) -> Result<(NormalTable<Object>, Entries, Vec<u32>)> {
    let mut normals = Vec::with_capacity(shaped.len());
    let mut spans = Vec::with_capacity(points.groups.len());
    let mut new_of = vec![0; shaped.len()];
    for (group, span) in points.groups.iter().zip(&shaped.spans) {
        let mut part: Vec<_> = span.clone().map(|e| (round::storable(shaped.directions[e]), e)).collect();
        part.sort_by_cached_key(|&(n, _)| (octahedral::hilbert(n.vec().to_array()), encode_u16(n)));
        for (normal, old) in part {
            new_of[old] = normals.len() as u32;
            normals.push(normal);
        }
        spans.push(MaterialSpan { material: group.material, entries: span.start as u32..span.end as u32 });
    }
    let entries = Entries { directions: normals.iter().map(|n| n.vec().to_array()).collect(), spans: shaped.spans };
    Ok((NormalTable::with_materials(normals, spans)?, entries, new_of))
}
