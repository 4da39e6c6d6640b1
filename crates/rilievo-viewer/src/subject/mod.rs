//! What is looked at: a mesh with its maps, in every form that a method may ask for.

mod make;
mod sample;
mod tangents;

use std::borrow::Cow;
use std::sync::OnceLock;

use glam::Vec2;
use rilievo::height::{Filter, HeightMap};
use rilievo::light::{Material, Shade};
use rilievo::measure::AngleStats;
use rilievo::normal::{NormalLevels, normal_levels};
use rilievo::polar::{BumpVectorMap, UnitKind};
use rilievo::progress::Silent;
use rilievo::raster::{BaseColor, Detail, Object};
use rilievo::surface::{Deflect, Frame, Mesh, deflect_heights};
use rilievo::{Edges, Grid, LinearRgb, MipChain, NormalMap, Object as ObjectSpace, QuantizedMap, Tangent};

pub use make::{File, Recipe, Surface, make};
pub use sample::Sample;
pub(crate) use tangents::Heights;
pub use tangents::Tangents;

use crate::look::{Finish, Way};

/// A mesh with its maps. Made by [`make`], and not changed afterwards.
pub struct Subject {
    /// What it is called in the window.
    pub name: String,
    /// The mesh, with tangents if it has texture coordinates.
    pub mesh: Mesh,
    /// Normals of the object, if there is more than an index map, and unless it is a flat sheet: there the texture's do.
    pub object: Option<NormalLevels<ObjectSpace>>,
    /// Normals of the texture's frame.
    pub tangent: Option<Tangents>,
    /// Index maps and their table.
    pub indexed: Option<QuantizedMap<ObjectSpace>>,
    /// Base colour, and how often it repeats.
    pub base_color: Option<(MipChain<LinearRgb>, Vec2)>,
    /// What maps continue with.
    pub edges: Edges,
    /// What it is made of at first.
    pub materials: Vec<Material>,
    /// What the quantiser cost, if it ran.
    pub error: Option<AngleStats>,
    /// What the user should know.
    pub notes: Vec<String>,
    /// For the polar units E2 and E3.
    bumps: [OnceLock<Option<BumpVectorMap>>; 2],
}

/// Which way of drawing a subject has nothing for, and why.
pub type Missing = &'static str;

impl Subject {
    /// A mesh and nothing else.
    pub(crate) fn plain(mesh: Mesh) -> Self {
        Self {
            name: String::new(),
            mesh,
            object: None,
            tangent: None,
            indexed: None,
            base_color: None,
            edges: Edges::Wrap,
            materials: vec![Material::default()],
            error: None,
            notes: Vec::new(),
            bumps: [OnceLock::new(), OnceLock::new()],
        }
    }

    /// Whether a way has what it takes.
    ///
    /// # Errors
    /// What is missing.
    pub fn can(&self, way: Way) -> Result<(), Missing> {
        match way {
            Way::Table | Way::Expanded if self.indexed.is_none() => {
                Err("there is no index map: no texture coordinates")
            }
            Way::Static if self.indexed.is_none() && self.object.is_none() => Err("there is no map to bake light into"),
            Way::Linear | Way::Normalized | Way::Quadratic if self.has_map() && self.tangent.is_none() => {
                Err("vectors are in the texture's frame, and this map is in the object's")
            }
            Way::PolarE2 | Way::PolarE3 if self.has_map() && self.object.is_none() && self.flat().is_none() => {
                Err("an index map holds no words of a polar unit")
            }
            _ => Ok(()),
        }
    }

    /// Normals of a flat sheet, and its frame.
    fn flat(&self) -> Option<(&Tangents, Frame)> {
        self.tangent.as_ref().zip(self.mesh.constant_frame())
    }

    fn has_map(&self) -> bool {
        self.object.is_some() || self.tangent.is_some() || self.indexed.is_some()
    }

    /// Words for a polar unit, made when they are first asked for; none if there is no map to make them of.
    pub fn bump_words(&self, unit: UnitKind) -> Option<&BumpVectorMap> {
        let known = if unit == UnitKind::E3 { &self.bumps[1] } else { &self.bumps[0] };
        let make = || {
            let turned = || {
                let (tangents, frame) = self.flat()?;
                let turn = |level: &NormalMap<Tangent>| level.map(|&n| frame.to_object(n));
                MipChain::from_levels(tangents.levels().normals.levels().iter().map(turn).collect())
                    .ok()
                    .map(Cow::Owned)
            };
            let normals = self.object.as_ref().map(|o| Cow::Borrowed(&o.normals)).or_else(turned)?;
            let plain = own_normals(&self.mesh, normals.base().size()).ok()?;
            BumpVectorMap::from_object(unit, &normals, &plain).ok()
        };
        known.get_or_init(make).as_ref()
    }

    /// The object as a way draws it; materials and a light map come from outside.
    pub(crate) fn object<'a>(
        &'a self,
        way: Way,
        materials: &'a [Material],
        baked: Option<&'a MipChain<Shade>>,
    ) -> Object<'a> {
        let indexed = self.indexed.as_ref().map(Detail::Indexed);
        let object = self.object.as_ref();
        let objects = object.map(|o| Detail::Object { normals: &o.normals, materials: o.materials.as_ref() });
        let tangents = || {
            let levels = self.tangent.as_ref()?.levels();
            Some(Detail::Tangent { normals: &levels.normals, repeat: Vec2::ONE, materials: levels.materials.as_ref() })
        };
        let detail = match way {
            Way::Table | Way::Expanded => indexed,
            Way::Exact => objects.or_else(tangents).or(indexed),
            Way::Static => baked.map(Detail::Baked),
            Way::Linear | Way::Normalized | Way::Quadratic => tangents(),
            Way::PolarE2 | Way::PolarE3 => way.unit().and_then(|u| self.bump_words(u)).map(|map| Detail::Bump {
                map,
                repeat: Vec2::ONE,
                materials: object.and_then(|o| o.materials.as_ref()),
            }),
        };
        let mut drawn = Object::new(&self.mesh, detail.unwrap_or(Detail::Smooth), materials);
        drawn.edges = self.edges;
        drawn.base_color = self.base_color.as_ref().map(|(levels, repeat)| BaseColor { levels, repeat: *repeat });
        drawn
    }

    /// What every material that the maps name is made of at first.
    pub(crate) fn finishes(&self) -> Vec<Finish> {
        let default = self.materials.first().cloned().unwrap_or_default();
        let count = self.material_count().max(self.materials.len());
        (0..count).map(|i| Finish::of(self.materials.get(i).unwrap_or(&default))).collect()
    }

    /// How many materials the maps name.
    pub(crate) fn material_count(&self) -> usize {
        let highest = |m: &MipChain<u8>| m.base().texels().iter().copied().max().unwrap_or(0);
        let by_table = self.indexed.as_ref().and_then(|i| i.table().spans().last()).map(|s| s.material);
        let by_map = self.object.as_ref().and_then(|o| o.materials.as_ref()).map(highest);
        usize::from(by_table.or(by_map).unwrap_or(0)) + 1
    }
}

/// A mesh's own normals as an object-space map: a flat height map, bent onto it.
fn own_normals(mesh: &Mesh, size: (u32, u32)) -> rilievo::Result<MipChain<rilievo::Normal<ObjectSpace>>> {
    let flat = HeightMap::new(Grid::filled(1, 1, 0.0)?, 1.0)?;
    let bent = deflect_heights(mesh, &flat, None, Filter::Plane4, Edges::Wrap, &Deflect::new(size), &Silent)?;
    Ok(normal_levels(bent.normals, None, Some(&bent.covered))?.normals)
}
