//! Where the bytes of a glTF file are: in the GLB, in data URIs, or in files beside it.

use std::borrow::Cow;
use std::path::{Component, Path};

use gltf::json::Root;

use super::super::assemble::Assembly;
use crate::{Error, Limits, Result, Source};

/// The bytes of each buffer, cut to its declared length.
pub(super) struct Buffers<'b>(Vec<Cow<'b, [u8]>>);

impl<'b> Buffers<'b> {
    pub(super) fn new(
        root: &Root,
        bin: Option<&'b [u8]>,
        folder: Option<&Path>,
        assembly: &Assembly<'_>,
    ) -> Result<Self> {
        let mut all = Vec::new();
        // All buffers together must stay within the limit on one file.
        let mut left = assembly.limits.max_file_bytes;
        for (k, buffer) in root.buffers.iter().enumerate() {
            let place = || format!("buffer {k}");
            let bytes = match &buffer.uri {
                None => {
                    let bin = bin.filter(|_| k == 0);
                    Cow::Borrowed(bin.ok_or_else(|| assembly.damage(place(), "it has neither a URI nor a GLB chunk"))?)
                }
                Some(uri) => Cow::Owned(read_uri(uri, k, folder, left, assembly)?),
            };
            left = left.saturating_sub(bytes.len() as u64);
            let declared = usize::try_from(buffer.byte_length.0).ok().filter(|&n| n <= bytes.len());
            let Some(declared) = declared else {
                let reason = format!("{} bytes are declared, but there are {}", buffer.byte_length.0, bytes.len());
                return Err(assembly.damage(place(), reason));
            };
            all.push(match bytes {
                Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[..declared]),
                Cow::Owned(mut bytes) => {
                    bytes.truncate(declared);
                    Cow::Owned(bytes)
                }
            });
        }
        Ok(Self(all))
    }

    pub(super) fn get(&self, buffer: usize) -> Option<&[u8]> {
        self.0.get(buffer).map(AsRef::as_ref)
    }
}

fn read_uri(uri: &str, k: usize, folder: Option<&Path>, left: u64, assembly: &Assembly<'_>) -> Result<Vec<u8>> {
    let place = format!("buffer {k}");
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
        let decoded = encoded.and_then(|encoded| decode_base64(encoded.as_bytes()));
        return decoded.ok_or_else(|| assembly.damage(place, "its data URI is not valid base64"));
    }
    let shown: String = uri.chars().take(200).collect();
    let refuse = |what: &str, remedy: &str| Error::unsupported(assembly.name, format!("{what} {shown:?}"), remedy);
    let path = decode_percent(uri).ok_or_else(|| assembly.damage(place, format!("{shown:?} is not a valid URI")))?;
    // Relative paths downwards only, by either system's rules: a file must not reach out of its folder.
    let scheme = path.split(['/', '\\']).next().is_some_and(|first| first.contains(':'));
    let plain = |c| matches!(c, Component::Normal(_) | Component::CurDir);
    let climbs = path.split(['/', '\\']).any(|part| part == "..");
    let absolute = path.starts_with(['/', '\\']) || !Path::new(&path).components().all(plain);
    if scheme || climbs || absolute || path.contains('\0') || path.is_empty() {
        return Err(refuse("a buffer outside the file's folder,", "put it beside the file, or export one GLB"));
    }
    let Some(folder) = folder else {
        return Err(refuse("a buffer in a file of its own,", "name the file by its path, or export one GLB"));
    };
    let limits = Limits { max_file_bytes: left, ..*assembly.limits };
    match Source::open(&folder.join(path), &limits) {
        Ok(source) => Ok(source.bytes().to_vec()),
        // Which file asks for it, too.
        Err(Error::Io { source, .. }) => Err(Error::read(&format!("{}: buffer {k}, {shown:?}", assembly.name), source)),
        Err(other) => Err(other),
    }
}

/// RFC 3986, section 2.1.
fn decode_percent(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let (digits, tail) = rest.split_first_chunk::<2>()?;
        let digit = |d: u8| char::from(d).to_digit(16);
        bytes.push((digit(digits[0])? * 16 + digit(digits[1])?) as u8);
        rest = tail;
    }
    String::from_utf8(bytes).ok()
}

/// RFC 4648, section 4; padding may be left out.
fn decode_base64(text: &[u8]) -> Option<Vec<u8>> {
    let padding = text.iter().rev().take_while(|&&c| c == b'=').count();
    let text = &text[..text.len() - padding];
    if padding > 2 || text.len() % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::new();
    for group in text.chunks(4) {
        let mut bits = 0u32;
        for k in 0..4 {
            let value = match group.get(k) {
                Some(c @ b'A'..=b'Z') => c - b'A',
                Some(c @ b'a'..=b'z') => c - b'a' + 26,
                Some(c @ b'0'..=b'9') => c - b'0' + 52,
                Some(b'+') => 62,
                Some(b'/') => 63,
                None => 0,
                Some(_) => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_known_answers() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zg", "f"),
        ] {
            assert_eq!(decode_base64(text.as_bytes()).unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(decode_base64(b"+/+/"), Some(vec![0xfb, 0xff, 0xbf]));
        for bad in ["Z", "Zg===", "Z=g=", "Zm9v\n", "Zm-v"] {
            assert_eq!(decode_base64(bad.as_bytes()), None, "{bad}");
        }
    }

    #[test]
    fn percent_known_answers() {
        assert_eq!(decode_percent("a%20b%2Fc").as_deref(), Some("a b/c"));
        for bad in ["%", "%2", "%zz", "%ff"] {
            assert_eq!(decode_percent(bad), None, "{bad}");
        }
    }

    #[test]
    fn paths_out_of_the_folder_are_refused() {
        let limits = Limits::default();
        let assembly = Assembly::new("a.gltf", &limits);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("in side.bin"), b"1234").unwrap();
        let read = |uri: &str| read_uri(uri, 0, Some(folder.path()), 100, &assembly);
        assert_eq!(read("in%20side.bin").unwrap(), b"1234");
        assert_eq!(read("./in side.bin").unwrap(), b"1234");
        for uri in
            ["../x", "a/../../x", "%2e%2e/x", "/etc/x", "\\x", "..\\x", "C:\\x", "c:x", "http://a/x", "file:///x", ""]
        {
            let e = read(uri).unwrap_err();
            assert!(
                matches!(e, Error::Unsupported { .. }) && e.to_string().contains(&format!("{uri:?}")),
                "{uri}: {e}"
            );
        }
        let e = read("missing.bin").unwrap_err();
        assert!(matches!(&e, Error::Io { name, .. } if name.contains("a.gltf") && name.contains("missing.bin")), "{e}");
        assert!(matches!(read_uri("in side.bin", 0, Some(folder.path()), 3, &assembly), Err(Error::Limits { .. })));
        assert!(matches!(read_uri("in side.bin", 0, None, 100, &assembly), Err(Error::Unsupported { .. })));
    }
}
