//! Heights to normals against copying the same bytes.
//!
//! "The same bytes" are those of the normal map, 12 a texel: read once and written once, they move 24 bytes a texel,
//! where the conversion moves 16 (4 of height in, 12 of normal out). Copying into memory that is there already is the
//! first peer, though the conversion makes its map in new memory; copying into new memory stands beside it and
//! says how much of the difference is the system's handing out of pages.
//!
//! Packed normals move 6 bytes a texel, 2 of height in and 4 of normal out, both in memory that is there: their peer is
//! a copy that reads 3 bytes a texel and writes 3.

use crate::harness::duel;
use crate::inputs;
use crate::report::{Case, Report, Unit};
use anyhow::Result;
use rilievo::height::{Filter, HeightMap, pack_normals, to_normals};
use rilievo::{Edges, Grid};

/// Width and height of the map; its normals fill 201 MB, more than any cache holds.
const SIDE: u32 = 4096;
/// The relief repeats after so many texels: what the heights are makes no difference to the time.
const PERIOD: u32 = 512;
/// Shares of the speed of the copy that packed normals aim at.
const FILTERS: [(&str, Filter, f64); 2] = [("plane4", Filter::Plane4, 0.75), ("sobel", Filter::Sobel, 0.55)];

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let tile = inputs::rough(PERIOD)?;
    packed(&tile, rounds, report)?;
    let map = HeightMap::new(Grid::from_fn(SIDE, SIDE, |x, y| tile[(x % PERIOD, y % PERIOD)])?, 0.02)?;
    let source = to_normals(&map, Filter::Plane4, Edges::Wrap);
    let mut there = source.clone();
    for (name, filter, _) in FILTERS {
        let ours = || Ok(to_normals(&map, filter, Edges::Wrap));
        let copy = duel(rounds, ours, || {
            there.texels_mut().copy_from_slice(source.texels());
            // Else the compiler may see that nobody reads it.
            std::hint::black_box(there.texels());
            Ok(())
        })?;
        let case = Case::new(format!("height/{name}"), Unit::Seconds, copy.ours, Some(copy.peer));
        report.add(&Case { note: "against memcpy of the normals' bytes".to_owned(), ..case })?;

        let fresh = duel(rounds, ours, || Ok(source.clone()))?;
        let case = Case::new(format!("height/{name}-new-memory"), Unit::Seconds, fresh.ours, Some(fresh.peer));
        report.add(&Case { note: "against the same copy into newly allocated memory".to_owned(), ..case })?;
    }
    Ok(())
}

fn packed(tile: &Grid<f32>, rounds: usize, report: &mut Report) -> Result<()> {
    let heights = Grid::from_fn(SIDE, SIDE, |x, y| (tile[(x % PERIOD, y % PERIOD)] * 65_535.0 + 0.5) as u16)?;
    let mut out = Grid::filled(SIDE, SIDE, [0u8; 4])?;
    let bytes = heights.texels().len() * 3;
    let (source, mut there) = (vec![1u8; bytes], vec![2u8; bytes]);
    for (name, filter, target) in FILTERS {
        let ours = || {
            pack_normals(&heights, 0.02, filter, Edges::Wrap, &mut out)?;
            std::hint::black_box(out.texels());
            Ok(())
        };
        let copy = duel(rounds, ours, || {
            there.copy_from_slice(&source);
            std::hint::black_box(&there);
            Ok(())
        })?;
        let case = Case::new(format!("height/{name}-packed"), Unit::Seconds, copy.ours, Some(copy.peer));
        let note = "16-bit heights to packed 8-bit normals, against memcpy of as many bytes".to_owned();
        report.add(&Case { target: Some(target), note, ..case })?;
    }
    Ok(())
}
