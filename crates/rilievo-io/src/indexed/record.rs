//! The table record that indexed PNG and KTX2 share; its layout stands in the documentation of [`super`].

use rilievo::normal::{decode_u16, encode_u16};
use rilievo::{Convention, MaterialSpan, NormalTable, Space};

use super::{AnyTable, SpaceKind};
use crate::error::{Error, Result};

const VERSION: u8 = 1;

/// A table as it is stored.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Record {
    pub(super) space: SpaceKind,
    pub(super) convention: Convention,
    spans: Vec<MaterialSpan>,
    codes: Vec<[u16; 3]>,
}

impl Record {
    /// # Errors
    /// [`Error::Unsupported`] for a space that maps are not stored in.
    pub(super) fn new<S: Space>(name: &str, table: &NormalTable<S>, convention: Convention) -> Result<Self> {
        let Some(space) = SpaceKind::of::<S>() else {
            let what = format!("a map in {} space", S::NAME);
            return Err(Error::unsupported(name, what, "store it in tangent or object space"));
        };
        let codes = table.normals().iter().map(|&n| encode_u16(convention.apply(n))).collect();
        Ok(Self { space, convention, spans: table.spans().to_vec(), codes })
    }

    /// The number of entries.
    pub(super) fn len(&self) -> usize {
        self.codes.len()
    }

    /// The table, +Y up.
    pub(super) fn table(&self, name: &str) -> Result<AnyTable> {
        let normals: Vec<_> = self.codes.iter().map(|&c| self.convention.apply(decode_u16(c))).collect();
        AnyTable::new(name, self.space, &normals, self.spans.clone())
    }

    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let space = match self.space {
            SpaceKind::Tangent => 0,
            SpaceKind::Object => 1,
        };
        let convention = match self.convention {
            Convention::Gl => 0,
            Convention::Dx => 1,
        };
        let mut bytes = vec![VERSION, space, convention, 0];
        bytes.extend((self.codes.len() as u32).to_be_bytes());
        bytes.extend((self.spans.len() as u32).to_be_bytes());
        for span in &self.spans {
            bytes.push(span.material);
            bytes.extend((span.entries.end - span.entries.start).to_be_bytes());
        }
        bytes.extend(self.codes.iter().flatten().flat_map(|c| c.to_be_bytes()));
        bytes
    }

    /// # Errors
    /// What is wrong, in words, if the bytes are not exactly one record of a version this program knows.
    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let cut = || "it is cut short".to_owned();
        let (&[version, space, convention, _reserved], rest) = bytes.split_first_chunk::<4>().ok_or_else(cut)?;
        if version != VERSION {
            return Err(format!("its version is {version}, this program knows {VERSION}; update it"));
        }
        let space = match space {
            0 => SpaceKind::Tangent,
            1 => SpaceKind::Object,
            other => return Err(format!("its space is {other}")),
        };
        let convention = match convention {
            0 => Convention::Gl,
            1 => Convention::Dx,
            other => return Err(format!("its convention is {other}")),
        };
        let (&entries, rest) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
        let (&spans, rest) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
        let (entries, spans) = (u32::from_be_bytes(entries) as usize, u32::from_be_bytes(spans) as usize);
        if entries > rilievo::indexed::MAX_ENTRIES || spans > 256 {
            return Err(format!("{entries} entries in {spans} spans are too many"));
        }
        if rest.len() != spans * 5 + entries * 6 {
            return Err(format!("its length is wrong for {entries} entries in {spans} spans"));
        }
        let (stored_spans, codes) = rest.split_at(spans * 5);
        let mut end = 0u32;
        let mut span = |b: &[u8; 5]| {
            let start = end;
            end = start.checked_add(u32::from_be_bytes([b[1], b[2], b[3], b[4]]))?;
            Some(MaterialSpan { material: b[0], entries: start..end })
        };
        let spans: Option<Vec<_>> = stored_spans.as_chunks::<5>().0.iter().map(&mut span).collect();
        let spans = spans.ok_or("its spans are too long")?;
        let word = |b: &[u8; 6], i: usize| u16::from_be_bytes([b[2 * i], b[2 * i + 1]]);
        let codes = codes.as_chunks::<6>().0.iter().map(|b| [word(b, 0), word(b, 1), word(b, 2)]).collect();
        Ok(Self { space, convention, spans, codes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rilievo::{Normal, Object};

    #[test]
    fn record_round_trips_and_no_part_of_it_is_one() {
        let spans = [(1, 0..1), (7, 1..3)].map(|(material, entries)| MaterialSpan { material, entries });
        let table = NormalTable::with_materials(vec![Normal::<Object>::X, Normal::Y, Normal::Z], spans.to_vec());
        let record = Record::new("a", &table.unwrap(), Convention::Dx).unwrap();
        let bytes = record.to_bytes();
        assert_eq!(bytes.len(), 12 + 2 * 5 + 3 * 6);
        assert_eq!(bytes[..12], [1, 1, 1, 0, 0, 0, 0, 3, 0, 0, 0, 2]);
        assert_eq!(bytes[28..34], [128, 0, 0, 0, 128, 0], "+Y is stored down in dx: x, y, z of the second entry");
        assert_eq!(Record::from_bytes(&bytes), Ok(record));
        for length in 0..bytes.len() {
            assert!(Record::from_bytes(&bytes[..length]).is_err());
        }
        assert!(Record::from_bytes(&[&bytes[..], &[0]].concat()).is_err());
    }
}
