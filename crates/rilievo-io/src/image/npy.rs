//! NumPy arrays in: height × width (× channels) of floats, C order (NEP 1).

use super::raster::{Raster, Samples};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::source::Source;

/// Decodes an array of `f2`, `f4` or `f8`, of either byte order.
pub(crate) fn decode(source: &Source, limits: &Limits) -> Result<Raster> {
    let name = source.name();
    let bad = |reason: &str| Error::format(name, "NPY header", reason);
    let (header, data) = split(source.bytes()).ok_or_else(|| bad("the file is cut short"))?;
    let header = str::from_utf8(header).map_err(|_| bad("it is not text"))?;
    if value(header, "fortran_order").is_some_and(|v| v.starts_with("True")) {
        let remedy = "save numpy.ascontiguousarray(a) instead";
        return Err(Error::unsupported(name, "an array in Fortran order", remedy));
    }
    let shape = value(header, "shape").and_then(parse_shape).ok_or_else(|| bad("no shape is given"))?;
    let (height, width, channels) = match shape[..] {
        [h, w] => (h, w, 1),
        [h, w, c @ 1..=4] => (h, w, c as usize),
        _ => {
            let what = format!("an array of shape {shape:?}");
            return Err(Error::unsupported(name, what, "give height × width, or height × width × 1 to 4 channels"));
        }
    };
    let count = limits.check_size(name, width, height)? * channels;
    let kind = value(header, "descr").map_or("", dtype);
    let samples = match kind {
        "<f2" => floats(data, count, |b| half::f16::from_le_bytes(b).to_f32()),
        ">f2" => floats(data, count, |b| half::f16::from_be_bytes(b).to_f32()),
        "<f4" => floats(data, count, f32::from_le_bytes),
        ">f4" => floats(data, count, f32::from_be_bytes),
        "<f8" => floats(data, count, |b| f64::from_le_bytes(b) as f32),
        ">f8" => floats(data, count, |b| f64::from_be_bytes(b) as f32),
        _ => {
            let shown: String = kind.chars().take(16).collect();
            let what =
                if kind.is_empty() { "a structured array".into() } else { format!("an array of type {shown:?}") };
            return Err(Error::unsupported(name, what, "save a.astype(numpy.float32) instead"));
        }
    };
    let samples = samples
        .ok_or_else(|| Error::format(name, "NPY data", format!("{count} values belong here; the file is cut short")))?;
    Raster::new(name, (width as u32, height as u32), channels, Samples::F32(samples))
}

/// Header text and data.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (&[major, _minor], rest) = bytes.get(6..)?.split_first_chunk::<2>()?;
    let (length, rest) = if major == 1 {
        let (length, rest) = rest.split_first_chunk::<2>()?;
        (usize::from(u16::from_le_bytes(*length)), rest)
    } else {
        let (length, rest) = rest.split_first_chunk::<4>()?;
        (u32::from_le_bytes(*length) as usize, rest)
    };
    rest.split_at_checked(length)
}

/// What follows `'key':` in the header, a Python dictionary.
fn value<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let quoted = [format!("'{key}'"), format!("\"{key}\"")];
    let after = quoted.iter().find_map(|q| header.split_once(q.as_str()))?.1;
    Some(after.trim_start().strip_prefix(':')?.trim_start())
}

/// The type in quotes that `text` begins with; empty if it is not one, as for structured arrays.
fn dtype(text: &str) -> &str {
    let quoted = |q: char| text.strip_prefix(q)?.split_once(q);
    quoted('\'').or_else(|| quoted('"')).map_or("", |(kind, _)| kind)
}

fn parse_shape(text: &str) -> Option<Vec<u64>> {
    let inside = text.strip_prefix('(')?.split_once(')')?.0;
    let numbers = inside.split(',').map(str::trim).filter(|s| !s.is_empty());
    numbers.take(8).map(|s| s.parse().ok().filter(|&n: &u64| n <= u64::from(u32::MAX))).collect()
}

/// `count` values of `N` bytes; `None` if there are fewer.
fn floats<const N: usize>(data: &[u8], count: usize, convert: impl Fn([u8; N]) -> f32) -> Option<Vec<f32>> {
    let values = data.as_chunks::<N>().0.get(..count)?;
    Some(values.iter().map(|&b| convert(b)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn npy(header: &str, data: &[u8]) -> Source {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        Source::from_bytes("a.npy", bytes)
    }

    #[test]
    fn arrays_of_all_float_types_are_read() {
        let limits = Limits::default();
        let header = |kind: &str| format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (1, 2), }}\n");
        let decoded = |kind: &str, data: &[u8]| decode(&npy(&header(kind), data), &limits);
        let expected = Samples::F32(vec![1.0, -0.5]);
        let f8: Vec<u8> = [1.0f64, -0.5].iter().flat_map(|v| v.to_be_bytes()).collect();
        assert_eq!(*decoded("<f2", &[0, 0x3c, 0, 0xb8]).unwrap().samples(), expected);
        assert_eq!(*decoded(">f8", &f8).unwrap().samples(), expected);
        assert!(matches!(decoded(">f8", &f8[..15]), Err(Error::Format { .. })));
        let refused = |header: &str| match decode(&npy(header, &f8), &limits) {
            Err(Error::Unsupported { what, .. }) => what,
            other => panic!("{other:?}"),
        };
        assert_eq!(refused(&header("|u1")), "an array of type \"|u1\"");
        assert_eq!(refused(&header(&"<f4".repeat(99))), "an array of type \"<f4<f4<f4<f4<f4<\"");
        assert_eq!(refused(&header("<f4").replace("'<f4'", "[('a', '<f4')]")), "a structured array");
        let fortran = header("<f4").replace("False", "True");
        assert!(matches!(decode(&npy(&fortran, &f8), &limits), Err(Error::Unsupported { .. })));
        let huge = header("<f4").replace("(1, 2)", "(99999999999999999999, 2)");
        assert!(decode(&npy(&huge, &f8), &limits).is_err());
    }
}
