//! Reading inputs, with their warnings told.

use std::path::Path;

use anyhow::Result;
use rilievo::color::Picture;
use rilievo::height::HeightMap;
use rilievo::light::Environment;
use rilievo::{Convention, Grid, MaterialMap, Space};
use rilievo_io::{AnyIndexed, EmbeddedMaterials, ImportAs, IndexedFile, Limits, NormalImage, NormalRows, Source};

use crate::exit;

/// Up to here (4096 × 4096) a map is read as a whole: its texels are decoded only once.
const LARGE_TEXELS: u64 = 1 << 24;

/// Opens a file, or stdin for `-`.
pub(crate) fn open(path: &Path) -> Result<Source> {
    Ok(Source::open(path, &Limits::default())?)
}

/// Reads a height map of the given depth, and where it is covered (`None` if everywhere).
pub(crate) fn height_map(path: &Path, depth: f32) -> Result<(HeightMap, Option<Grid<bool>>)> {
    let source = open(path)?;
    let image = rilievo_io::decode_height(&source, &Limits::default())?;
    tell(&source, &image.warnings);
    Ok((HeightMap::new(image.heights, depth)?, image.covered))
}

/// Reads a normal map.
pub(crate) fn normals<S: Space>(path: &Path, convention: Convention, repair: bool) -> Result<NormalImage<S>> {
    let source = open(path)?;
    let decode = if repair { rilievo_io::repair_normals } else { rilievo_io::decode_normals };
    let image = decode(&source, convention, &Limits::default())?;
    tell(&source, &image.warnings);
    Ok(image)
}

/// Opens a normal map that is better read row by row; `None` for all others.
pub(crate) fn large_normals(path: &Path, convention: Convention) -> Result<Option<NormalRows>> {
    if !path.is_file() {
        return Ok(None);
    }
    let rows = NormalRows::open(path, convention, &Limits::default())?;
    Ok(rows.filter(|rows| {
        let (width, height) = rows.size();
        u64::from(width) * u64::from(height) > LARGE_TEXELS
    }))
}

/// Tells what was found on the way.
pub(crate) fn tell_of(rows: &NormalRows) {
    for warning in rows.warnings() {
        exit::warn(rows.name(), warning);
    }
}

/// Reads a normal map that holds its materials.
pub(crate) fn normals_with_materials<S: Space>(
    path: &Path,
    convention: Convention,
    embedded: EmbeddedMaterials,
) -> Result<(NormalImage<S>, MaterialMap)> {
    Ok(rilievo_io::decode_normals_with_materials(&open(path)?, convention, embedded, &Limits::default())?)
}

/// Reads normals from anything that holds them: a normal map, or an index map, whose exact table is then used.
pub(crate) fn any_normals<S: Space>(source: &Source, convention: Convention) -> Result<NormalImage<S>> {
    if !rilievo_io::is_indexed(source) {
        let image = rilievo_io::decode_normals(source, convention, &Limits::default())?;
        tell(source, &image.warnings);
        return Ok(image);
    }
    let normals = match indexed(source, &ImportAs { space: None, convention: Some(convention) })?.map {
        AnyIndexed::Tangent(map) => map.expand().map(|n| n.relabel()),
        AnyIndexed::Object(map) => map.expand().map(|n| n.relabel()),
    };
    Ok(NormalImage { normals, colors: None, covered: None, depth: rilievo_io::Depth::U16, warnings: Vec::new() })
}

/// Reads an index map with its table.
pub(crate) fn indexed(source: &Source, import: &ImportAs) -> Result<IndexedFile> {
    let file = rilievo_io::decode_indexed(source, import, &Limits::default())?;
    tell(source, &file.warnings);
    Ok(file)
}

/// Reads a material map.
pub(crate) fn materials(path: &Path) -> Result<MaterialMap> {
    Ok(rilievo_io::decode_materials(&open(path)?, &Limits::default())?)
}

/// Reads the surroundings that mirrors show.
pub(crate) fn environment(path: &Path) -> Result<Environment> {
    let source = open(path)?;
    let (environment, warnings) = rilievo_io::read_environment(&source, &Limits::default())?;
    tell(&source, &warnings);
    Ok(environment)
}

/// Reads a picture.
pub(crate) fn picture(path: &Path) -> Result<Picture> {
    Ok(rilievo_io::decode_picture(&open(path)?, &Limits::default())?)
}

fn tell(source: &Source, warnings: &[String]) {
    for warning in warnings {
        exit::warn(source.name(), warning);
    }
}
