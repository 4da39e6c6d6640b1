//! Maps that lanes can read, made once and kept from frame to frame.

use crate::color::LinearRgb;
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
}

impl Map<'_> {
    fn is(&self, other: &Map<'_>) -> bool {
        match (self, other) {
            (Map::Indices(a), Map::Indices(b)) => std::ptr::eq(*a, *b),
            (Map::Tangent(a), Map::Tangent(b)) => std::ptr::eq(*a, *b),
            (Map::Object(a), Map::Object(b)) => std::ptr::eq(*a, *b),
            (Map::Colors(a), Map::Colors(b)) => std::ptr::eq(*a, *b),
            _ => false,
        }
    }

    fn read(&self, filter: TextureFilter) -> Texture {
        match self {
            Map::Indices(chain) => Texture::of_indices(chain, filter),
            Map::Tangent(chain) => Texture::of_normals(chain, filter),
            Map::Object(chain) => Texture::of_normals(chain, filter),
            Map::Colors(chain) => Texture::of_colors(chain, filter),
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
        for map in detail_map(&object.detail).into_iter().chain(object.base_color.map(|base| Map::Colors(base.levels))) {
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

/// The map of an object's fine normals.
pub(super) fn detail_map<'a>(detail: &Detail<'a>) -> Option<Map<'a>> {
    match *detail {
        Detail::Smooth => None,
        Detail::Tangent { normals, .. } => Some(Map::Tangent(normals)),
        Detail::Object { normals, .. } => Some(Map::Object(normals)),
        Detail::Indexed(map) => Some(Map::Indices(map.indices())),
    }
}
