//! The header of a PLY file.

/// A header longer than this is no header.
const MAX_HEADER: usize = 1 << 20;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// Number types; the variants' names are the current ones of the format.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Type {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
}

impl Type {
    fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::Int8,
            "uchar" | "uint8" => Self::Uint8,
            "short" | "int16" => Self::Int16,
            "ushort" | "uint16" => Self::Uint16,
            "int" | "int32" => Self::Int32,
            "uint" | "uint32" => Self::Uint32,
            "float" | "float32" => Self::Float32,
            "double" | "float64" => Self::Float64,
            _ => return None,
        })
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::Float32 | Self::Float64)
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Scalar(Type),
    List { count: Type, item: Type },
}

#[derive(Debug, Clone)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug, Clone)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug, Clone)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// In bytes, with the end of its last line.
    pub(super) length: usize,
    /// In lines.
    pub(super) lines: usize,
}

impl Header {
    /// Parses the start of a file that begins with `ply`; the error is a line number and what is wrong there.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, (usize, String)> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut length = 0;
        let all = &bytes[..bytes.len().min(MAX_HEADER)];
        for (k, line) in all.split_inclusive(|&b| b == b'\n').enumerate() {
            length += line.len();
            let fail = |reason: String| Err((k + 1, reason));
            // Comments may be in any encoding; all that matters is ASCII.
            let line = String::from_utf8_lossy(line);
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["ply"] if k == 0 => {}
                ["comment" | "obj_info", ..] | [] if k > 0 => {}
                ["format", format, version] => {
                    encoding = Some(match format {
                        "ascii" => Encoding::Ascii,
                        "binary_little_endian" => Encoding::Little,
                        "binary_big_endian" => Encoding::Big,
                        _ => return fail(format!("unknown format {format:?}")),
                    });
                    if version != "1.0" {
                        return fail(format!("unknown version {version:?}; only 1.0 exists"));
                    }
                }
                ["element", name, count] => {
                    let Ok(count) = count.parse() else {
                        return fail(format!("{count:?} is not a count"));
                    };
                    if elements.iter().any(|e| e.name == name) {
                        return fail(format!("element {name:?} is declared twice"));
                    }
                    elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
                }
                ["property", ref kind @ .., name] => {
                    let kind = match *kind {
                        [item] => Type::parse(item).map(Kind::Scalar),
                        ["list", count, item] => Type::parse(count)
                            .filter(|count| !count.is_float())
                            .zip(Type::parse(item))
                            .map(|(count, item)| Kind::List { count, item }),
                        _ => None,
                    };
                    let Some(kind) = kind else { return fail(format!("unknown type in {:?}", line.trim_end())) };
                    let Some(element) = elements.last_mut() else {
                        return fail("a property before the first element".into());
                    };
                    element.properties.push(Property { name: name.to_owned(), kind });
                }
                ["end_header"] if line.ends_with('\n') => {
                    let Some(encoding) = encoding else { return fail("no format line in the header".into()) };
                    return Ok(Self { encoding, elements, length, lines: k + 1 });
                }
                _ => {
                    return fail(format!(
                        "not a header line: {:?}",
                        line.trim_end().chars().take(64).collect::<String>()
                    ));
                }
            }
        }
        let lines = all.iter().filter(|&&b| b == b'\n').count();
        Err((lines.max(1), "the header has no end_header line; the file is cut".into()))
    }
}
