//! Normal maps in that are too large to be in memory at once: PNG, row by row.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, DecodingError};
use rilievo::normal::decode_u16;
use rilievo::quantize::{Band, BandTexels};
use rilievo::{Convention, Normal, Space};

use super::lengths::Lengths;
use super::normals::colors;
use super::raster::Depth;
use crate::error::{Error, Result};
use crate::limits::Limits;

/// Texels that are decoded together.
const BAND_TEXELS: usize = 1 << 20;
/// Bytes that are read from the file at once.
const BUFFER_BYTES: usize = 1 << 20;
/// What stands for +Z, as well as 8 bits can.
const UP: [u8; 3] = [128, 128, 255];

/// A normal map in a PNG file that is read from the top as often as it is asked for.
///
/// The texels are those of [`super::decode_normals`], but that the ones without coverage are +Z only within 0.3° in files
/// of 8 bits. A band of rows is in memory at a time.
#[derive(Debug)]
pub struct NormalRows {
    path: PathBuf,
    name: String,
    size: (u32, u32),
    depth: Depth,
    channels: usize,
    convention: Convention,
    /// From the first time all rows were read.
    warnings: Option<Vec<String>>,
}

type Reader = png::Reader<BufReader<File>>;

impl NormalRows {
    /// Opens a file. `None` if it has to be read as a whole: it is no PNG, or one that is interlaced, has a palette or a
    /// transparent colour, or is not of 8 or 16 bits of RGB or RGBA.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Format`] for a damaged header, [`Error::Limits`].
    pub fn open(path: &Path, convention: Convention, limits: &Limits) -> Result<Option<Self>> {
        let name = path.display().to_string();
        let read = |e| Error::read(&name, e);
        let mut start = Vec::new();
        std::io::Read::read_to_end(&mut std::io::Read::take(File::open(path).map_err(read)?, 8), &mut start)
            .map_err(read)?;
        if start != crate::chunks::SIGNATURE {
            return Ok(None);
        }
        let mut file = Self {
            path: path.to_owned(),
            name,
            size: (0, 0),
            depth: Depth::U8,
            channels: 0,
            convention,
            warnings: None,
        };
        let reader = file.reader()?;
        let info = reader.info();
        limits.check_size(&file.name, info.width.into(), info.height.into())?;
        file.size = (info.width, info.height);
        file.channels = info.color_type.samples();
        let is_plain = !info.interlaced && info.trns.is_none();
        let has_color = matches!(info.color_type, ColorType::Rgb | ColorType::Rgba);
        file.depth = match info.bit_depth {
            BitDepth::Eight => Depth::U8,
            BitDepth::Sixteen => Depth::U16,
            _ => return Ok(None),
        };
        Ok((is_plain && has_color).then_some(file))
    }

    /// What the file is called in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Width and height in texels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// What the user should know; complete after the first time that all rows were read.
    pub fn warnings(&self) -> &[String] {
        self.warnings.as_deref().unwrap_or_default()
    }

    /// Shows all rows to `visit` in bands, from the top; stops at its first error.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Format`], and those of `visit`.
    pub fn read<S: Space, E: From<Error>>(
        &mut self,
        mut visit: impl FnMut(Band<'_, S>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let mut reader = self.reader()?;
        let failed = |e| failed(&self.name, e);
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let band_rows = (BAND_TEXELS / width).clamp(1, height);
        let mut lengths = self.warnings.is_none().then(Lengths::default);
        let mut bytes = Vec::new();
        for first in (0..height).step_by(band_rows) {
            bytes.clear();
            for _ in first..height.min(first + band_rows) {
                let row = reader.next_row().map_err(failed)?;
                let row = row.ok_or_else(|| Error::format(&self.name, "PNG data", "rows are missing"))?;
                bytes.extend_from_slice(row.data());
            }
            self.show(first * width, &bytes, lengths.as_mut(), &mut visit)?;
        }
        // What comes after the texels must be whole, too.
        reader.finish().map_err(failed)?;
        if let Some(lengths) = lengths {
            let place = |i: usize| format!("texel ({}, {})", i % width, i / width);
            self.warnings = Some(lengths.warnings::<S>(self.depth, place));
        }
        Ok(())
    }

    /// Decodes a band and shows it.
    fn show<S: Space, E: From<Error>>(
        &self,
        first: usize,
        bytes: &[u8],
        lengths: Option<&mut Lengths>,
        visit: &mut impl FnMut(Band<'_, S>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let channels = self.channels;
        let covered: Option<Vec<bool>> = (channels == 4).then(|| match self.depth {
            Depth::U8 => bytes.chunks_exact(4).map(|t| t[3] > 0).collect(),
            _ => bytes.chunks_exact(8).map(|t| t[6] > 0 || t[7] > 0).collect(),
        });
        let covered = covered.as_deref();
        let is_covered = |i: usize| covered.is_none_or(|c| c[i]);
        if self.depth == Depth::U8 {
            if let Some(lengths) = lengths {
                lengths.measure(bytes, channels, first, covered, |c| f32::from(c) / 127.5 - 1.0);
            }
            let mut codes = colors(bytes, channels, self.convention);
            let hidden = codes.iter_mut().enumerate().filter(|(i, _)| !is_covered(*i));
            hidden.for_each(|(_, code)| *code = UP);
            visit(Band { texels: BandTexels::Rgb8(&codes), covered, materials: None })
        } else {
            let samples: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|&b| u16::from_be_bytes(b)).collect();
            if let Some(lengths) = lengths {
                lengths.measure(&samples, channels, first, covered, |c| f32::from(c) / 32_767.5 - 1.0);
            }
            let normals = rilievo::par::map_range(samples.len() / channels, |i| {
                let t = &samples[i * channels..];
                if is_covered(i) { self.convention.apply(decode_u16([t[0], t[1], t[2]])) } else { Normal::<S>::Z }
            });
            visit(Band { texels: BandTexels::Normals(&normals), covered, materials: None })
        }
    }

    /// A reader before the first row.
    fn reader(&self) -> Result<Reader> {
        let file = File::open(&self.path).map_err(|e| Error::read(&self.name, e))?;
        let mut decoder = png::Decoder::new(BufReader::with_capacity(BUFFER_BYTES, file));
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        decoder.set_transformations(png::Transformations::IDENTITY);
        decoder.read_info().map_err(|e| failed(&self.name, e))
    }
}

fn failed(name: &str, error: DecodingError) -> Error {
    match error {
        DecodingError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => Error::read(name, e),
        e => Error::format(name, "PNG data", e.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{decode_normals, encode_normals_png8, encode_normals_png16};
    use crate::source::Source;
    use rilievo::{Grid, NormalMap, Tangent};

    /// All texels, and the warnings.
    fn read_all(rows: &mut NormalRows) -> (Vec<Normal<Tangent>>, Vec<bool>) {
        let (mut normals, mut covered) = (Vec::new(), Vec::new());
        let visit = |band: Band<'_, Tangent>| -> Result<()> {
            match band.texels {
                BandTexels::Rgb8(codes) => normals.extend(codes.iter().map(|&c| rilievo::normal::decode_u8(c))),
                BandTexels::Normals(some) => normals.extend(some),
            }
            let before = covered.len();
            covered.extend((before..normals.len()).map(|i| band.covered.is_none_or(|c| c[i - before])));
            Ok(())
        };
        rows.read(visit).expect("it can be read");
        (normals, covered)
    }

    #[test]
    fn rows_are_those_of_the_whole_map() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("n.png");
        let map: NormalMap<Tangent> = Grid::from_fn(700, 1800, |x, y| {
            let v = [(x as f32 * 0.1).sin(), (y as f32 * 0.07).cos(), if x == 3 { -0.5 } else { 1.0 }];
            Normal::new_or(v.into(), Normal::Z)
        })
        .unwrap();
        let holes = Grid::from_fn(700, 1800, |x, y| (x + y) % 11 > 2).unwrap();
        let codes = map.map(|&n| rilievo::normal::encode_u8(n));
        for covered in [None, Some(&holes)] {
            for convention in [Convention::Gl, Convention::Dx] {
                for bytes in [
                    encode_normals_png8(&codes, covered).unwrap(),
                    encode_normals_png16(&map, Convention::Gl, covered).unwrap(),
                ] {
                    std::fs::write(&path, &bytes).unwrap();
                    let limits = Limits::default();
                    let whole =
                        decode_normals::<Tangent>(&Source::from_bytes("n", bytes), convention, &limits).unwrap();
                    let mut rows = NormalRows::open(&path, convention, &limits).unwrap().unwrap();
                    assert_eq!(rows.size(), (700, 1800));
                    for _ in 0..2 {
                        let (normals, inside) = read_all(&mut rows);
                        assert!(whole.covered.as_ref().map_or(inside.iter().all(|&c| c), |c| c.texels() == inside));
                        for (i, (a, b)) in normals.iter().zip(whole.normals.texels()).enumerate() {
                            assert!(if inside[i] { a == b } else { a.angle_to(*b) < 0.006 }, "{i}");
                        }
                        assert_eq!(rows.warnings(), whole.warnings);
                    }
                }
            }
        }
    }

    #[test]
    fn damage_and_other_kinds_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("n.png");
        let open = |bytes: &[u8], limits: &Limits| {
            std::fs::write(&path, bytes).unwrap();
            NormalRows::open(&path, Convention::Gl, limits)
        };
        let codes = Grid::from_fn(300, 200, |x, y| [x as u8, (x * y) as u8, 200]).unwrap();
        let good = encode_normals_png8(&codes, None).unwrap();
        let limits = Limits::default();
        assert!(open(b"GIF89a", &limits).unwrap().is_none());
        let gray = crate::encode_gray_png8(&codes.map(|c| c[0])).unwrap();
        assert!(open(&gray, &limits).unwrap().is_none());
        assert!(matches!(open(&good, &Limits { max_side: 299, ..limits }), Err(Error::Limits { .. })));
        assert!(NormalRows::open(&folder.path().join("none.png"), Convention::Gl, &limits).is_err());
        let flipped = |at: usize| {
            let mut bytes = good.clone();
            bytes[at] ^= 4;
            bytes
        };
        // Cut in the texels, cut after them, and changed in the middle.
        for bad in [good[..good.len() / 2].to_vec(), good[..good.len() - 6].to_vec(), flipped(good.len() / 2)] {
            let mut rows = open(&bad, &limits).unwrap().unwrap();
            let result = rows.read(|_: Band<'_, Tangent>| Ok::<_, Error>(()));
            assert!(matches!(result, Err(Error::Format { .. })), "{result:?}");
        }
    }
}
