//! Bump-vector maps: normal maps as the words that a polar unit fetches.

use glam::Vec3;
use rilievo_polar::{Bump, Port, Twist, UnitKind};

use super::encode::{bump_word, meridian_frame, upright};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::mip::MipChain;
use crate::normal::{Normal, Object, Tangent};

/// The most words a texel has.
pub(crate) const MOST_WORDS: usize = 3;

/// A normal map in the words of one kind of unit, with its mip levels. Words are looked up and never averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct BumpVectorMap {
    unit: UnitKind,
    frame: BumpFrame,
    words: MipChain<[u16; MOST_WORDS]>,
}

/// Which frame a map's vectors are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BumpFrame {
    /// The texture's: tangent, bitangent, normal. The twist against the meridian is the pixel's.
    Texture,
    /// The meridian's of the surface's normal: the twist is in the map.
    Meridian,
}

/// The kinds of words a unit takes from its map, in their order.
pub(crate) fn bump_ports(unit: UnitKind) -> impl Iterator<Item = (usize, Bump)> {
    unit.ports().iter().enumerate().filter_map(|(at, port)| match port {
        Port::Bump(bump) => Some((at, *bump)),
        _ => None,
    })
}

impl BumpVectorMap {
    /// A tangent-space normal map for a unit that can add the twist of the texture frame, or is given the frame.
    ///
    /// # Errors
    /// [`Error::Missing`] for a unit whose maps have the twist baked in ([`Twist::Baked`]): it needs a map bent onto the mesh.
    pub fn from_tangent(unit: UnitKind, normals: &MipChain<Normal<Tangent>>) -> Result<Self> {
        if unit.twist() == Twist::Baked {
            let remedy = "this unit's maps have the texture frame's twist baked in; bend the map onto the mesh first \
                          (surface::deflect_normals)";
            return Err(Error::Missing { what: "object-space normals", remedy });
        }
        let words = normals.levels().iter().map(|level| level.map(|n| words(unit, n.vec()))).collect();
        Ok(Self { unit, frame: BumpFrame::Texture, words: MipChain::from_levels(words)? })
    }

    /// An object-space normal map for any unit, with the mesh's own normals at the same texels.
    ///
    /// Texel by texel the normal is taken to the meridian frame of the mesh's: whatever turn the texture had is in the words.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`], [`Error::Length`] if the two do not fit.
    pub fn from_object(
        unit: UnitKind,
        normals: &MipChain<Normal<Object>>,
        surface: &MipChain<Normal<Object>>,
    ) -> Result<Self> {
        let (expected, actual) = (normals.levels().len(), surface.levels().len());
        if expected != actual {
            return Err(Error::Length { what: "mip levels of the surface's normals", expected, actual });
        }
        let level = |(normals, surface): (&Grid<Normal<Object>>, &Grid<Normal<Object>>)| {
            normals.expect_same_size("the map of the surface's normals", surface)?;
            Grid::from_fn(normals.width(), normals.height(), |x, y| {
                let n = upright(normals[(x, y)].vec());
                let frame = meridian_frame(upright(surface[(x, y)].vec()));
                words(unit, Vec3::from_array(frame.map(|axis| axis.dot(n))))
            })
        };
        let words = normals.levels().iter().zip(surface.levels()).map(level).collect::<Result<_>>()?;
        Ok(Self { unit, frame: BumpFrame::Meridian, words: MipChain::from_levels(words)? })
    }

    /// The unit whose words they are.
    pub fn unit(&self) -> UnitKind {
        self.unit
    }

    /// The frame its vectors are in.
    pub fn frame(&self) -> BumpFrame {
        self.frame
    }

    /// The words, as many as the unit takes; the rest is 0.
    pub fn words(&self) -> &MipChain<[u16; 3]> {
        &self.words
    }
}

/// The words of one vector.
pub(crate) fn words(unit: UnitKind, n: Vec3) -> [u16; MOST_WORDS] {
    let mut words = [0; MOST_WORDS];
    for (word, (_, bump)) in words.iter_mut().zip(bump_ports(unit)) {
        *word = bump_word(bump, n);
    }
    words
}
