//! The distinct (normal, material) pairs of a map, with how often each occurs.
//!
//! Real maps repeat themselves, and every later stage works on distinct directions only. Texels are sorted by where they
//! lie on the sphere, 24-bit colours only after the distinct ones were found ([`super::colors`]). Space: 16 bytes per run of
//! equal texels while sorting, 4 per texel and 16 per distinct pair afterwards.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8};

use super::colors::{self, Colors};
use super::entries::unit;
use super::octahedral::{self, MORTON_CODE_BITS, morton};
use super::radix::sort_by_upper_bits;
use super::texels::Source;
use crate::normal::Bare;
use crate::{Grid, MaterialMap, par};

/// How many points the kernels handle side by side; the arrays are padded by as many.
pub(super) const LANES: usize = 8;
/// Marks a texel that has no point because it is not covered.
pub(super) const NO_POINT: u32 = u32::MAX;
/// Bits of the number of a texel or of a distinct colour; with a Morton code they fill 64 bits. [`crate::grid::MAX_TEXELS`] fits exactly.
const ITEM_BITS: u32 = 64 - MORTON_CODE_BITS;
const _: () = assert!(crate::grid::MAX_TEXELS <= 1 << ITEM_BITS);
/// Texels that are looked at together. Part of the result's definition only in that runs end at its multiples.
const PIECE: usize = 1 << 16;
/// Keys that are looked at together: what belongs to them stays in the second cache.
const BATCH: usize = 1 << 12;

/// The points of one material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Group {
    /// The material's number.
    pub material: u8,
    /// Its points; never empty.
    pub points: Range<usize>,
}

/// Weighted points in or on the unit sphere, by material and then in Morton order. Planar, and padded by [`LANES`]
/// points without weight, for the kernels' sake.
#[derive(Debug, Clone, Default)]
pub(super) struct Points {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
    pub weight: Vec<f32>,
    /// Morton codes; not padded.
    pub codes: Vec<u64>,
    /// In rising order of material.
    pub groups: Vec<Group>,
}

impl Points {
    /// Points from groups of (direction, weight) that are in order already.
    pub(super) fn new(groups: impl IntoIterator<Item = (u8, Vec<([f32; 3], f32)>)>) -> Self {
        let mut all = Self::default();
        for (material, points) in groups {
            let first = all.x.len();
            for (direction, weight) in points {
                all.push(direction, weight);
                all.codes.push(morton(direction));
            }
            all.groups.push(Group { material, points: first..all.x.len() });
        }
        all.pad();
        all
    }

    /// Points from (material, direction, texels) in any order; no two may be equal.
    pub(super) fn sorted(found: impl Iterator<Item = (u8, [f32; 3], u32)>) -> Self {
        let key = |(material, d, count): (u8, [f32; 3], u32)| (material, morton(d), d.map(f32::to_bits), count);
        let mut keys: Vec<_> = found.map(key).collect();
        par::sort_unstable(&mut keys);
        let point = |&(_, _, bits, count): &(u8, u64, [u32; 3], u32)| (bits.map(f32::from_bits), count as f32);
        let groups = keys.chunk_by(|a, b| a.0 == b.0);
        Self::new(groups.map(|group| (group[0].0, group.iter().map(point).collect())))
    }

    /// Point `i` as a unit vector.
    pub(super) fn unit(&self, i: usize) -> [f32; 3] {
        let p = self.at(i);
        let length2 = super::entries::squared_f64([0.0; 3], p);
        // Most are unit vectors already, and stay what they are to the bit.
        if (length2 - 1.0).abs() < 1e-6 { p } else { unit(p.map(f64::from)).unwrap_or(p) }
    }

    fn push(&mut self, [x, y, z]: [f32; 3], weight: f32) {
        self.x.push(x);
        self.y.push(y);
        self.z.push(z);
        self.weight.push(weight);
    }

    /// Adds a group, without weights: the items of sorted keys, equal ones as one point.
    fn add_group(
        &mut self,
        material: u8,
        keys: &[u64],
        identity: impl Fn(usize) -> [u32; 3],
        mut found: impl FnMut(usize, u32),
    ) {
        let first = self.x.len();
        for values in [&mut self.x, &mut self.y, &mut self.z, &mut self.weight] {
            values.reserve(keys.len() + LANES);
        }
        self.codes.reserve(keys.len());
        let (mut start, mut room) = (0, Room::default());
        while start < keys.len() {
            // A cell is not cut.
            let last = keys.len().min(start + BATCH) - 1;
            let end = last + keys[last..].iter().take_while(|&&key| cell_of(key) == cell_of(keys[last])).count();
            self.add_cells(&keys[start..end], &identity, &mut found, &mut room);
            start = end;
        }
        self.groups.push(Group { material, points: first..self.x.len() });
    }

    /// Adds whole cells of a group.
    #[inline(never)]
    fn add_cells(
        &mut self,
        keys: &[u64],
        identity: &impl Fn(usize) -> [u32; 3],
        found: &mut impl FnMut(usize, u32),
        Room { items, points, cell }: &mut Room,
    ) {
        // Items lie all over the memory. In loops that do nothing else many of them are on their way at a time.
        items.clear();
        items.extend(keys.iter().map(|&key| identity(item_of(key))));
        points.clear();
        let mut start = 0;
        for keys in keys.chunk_by(|&a, &b| cell_of(a) == cell_of(b)) {
            let items = &items[start..start + keys.len()];
            start += keys.len();
            if let &[item] = items {
                points.push(self.x.len() as u32);
                self.push(item.map(f32::from_bits), 0.0);
                self.codes.push(cell_of(keys[0]));
                continue;
            }
            cell.clear();
            cell.extend(items.iter().copied().zip(0..));
            // In most cells all are equal, and then in order already.
            cell.sort_unstable();
            let first = points.len();
            points.resize(first + keys.len(), 0);
            for equal in cell.chunk_by(|a, b| a.0 == b.0) {
                let point = self.x.len() as u32;
                self.push(equal[0].0.map(f32::from_bits), 0.0);
                self.codes.push(cell_of(keys[0]));
                equal.iter().for_each(|&(_, place)| points[first + place] = point);
            }
        }
        keys.iter().zip(&*points).for_each(|(&key, &point)| found(item_of(key), point));
    }

    fn pad(&mut self) {
        for _ in 0..LANES {
            self.push([0.0; 3], 0.0);
        }
    }

    /// How many there are, without the padding.
    pub(super) fn len(&self) -> usize {
        self.x.len() - LANES
    }

    /// Point `i`.
    pub(super) fn at(&self, i: usize) -> [f32; 3] {
        [self.x[i], self.y[i], self.z[i]]
    }
}

/// The points of a map and which texel is which.
#[derive(Debug)]
pub(super) struct Gathered {
    /// The distinct covered (normal, material) pairs; the weight of each is its number of texels.
    pub points: Points,
    /// The class of each texel, [`NO_POINT`] where it is not covered. Texels of a class are equal; a point may have
    /// several classes (colours of the same direction).
    pub class_of: Vec<u32>,
    /// The point of each class.
    pub point_of: Vec<u32>,
}

/// Room to work in.
#[derive(Default)]
struct Room {
    /// What the items of keys are, and their points.
    items: Vec<[u32; 3]>,
    points: Vec<u32>,
    /// What the items of a cell are, and their places in it.
    cell: Vec<([u32; 3], usize)>,
}

/// What makes two normals the same. −0 equals 0.
pub(super) fn identity(normal: Bare) -> [u32; 3] {
    normal.vec().to_array().map(|c| (c + 0.0).to_bits())
}

/// The Morton code of a key.
fn cell_of(key: u64) -> u64 {
    key >> ITEM_BITS
}

/// The number of a texel or of a colour in a key.
fn item_of(key: u64) -> usize {
    (key & ((1 << ITEM_BITS) - 1)) as usize
}

/// Where the normals of some texels stand, and whose they are.
#[inline(always)]
fn keys<S: Simd>(simd: S, texels: &[Bare], items: &[usize]) -> Vec<u64> {
    let mut keys = Vec::with_capacity(items.len());
    for items in items.chunks(LANES) {
        let mut v = [[1.0f32; LANES]; 3];
        for (l, &item) in items.iter().enumerate() {
            let normal = texels[item].vec();
            (v[0][l], v[1][l], v[2][l]) = (normal.x, normal.y, normal.z);
        }
        let load = [f32x8::from_slice(simd, &v[0]), f32x8::from_slice(simd, &v[1]), f32x8::from_slice(simd, &v[2])];
        let codes = octahedral::morton_lanes(simd, load);
        keys.extend(codes.into_iter().zip(items).map(|(code, &item)| code << ITEM_BITS | item as u64));
    }
    keys
}

/// Finds the distinct covered (normal, material) pairs of a map. Sizes must agree.
pub(super) fn gather(texels: Source<'_>, materials: Option<&MaterialMap>, covered: Option<&Grid<bool>>) -> Gathered {
    match (texels, materials) {
        (Source::Rgb8(codes), None) => of_colors(codes, covered),
        _ => of_texels(&texels.decoded(0..texels.len()), materials, covered),
    }
}

fn of_colors(codes: &[[u8; 3]], covered: Option<&Grid<bool>>) -> Gathered {
    let Colors { distinct, counts, rank_of } = colors::distinct(codes, covered.map(Grid::texels));
    let (points, point_of) = of_counted_colors(&distinct, &counts);
    Gathered { points, class_of: rank_of, point_of }
}

/// The points of distinct colours that occur so often, and the point of each.
pub(super) fn of_counted_colors(distinct: &[[u8; 3]], counts: &[u32]) -> (Points, Vec<u32>) {
    let level = Level::new();
    let pieces = par::map_range(distinct.len().div_ceil(PIECE), |piece| {
        let part = &distinct[piece * PIECE..distinct.len().min((piece + 1) * PIECE)];
        dispatch!(level, simd => colors::decode_with_codes(simd, part))
    });
    let (mut directions, mut keys) = (Vec::with_capacity(distinct.len()), Vec::with_capacity(distinct.len()));
    for (some, codes) in pieces {
        let first = directions.len() as u64;
        keys.extend((first..).zip(codes).map(|(rank, code)| code << ITEM_BITS | rank));
        directions.extend(some);
    }
    sort_by_upper_bits(&mut keys, ITEM_BITS, MORTON_CODE_BITS);
    let mut points = Points::default();
    let mut point_of = vec![NO_POINT; distinct.len()];
    if !keys.is_empty() {
        let identity = |rank: usize| directions[rank].map(|c| (c + 0.0).to_bits());
        points.add_group(0, &keys, identity, |rank, point| point_of[rank] = point);
    }
    for (&point, &count) in point_of.iter().zip(counts) {
        points.weight[point as usize] += count as f32;
    }
    points.pad();
    (points, point_of)
}

fn of_texels(texels: &[Bare], materials: Option<&MaterialMap>, covered: Option<&Grid<bool>>) -> Gathered {
    let is_covered = |texel: usize| covered.is_none_or(|c| c.texels()[texel]);
    let material_of = |texel: usize| materials.map_or(0, |m| m.texels()[texel]);
    let same = |a: usize, b: usize| texels[a] == texels[b] && material_of(a) == material_of(b);

    let level = Level::new();
    let pieces = par::map_range(texels.len().div_ceil(PIECE), |piece| {
        let first = piece * PIECE;
        let starts_run = |&t: &usize| is_covered(t) && (t == first || !is_covered(t - 1) || !same(t, t - 1));
        let starts: Vec<usize> = (first..texels.len().min(first + PIECE)).filter(starts_run).collect();
        dispatch!(level, simd => keys(simd, texels, &starts))
    });
    let mut keys = pieces.concat();
    drop(pieces);
    sort_by_upper_bits(&mut keys, ITEM_BITS, MORTON_CODE_BITS);

    let mut class_of = vec![NO_POINT; texels.len()];
    let mut points = Points::default();
    for (material, keys) in by_material(keys, materials) {
        points.add_group(material, &keys, |texel| identity(texels[texel]), |texel, point| class_of[texel] = point);
    }

    let (mut counts, mut current) = (vec![0u32; points.x.len()], NO_POINT);
    for first in (0..texels.len()).step_by(PIECE) {
        let piece = first..texels.len().min(first + PIECE);
        let covered = covered.map(|c| &c.texels()[piece.clone()]);
        current = end_runs(&mut class_of[piece], covered, current, &mut counts);
    }
    for (weight, count) in points.weight.iter_mut().zip(counts) {
        *weight = count as f32;
    }
    let point_of = (0..points.x.len() as u32).collect();
    points.pad();
    Gathered { points, class_of, point_of }
}

/// Gives the texels of each run the point that its first one has, and counts texels; gives the last run's.
#[inline(never)]
fn end_runs(class_of: &mut [u32], covered: Option<&[bool]>, mut current: u32, counts: &mut [u32]) -> u32 {
    for (texel, point) in class_of.iter_mut().enumerate() {
        if *point != NO_POINT {
            current = *point;
        } else if covered.is_none_or(|c| c[texel]) {
            *point = current;
        } else {
            continue;
        }
        counts[*point as usize] += 1;
    }
    current
}

/// Sorted keys of texels, parted by material without losing their order; in rising order of material.
fn by_material(keys: Vec<u64>, materials: Option<&MaterialMap>) -> Vec<(u8, Vec<u64>)> {
    let parts = match materials {
        None => vec![keys],
        Some(materials) => {
            let mut parts = vec![Vec::new(); 256];
            for key in keys {
                let texel = (key & ((1 << ITEM_BITS) - 1)) as usize;
                parts[usize::from(materials.texels()[texel])].push(key);
            }
            parts
        }
    };
    (0..=255).zip(parts).filter(|(_, keys)| !keys.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{Normal, NormalMap, Object};

    fn map(directions: &[[f32; 3]]) -> NormalMap<Object> {
        let normals = directions.iter().map(|&d| Normal::new(Vec3::from_array(d)).unwrap()).collect();
        Grid::new(directions.len() as u32, 1, normals).unwrap()
    }

    #[test]
    fn equal_texels_share_a_point_and_zeros_have_no_sign() {
        let z = [0.0, 0.0, 1.0];
        let map = map(&[z, z, [1.0, 0.0, 0.0], [-0.0, 0.0, 1.0], z, [0.0, 1.0, 0.0]]);
        let found = gather(Source::Normals(map.texels()), None, None);
        assert_eq!(found.points.len(), 3);
        let p = &found.class_of;
        assert!(p[0] == p[1] && p[1] == p[3] && p[3] == p[4] && p[0] != p[2] && p[5] != p[2]);
        assert_eq!(found.points.weight[p[0] as usize], 4.0);
        assert_eq!(found.points.at(p[2] as usize), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn same_normal_of_two_materials_is_two_points() {
        let map = map(&[[0.0, 0.0, 1.0]; 5]);
        let materials = Grid::new(5, 1, vec![7, 7, 3, 3, 7]).unwrap();
        let covered = Grid::new(5, 1, vec![true, false, true, true, true]).unwrap();
        let found = gather(Source::Normals(map.texels()), Some(&materials), Some(&covered));
        assert_eq!(found.class_of, [1, NO_POINT, 0, 0, 1]);
        assert_eq!(found.points.weight[..2], [2.0, 2.0]);
        let group = |material, points| Group { material, points };
        assert_eq!(found.points.groups, [group(3, 0..1), group(7, 1..2)]);
    }

    #[test]
    fn weights_and_ids_survive_runs_over_pieces() {
        let flat = Grid::filled(1 << 9, 1 << 9, Normal::<Object>::Z).unwrap();
        let found = gather(Source::Normals(flat.texels()), None, None);
        assert_eq!((found.points.len(), found.points.weight[0]), (1, 262_144.0));
        assert!(found.class_of.iter().all(|&p| p == 0));
    }
}
