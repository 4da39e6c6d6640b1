//! Shading by table: look up, then filter.

use glam::Vec3;

use crate::error::{Error, Result};
use crate::indexed::QuantizedMap;
use crate::light::{Lighting, Shade, ShadeTable};
use crate::normal::{Normal, Object as ObjectSpace};
use crate::raster::scene::{Detail, Fragment, Object};
use crate::raster::texture::{Sampling, Taps};

/// An index map and its lit table (Tarini et al. 2000, § 5).
pub(super) struct Table<'a> {
    map: &'a QuantizedMap<ObjectSpace>,
    table: ShadeTable,
}

impl<'a> Table<'a> {
    /// Lights the table for an eye at `eye` in object space.
    pub(super) fn new(object: &Object<'a>, lighting: &Lighting<ObjectSpace>, eye: Vec3) -> Result<Self> {
        let Detail::Indexed(map) = object.detail else {
            let remedy =
                "the table method needs a quantised object-space map; quantise the normal map, or use the exact method";
            return Err(Error::Missing { what: "index map", remedy });
        };
        // One view direction for the whole object: from its middle, where the error is shared out evenly.
        let view = Normal::new_or(eye - object.mesh.bounding_sphere().0, Normal::Z);
        let table = ShadeTable::new(map.table(), object.model, object.materials, lighting, view)?;
        Ok(Self { map, table })
    }

    /// Looks up each texel, then filters the colours: indices are never averaged.
    pub(super) fn shade(&self, fragment: &Fragment, sampling: Sampling) -> Shade {
        let levels = self.map.indices();
        Taps::gather(levels, sampling, &fragment.footprint).iter().fold(Shade::default(), |sum, tap| {
            let index = levels.levels()[tap.level][(tap.x, tap.y)];
            sum.add_weighted(self.table.entries()[usize::from(index)], tap.weight)
        })
    }
}
