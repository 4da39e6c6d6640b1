//! The quantised map: an index map into a small table of normals (Tarini et al. 2000, §§ 3, 5.2, 6).

use std::ops::Range;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::mip::MipChain;
use crate::normal::{Normal, NormalMap, Space};

/// The most entries a table may have: an index is 16 bits wide.
pub const MAX_ENTRIES: usize = 65_536;

/// One material number per texel.
pub type MaterialMap = Grid<u8>;
/// One table index per texel.
pub type IndexMap = Grid<u16>;

/// The entries of one material in a [`NormalTable`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialSpan {
    /// The material's number.
    pub material: u8,
    /// Its entries, start inclusive, end exclusive.
    pub entries: Range<u32>,
}

/// Unit normals sorted by material; only the intervals of the materials are kept, so that lighting one material is
/// one loop without branches (Tarini et al. 2000, § 6).
#[derive(Debug, Clone, PartialEq)]
pub struct NormalTable<S> {
    normals: Vec<Normal<S>>,
    spans: Vec<MaterialSpan>,
}

impl<S: Space> NormalTable<S> {
    /// A table whose entries all belong to material 0.
    ///
    /// # Errors
    /// As [`NormalTable::with_materials`].
    pub fn new(normals: Vec<Normal<S>>) -> Result<Self> {
        let entries = 0..normals.len() as u32;
        Self::with_materials(normals, vec![MaterialSpan { material: 0, entries }])
    }

    /// A table whose entries are cut into spans, one per material, in rising order of material.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an empty or too large table, or spans that do not cover it exactly in rising order.
    pub fn with_materials(normals: Vec<Normal<S>>, spans: Vec<MaterialSpan>) -> Result<Self> {
        if normals.is_empty() || normals.len() > MAX_ENTRIES {
            return Err(Error::parameter("table size", normals.len(), format_args!("1 to {MAX_ENTRIES} entries")));
        }
        let mut end = 0;
        let mut last = None;
        for span in &spans {
            let follows = span.entries.start == end && span.entries.end > span.entries.start;
            if !follows || last.is_some_and(|m| m >= span.material) {
                return Err(Error::parameter(
                    "material spans",
                    format_args!("{spans:?}"),
                    "non-empty intervals that follow each other in rising order of material",
                ));
            }
            end = span.entries.end;
            last = Some(span.material);
        }
        if end as usize != normals.len() {
            return Err(Error::Length {
                what: "entries in material spans",
                expected: normals.len(),
                actual: end as usize,
            });
        }
        Ok(Self { normals, spans })
    }

    /// How many entries there are; never zero.
    #[expect(clippy::len_without_is_empty, reason = "a table is never empty")]
    pub fn len(&self) -> usize {
        self.normals.len()
    }

    /// The normals, in table order.
    pub fn normals(&self) -> &[Normal<S>] {
        &self.normals
    }

    /// The materials and their entries, in rising order of both.
    pub fn spans(&self) -> &[MaterialSpan] {
        &self.spans
    }

    /// The material of an entry.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn material_of(&self, entry: u16) -> u8 {
        let i = self.spans.partition_point(|s| s.entries.end <= u32::from(entry));
        self.spans[i].material
    }
}

/// An index map with its mip levels, and the table it points into.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMap<S> {
    table: NormalTable<S>,
    indices: MipChain<u16>,
}

impl<S: Space> QuantizedMap<S> {
    /// Joins a table and its index maps.
    ///
    /// # Errors
    /// [`Error::IndexRange`] if an index points past the table.
    pub fn new(table: NormalTable<S>, indices: MipChain<u16>) -> Result<Self> {
        let len = table.len();
        for level in indices.levels() {
            if let Some(at) = level.texels().iter().position(|&i| usize::from(i) >= len) {
                let index = level.texels()[at].into();
                return Err(Error::IndexRange { what: "table index", at, index, len });
            }
        }
        Ok(Self { table, indices })
    }

    /// The table.
    pub fn table(&self) -> &NormalTable<S> {
        &self.table
    }

    /// The index maps, largest first.
    pub fn indices(&self) -> &MipChain<u16> {
        &self.indices
    }

    /// The full-size index map.
    pub fn base(&self) -> &IndexMap {
        self.indices.base()
    }

    /// The normal map this stands for: every index looked up.
    pub fn expand(&self) -> NormalMap<S> {
        self.base().map(|&i| self.table.normals[usize::from(i)])
    }

    /// The same map in another space, each entry taken there by `to`; for frames that are constant over the map.
    pub fn map_normals<T: Space>(self, to: impl Fn(Normal<S>) -> Normal<T>) -> QuantizedMap<T> {
        let normals = self.table.normals.into_iter().map(to).collect();
        QuantizedMap { table: NormalTable { normals, spans: self.table.spans }, indices: self.indices }
    }

    /// The material of every texel.
    pub fn expand_materials(&self) -> MaterialMap {
        self.base().map(|&i| self.table.material_of(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::Object;

    fn span(material: u8, entries: Range<u32>) -> MaterialSpan {
        MaterialSpan { material, entries }
    }

    #[test]
    fn spans_must_cover_the_table_in_order() {
        let normals = vec![Normal::<Object>::Z; 5];
        let table = |spans| NormalTable::with_materials(normals.clone(), spans);
        let good = table(vec![span(1, 0..2), span(4, 2..5)]).unwrap();
        assert_eq!([0, 1, 2, 4].map(|i| good.material_of(i)), [1, 1, 4, 4]);
        assert!(table(vec![span(1, 0..2), span(1, 2..5)]).is_err());
        assert!(table(vec![span(1, 0..2), span(2, 3..5)]).is_err());
        assert!(table(vec![span(1, 0..2)]).is_err());
        assert!(NormalTable::<Object>::new(vec![]).is_err());
    }

    #[test]
    fn indices_past_the_table_are_refused() {
        let table = NormalTable::new(vec![Normal::<Object>::Z, Normal::X]).unwrap();
        let indices = |i| MipChain::single(Grid::new(2, 1, vec![0, i]).unwrap());
        assert_eq!(QuantizedMap::new(table.clone(), indices(1)).unwrap().expand().texels()[1], Normal::X);
        let refused = QuantizedMap::new(table, indices(2));
        assert_eq!(refused, Err(Error::IndexRange { what: "table index", at: 1, index: 2, len: 2 }));
    }
}
