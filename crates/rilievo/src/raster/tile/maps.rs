//! Maps that lanes can read, made once and kept from frame to frame.

use crate::color::LinearRgb;
use crate::light::Shade;
use crate::mip::MipChain;
use crate::normal::{Normal, Object as ObjectSpace, Tangent};
use crate::raster::scene::{Detail, Object};
use crate::raster::texture::TextureFilter;

use super::texture::Texture;

/// A map of a scene, known by where it is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Map<'a> {
    Indices(&'a MipChain<u16>),
    Tangent(&'a MipChain<Normal<Tangent>>),
    Object(&'a MipChain<Normal<ObjectSpace>>),
    Colors(&'a MipChain<LinearRgb>),
    Shades(&'a MipChain<Shade>),
    Materials(&'a MipChain<u8>),
}

impl Map<'_> {
    fn is(&self, other: &Map<'_>) -> bool {
        match (self, other) {
            (Map::Indices(a), Map::Indices(b)) => std::ptr::eq(*a, *b),
            (Map::Tangent(a), Map::Tangent(b)) => std::ptr::eq(*a, *b),
            (Map::Object(a), Map::Object(b)) => std::ptr::eq(*a, *b),
            (Map::Colors(a), Map::Colors(b)) => std::ptr::eq(*a, *b),
            (Map::Shades(a), Map::Shades(b)) => std::ptr::eq(*a, *b),
            (Map::Materials(a), Map::Materials(b)) => std::ptr::eq(*a, *b),
            _ => false,
        }
    }

    fn read(&self, filter: TextureFilter) -> Texture {
        match self {
            Map::Indices(chain) => Texture::of_indices(chain, filter),
            Map::Tangent(chain) => Texture::of_normals(chain, filter),
            Map::Object(chain) => Texture::of_normals(chain, filter),
            Map::Colors(chain) => Texture::of_colors(chain, filter),
            Map::Shades(chain) => Texture::of_shades(chain, filter),
            Map::Materials(chain) => Texture::of_materials(chain, filter),
        }
    }
}

/// The maps that were read so far. The lifetime holds the maps where they are.
#[derive(Debug, Default)]
pub(super) struct Maps<'a> {
    known: Vec<(Map<'a>, TextureFilter, Texture)>,
}

impl<'a> Maps<'a> {
    /// Reads the maps of an object that were not read yet.
    pub(super) fn read(&mut self, object: &Object<'a>, filter: TextureFilter) {
        let base = object.base_color.map(|base| Map::Colors(base.levels));
        for map in [detail_map(&object.detail), materials_map(&object.detail), base].into_iter().flatten() {
            if self.find(&map, filter).is_none() {
                self.known.push((map, filter, map.read(filter)));
            }
        }
    }

    /// A map that was read.
    pub(super) fn find(&self, map: &Map<'_>, filter: TextureFilter) -> Option<&Texture> {
        self.known.iter().find(|(known, by, _)| *by == filter && known.is(map)).map(|(.., texture)| texture)
    }
}

/// The map of the materials that go with an object's normals.
pub(super) fn materials_map<'a>(detail: &Detail<'a>) -> Option<Map<'a>> {
    match *detail {
        Detail::Tangent { materials, .. } | Detail::Object { materials, .. } => materials.map(Map::Materials),
        // Units read their words from the map itself.
        Detail::Smooth | Detail::Indexed(_) | Detail::Baked(_) | Detail::Bump { .. } => None,
    }
}

/// The map of an object's fine normals.
pub(super) fn detail_map<'a>(detail: &Detail<'a>) -> Option<Map<'a>> {
    match *detail {
        Detail::Smooth | Detail::Bump { .. } => None,
        Detail::Tangent { normals, .. } => Some(Map::Tangent(normals)),
        Detail::Object { normals, .. } => Some(Map::Object(normals)),
        Detail::Indexed(map) => Some(Map::Indices(map.indices())),
        Detail::Baked(levels) => Some(Map::Shades(levels)),
    }
}
