//! Shading by table: look up, then filter.

use glam::Vec3;

use crate::error::{Error, Result};
use crate::indexed::{NormalTable, QuantizedMap};
use crate::light::{Lighting, Shade, ShadeTable};
use crate::normal::{Normal, Object as ObjectSpace, World};
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::{Sampling, Taps};

/// The tables of an object, lit for a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct LitTables {
    /// The shades of front faces.
    pub front: ShadeTable,
    /// For the reversed normals of back faces, if they are drawn.
    pub back: Option<ShadeTable>,
}

/// An index map and its lit tables (Tarini et al. 2000, § 5).
pub(in crate::raster) struct Table<'a> {
    map: &'a QuantizedMap<ObjectSpace>,
    lit: LitTables,
}

impl LitTables {
    /// Lights the tables of an object for an eye at `eye`, both in the world: what of a frame by the table method is not
    /// look-up.
    ///
    /// # Errors
    /// [`Error::Missing`] if the object has no index map, [`Error::IndexRange`] if its table names a material that is not
    /// there.
    pub fn new(object: &Object<'_>, lighting: &Lighting<World>, eye: Vec3) -> Result<Self> {
        let lighting = lighting.to_object(&object.pose);
        Ok(Table::new(object, &lighting, object.pose.point_to_object(eye))?.lit)
    }
}

impl<'a> Table<'a> {
    /// Lights the tables for an eye at `eye` in object space.
    pub(in crate::raster) fn new(object: &Object<'a>, lighting: &Lighting<ObjectSpace>, eye: Vec3) -> Result<Self> {
        let Detail::Indexed(map) = object.detail else {
            let remedy =
                "the table method needs a quantised object-space map; quantise the normal map, or use the exact method";
            return Err(Error::Missing { what: "index map", remedy });
        };
        // One view direction for the whole object: from its middle, where the error is shared out evenly.
        let middle = object.mesh.bounding_sphere().0;
        let view = Normal::new_or(eye - middle, Normal::Z);
        let light = |table: &NormalTable<_>| ShadeTable::new(table, object.materials, lighting, view, middle);
        let front = light(map.table())?;
        let back = if object.double_sided {
            let reversed = map.table().normals().iter().map(|n| Normal::from_unit(-n.vec())).collect();
            Some(light(&NormalTable::with_materials(reversed, map.table().spans().to_vec())?)?)
        } else {
            None
        };
        Ok(Self { map, lit: LitTables { front, back } })
    }

    /// The shades of front faces.
    pub(in crate::raster) fn front(&self) -> &ShadeTable {
        &self.lit.front
    }

    /// The shades of back faces, if they are drawn.
    pub(in crate::raster) fn back(&self) -> Option<&ShadeTable> {
        self.lit.back.as_ref()
    }

    /// Looks up each texel, then filters the colours: indices are never averaged.
    pub(in crate::raster) fn shade(&self, fragment: &Fragment, sampling: Sampling) -> Shade {
        let levels = self.map.indices();
        let table = self.lit.back.as_ref().filter(|_| fragment.back_facing).unwrap_or(&self.lit.front);
        Taps::gather(levels, sampling, &fragment.footprint).iter().fold(Shade::default(), |sum, tap| {
            let index = levels.levels()[tap.level][(tap.x, tap.y)];
            sum.add_weighted(table.entries()[usize::from(index)], tap.weight)
        })
    }
}
