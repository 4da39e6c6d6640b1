//! New light on a palette picture: rewriting its palette against looking up every texel.

use crate::harness::duel;
use crate::inputs;
use crate::report::{Case, Report, Unit};
use anyhow::{Result, ensure};
use glam::Vec3;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::light::{Blend, Material, ShadeTable, relight};
use rilievo::progress::Silent;
use rilievo::quantize::{Options, quantize};
use rilievo::{Convention, Edges, Grid, MipChain, Normal, NormalTable, QuantizedMap, Tangent};
use rilievo_io::{AnyTable, ImportAs, PalettePng, encode_indexed_png, relight_in_place};

/// Width and height of the picture.
const SIDE: u32 = 4096;
/// The material repeats after so many texels, as tiling ones do; the work of either side does not depend on it.
const PERIOD: u32 = 512;
/// What the whole work on a picture that is in memory may take, in seconds.
const ALLOWED: f64 = 1e-3;

pub(crate) fn run(rounds: usize, report: &mut Report) -> Result<()> {
    let map = indexed_map()?;
    let file = encode_indexed_png(&map, Convention::Gl)?;
    let mut picture = file.clone();
    let rewrite = || {
        let palette = PalettePng::parse_bytes("bench", &file)?.table(&ImportAs::default())?;
        let AnyTable::Tangent(table) = &palette.table else { anyhow::bail!("the file is not in tangent space") };
        let colors: Vec<_> = shades(table)?.to_srgb().iter().map(|c| c.rgb()).collect();
        Ok(relight_in_place(&mut picture, &colors)?)
    };
    let look_up = || Ok(relight(&map, &shades(map.table())?, None, Blend::Add)?);
    let found = duel(rounds, rewrite, look_up)?;

    let case = |name: &str, peer: f64| Case::new(format!("relight/{name}"), Unit::Seconds, found.ours, Some(peer));
    let bytes = file.len() as f64 / 1e6;
    report.add(&Case {
        note: format!(
            "{SIDE}², PNG of {bytes:.1} MB; peer looks up every texel of the decoded map and encodes nothing"
        ),
        ..case("palette", found.peer)
    })?;
    report.add(&Case {
        target: Some(1.0),
        note: "the same work against what it may take: find the palette, light it, write it".to_owned(),
        ..case("palette-under-1-ms", ALLOWED)
    })?;
    ensure!(picture.len() == file.len() && picture != file, "relighting changed nothing, or too much");
    Ok(())
}

/// A rough material of 256 normals, repeated over the picture.
fn indexed_map() -> Result<QuantizedMap<Tangent>> {
    let normals = to_normals(&HeightMap::new(inputs::rough(PERIOD)?, 0.05)?, Filter::Plane4, Edges::Wrap);
    let tile = quantize(&normals, &Options { entries: 256, ..Options::default() }, &Silent)?.map;
    let base = Grid::from_fn(SIDE, SIDE, |x, y| tile.base()[(x % PERIOD, y % PERIOD)])?;
    Ok(QuantizedMap::new(tile.table().clone(), MipChain::single(base))?)
}

fn shades(table: &NormalTable<Tangent>) -> Result<ShadeTable> {
    let materials = [Material::default()];
    Ok(ShadeTable::new(table, &materials, &inputs::lighting(), Normal::Z, Vec3::ZERO)?)
}
