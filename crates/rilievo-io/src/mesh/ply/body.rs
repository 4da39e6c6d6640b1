//! The elements of a PLY file, in either encoding.

use super::super::assemble::Assembly;
use super::header::{Element, Encoding, Header, Kind, Type};
use crate::Error;

/// A cursor over what follows the header.
pub(super) struct Body<'a> {
    encoding: Encoding,
    rest: &'a [u8],
    /// The last line that was read (ASCII).
    line: usize,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &Header, rest: &'a [u8]) -> Self {
        Self { encoding: header.encoding, rest, line: header.lines }
    }

    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    /// The fewest bytes that so many elements can take.
    pub(super) fn least_bytes(&self, element: &Element) -> u128 {
        let count = u128::from(element.count);
        if self.encoding == Encoding::Ascii {
            // A digit and a separator each; the last line of the file needs no end.
            return (count * element.properties.len() as u128 * 2).saturating_sub(1);
        }
        let fixed = element.properties.iter().map(|p| match p.kind {
            Kind::Scalar(t) | Kind::List { count: t, .. } => t.bytes() as u128,
        });
        count * fixed.sum::<u128>()
    }

    /// Damage in element `k`.
    pub(super) fn damage(&self, element: &Element, k: u64, reason: String, assembly: &Assembly<'_>) -> Error {
        let place = match self.encoding {
            Encoding::Ascii => format!("line {}", self.line),
            _ => format!("{} {k}", element.name),
        };
        assembly.damage(place, reason)
    }

    /// Reads one element: `take` gets each number with its property's index, lists item by item.
    pub(super) fn read(&mut self, element: &Element, take: impl FnMut(usize, f64)) -> Result<(), String> {
        match self.encoding {
            Encoding::Ascii => self.read_line(element, take),
            Encoding::Little => read_binary::<false>(&mut self.rest, element, take),
            Encoding::Big => read_binary::<true>(&mut self.rest, element, take),
        }
    }

    fn read_line(&mut self, element: &Element, mut take: impl FnMut(usize, f64)) -> Result<(), String> {
        let line = loop {
            if self.rest.is_empty() {
                return Err(format!("the file ends before all {} elements {:?} are read", element.count, element.name));
            }
            self.line += 1;
            let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
            let line = &self.rest[..end];
            self.rest = &self.rest[(end + 1).min(self.rest.len())..];
            // Blank lines stand for nothing, except for elements of nothing.
            if element.properties.is_empty() || !line.trim_ascii().is_empty() {
                break line;
            }
        };
        let mut tokens = line.split(u8::is_ascii_whitespace).filter(|t| !t.is_empty());
        let mut next = |kind: Type| {
            let token = tokens.next().ok_or("the line ends too early")?;
            parse(token, kind).ok_or_else(|| {
                let shown = String::from_utf8_lossy(&token[..token.len().min(32)]).into_owned();
                format!("{shown:?} is not a number of the declared type")
            })
        };
        for (k, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::Scalar(kind) => take(k, next(kind)?),
                Kind::List { count, item } => {
                    let count = list_length(next(count)?)?;
                    // No allocation by this count: items are taken one by one, and the line ends somewhere.
                    for _ in 0..count {
                        take(k, next(item)?);
                    }
                }
            }
        }
        match tokens.next() {
            Some(_) => Err("the line has more values than the header declares".into()),
            None => Ok(()),
        }
    }
}

fn list_length(value: f64) -> Result<u32, String> {
    if value < 0.0 { Err(format!("a list of {value} items")) } else { Ok(value as u32) }
}

fn parse(token: &[u8], kind: Type) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    if kind == Type::Float32 {
        return text.parse::<f32>().ok().map(f64::from);
    } else if kind == Type::Float64 {
        return text.parse().ok();
    }
    let value: i64 = text.parse().ok()?;
    let range = match kind {
        Type::Int8 => i64::from(i8::MIN)..=i64::from(i8::MAX),
        Type::Uint8 => 0..=i64::from(u8::MAX),
        Type::Int16 => i64::from(i16::MIN)..=i64::from(i16::MAX),
        Type::Uint16 => 0..=i64::from(u16::MAX),
        Type::Int32 => i64::from(i32::MIN)..=i64::from(i32::MAX),
        _ => 0..=i64::from(u32::MAX),
    };
    range.contains(&value).then_some(value as f64)
}

fn read_binary<const BIG: bool>(
    rest: &mut &[u8],
    element: &Element,
    mut take: impl FnMut(usize, f64),
) -> Result<(), String> {
    for (k, property) in element.properties.iter().enumerate() {
        match property.kind {
            Kind::Scalar(kind) => take(k, scalar::<BIG>(rest, kind)?),
            Kind::List { count, item } => {
                let count = list_length(scalar::<BIG>(rest, count)?)?;
                if u64::from(count) * item.bytes() as u64 > rest.len() as u64 {
                    return Err(format!("a list of {count} items is longer than the rest of the file"));
                }
                for _ in 0..count {
                    take(k, scalar::<BIG>(rest, item)?);
                }
            }
        }
    }
    Ok(())
}

fn scalar<const BIG: bool>(rest: &mut &[u8], kind: Type) -> Result<f64, String> {
    macro_rules! number {
        ($number:ty) => {{
            let (head, tail) = rest.split_first_chunk().ok_or("the file ends inside it")?;
            *rest = tail;
            f64::from(if BIG { <$number>::from_be_bytes(*head) } else { <$number>::from_le_bytes(*head) })
        }};
    }
    Ok(match kind {
        Type::Int8 => number!(i8),
        Type::Uint8 => number!(u8),
        Type::Int16 => number!(i16),
        Type::Uint16 => number!(u16),
        Type::Int32 => number!(i32),
        Type::Uint32 => number!(u32),
        Type::Float32 => number!(f32),
        Type::Float64 => number!(f64),
    })
}
