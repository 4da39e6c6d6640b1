//! Relighting without decoding a pixel: only the palette of an indexed PNG is read and rewritten.

use std::ops::Range;

use rilievo::normal::{Normal, decode_u8};
use rilievo::{Convention, MaterialSpan};

use super::record::Record;
use super::{AnyTable, ImportAs, disagreements};
use crate::chunks::{checksum, chunks};
use crate::error::{Error, Result};
use crate::source::Source;

/// The chunk with the exact table.
pub(super) const TABLE_CHUNK: [u8; 4] = *b"nrTB";

/// The palette of an indexed PNG, found by walking the chunk headers before the pixels.
#[derive(Debug, Clone)]
pub struct PalettePng<'a> {
    name: &'a str,
    bytes: &'a [u8],
    /// Where the payload of PLTE lies.
    colors: Range<usize>,
    alpha: &'a [u8],
    record: Option<Result<&'a [u8], String>>,
}

/// What a palette says, as normals.
#[derive(Debug, Clone, PartialEq)]
pub struct PaletteTable {
    /// The table, +Y up: exact if the file has one, otherwise decoded from the palette.
    pub table: AnyTable,
    /// The convention of the file.
    pub convention: Convention,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl<'a> PalettePng<'a> {
    /// Finds the palette of a PNG file.
    ///
    /// # Errors
    /// [`Error::Format`] if it is not a PNG with a palette, or the palette or the header are damaged.
    pub fn parse(source: &'a Source) -> Result<Self> {
        Self::parse_bytes(source.name(), source.bytes())
    }

    /// As [`PalettePng::parse`], for bytes that are called `name` in messages.
    ///
    /// # Errors
    /// As [`PalettePng::parse`].
    pub fn parse_bytes(name: &'a str, bytes: &'a [u8]) -> Result<Self> {
        let mut bits = None;
        let mut colors = None;
        let mut alpha: &[u8] = &[];
        let mut record = None;
        for chunk in chunks(name, bytes)? {
            let chunk = chunk?;
            match &chunk.kind {
                b"IHDR" => {
                    chunk.expect_intact(name)?;
                    let &[depth, color] = chunk.data.get(8..10).and_then(|d| d.first_chunk()).unwrap_or(&[0, 0]);
                    if color != 3 {
                        let reason = "the PNG has no palette, so it is not an indexed map; quantize it";
                        return Err(Error::format(name, chunk.place(), reason));
                    }
                    bits = Some(depth);
                }
                b"PLTE" => {
                    chunk.expect_intact(name)?;
                    let most = 3usize << bits.unwrap_or(0).min(8);
                    if chunk.data.is_empty() || !chunk.data.len().is_multiple_of(3) || chunk.data.len() > most {
                        let reason = format!("a palette of {} bytes is impossible here", chunk.data.len());
                        return Err(Error::format(name, chunk.place(), reason));
                    }
                    colors = Some(chunk.at..chunk.at + chunk.data.len());
                }
                b"tRNS" => alpha = chunk.data,
                kind if *kind == TABLE_CHUNK => {
                    let intact = chunk.is_intact().then_some(chunk.data);
                    record = Some(intact.ok_or_else(|| "its checksum is wrong".to_owned()));
                }
                b"IDAT" | b"IEND" => break,
                _ => {}
            }
        }
        let Some(colors) = colors.filter(|_| bits.is_some()) else {
            return Err(Error::format(name, "chunks before IDAT", "the palette (PLTE) is missing"));
        };
        Ok(Self { name, bytes, colors, alpha, record })
    }

    /// The colours of the palette.
    pub fn colors(&self) -> &'a [[u8; 3]] {
        self.bytes[self.colors.clone()].as_chunks::<3>().0
    }

    /// The normals of the palette; what `import` leaves open is tangent space and gl.
    ///
    /// A re-sorted palette still belongs to the space and convention that the file states, so these are kept even
    /// where the exact normals are ignored.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the spans of the exact table are contradictory.
    pub fn table(&self, import: &ImportAs) -> Result<PaletteTable> {
        let mut warnings = Vec::new();
        let stated = match self.record.as_ref().map(|r| r.clone().and_then(split_record)) {
            Some(Ok((checksum, record))) => {
                let payload = &self.bytes[self.colors.clone()];
                if checksum == crc32fast::hash(payload) && record.len() == self.colors().len() {
                    let table = record.table(self.name)?;
                    warnings.extend(disagreements(import, record.space, record.convention));
                    return Ok(PaletteTable { table, convention: record.convention, warnings });
                }
                warnings.push(
                    "the palette is not the one the exact table (chunk nrTB) was written for: another program \
                     re-sorted it, or it was relit; the table is ignored and the palette is taken as normals"
                        .to_owned(),
                );
                Some(record)
            }
            Some(Err(reason)) => {
                warnings.push(format!("the exact table (chunk nrTB) is ignored: {reason}"));
                None
            }
            None => None,
        };
        let stated_as = |r: &Record| (r.space, r.convention);
        let (space, convention) = stated.as_ref().map(stated_as).unzip();
        let space = import.space.or(space).unwrap_or_default();
        let convention = import.convention.or(convention).unwrap_or_default();
        let hidden = self.alpha.iter().take(self.colors().len()).filter(|&&a| a == 0).count();
        if hidden > 0 {
            warnings.push(format!("{hidden} transparent palette entries are taken as +Z"));
        }
        warnings.extend(self.off_length());
        let normal = |(i, &c): (usize, &[u8; 3])| match self.alpha.get(i) {
            Some(0) => Normal::Z,
            _ => convention.apply(decode_u8(c)),
        };
        let normals: Vec<_> = self.colors().iter().enumerate().map(normal).collect();
        let spans = vec![MaterialSpan { material: 0, entries: 0..normals.len() as u32 }];
        Ok(PaletteTable { table: AnyTable::new(self.name, space, &normals, spans)?, convention, warnings })
    }

    /// A warning if most entries that are seen are more than 10 % off unit length, the threshold of
    /// [`crate::decode_normals`]. A few are no sign: quantisers average colours, which shortens vectors.
    fn off_length(&self) -> Option<String> {
        let seen = self.colors().iter().enumerate().filter(|(i, _)| self.alpha.get(*i) != Some(&0));
        let squared = |c: &[u8; 3]| c.map(|v| (f32::from(v) / 127.5 - 1.0).powi(2)).iter().sum::<f32>();
        let (off, all) =
            seen.fold((0, 0), |(off, all), (_, c)| (off + usize::from(!(0.81..=1.21).contains(&squared(c))), all + 1));
        (2 * off > all).then(|| {
            format!(
                "{off} of {all} palette entries are more than 10 % off unit length; they were renormalised: \
                 is this a normal map?"
            )
        })
    }

    /// The same file with other colours: only the palette and its checksum differ.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless there is one colour per palette entry.
    pub fn relit(&self, colors: &[[u8; 3]]) -> Result<Vec<u8>> {
        let mut bytes = self.bytes.to_vec();
        replace(self.name, &mut bytes, self.colors.clone(), colors)?;
        Ok(bytes)
    }
}

/// Rewrites the palette of the indexed PNG in `bytes`: only the PLTE payload and its checksum change.
///
/// # Errors
/// As [`PalettePng::parse`]; [`Error::Invalid`] unless there is one colour per palette entry.
pub fn relight_in_place(bytes: &mut [u8], colors: &[[u8; 3]]) -> Result<()> {
    let name = "indexed PNG";
    let range = PalettePng::parse_bytes(name, bytes)?.colors;
    replace(name, bytes, range, colors)
}

fn replace(name: &str, bytes: &mut [u8], range: Range<usize>, colors: &[[u8; 3]]) -> Result<()> {
    let (expected, actual) = (range.len() / 3, colors.len());
    if expected != actual {
        return Err(Error::invalid(name, rilievo::Error::Length { what: "palette colours", expected, actual }));
    }
    let payload = colors.as_flattened();
    let crc = checksum(*b"PLTE", payload).to_be_bytes();
    bytes[range.end..range.end + 4].copy_from_slice(&crc);
    bytes[range].copy_from_slice(payload);
    Ok(())
}

/// The checksum of the palette that the chunk was written for, and the record.
fn split_record(chunk: &[u8]) -> Result<(u32, Record), String> {
    let (&checksum, record) = chunk.split_first_chunk::<4>().ok_or("it is cut short")?;
    Ok((u32::from_be_bytes(checksum), Record::from_bytes(record)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warnings(colors: &[[u8; 3]], alpha: &[u8]) -> Vec<String> {
        let mut bytes = crate::chunks::SIGNATURE.to_vec();
        let header: &[u8] = &[0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0];
        for (kind, data) in [(*b"IHDR", header), (*b"PLTE", colors.as_flattened()), (*b"tRNS", alpha), (*b"IEND", &[])]
        {
            bytes.extend((data.len() as u32).to_be_bytes());
            bytes.extend(kind);
            bytes.extend(data);
            bytes.extend(checksum(kind, data).to_be_bytes());
        }
        PalettePng::parse_bytes("a", &bytes).unwrap().table(&ImportAs::default()).unwrap().warnings
    }

    #[test]
    fn a_palette_of_colours_is_questioned() {
        const UP: [u8; 3] = [128, 128, 255];
        const GRAY: [u8; 3] = [128; 3];
        assert_eq!(warnings(&[UP, GRAY], &[]), Vec::<String>::new());
        let found = warnings(&[UP, GRAY, [255; 3]], &[]);
        assert!(found.len() == 1 && found[0].starts_with("2 of 3") && found[0].contains("normal map?"), "{found:?}");
        // What is not seen says nothing.
        let found = warnings(&[GRAY, UP, GRAY], &[0]);
        assert!(found.len() == 1 && found[0].contains("transparent"), "{found:?}");
    }
}
