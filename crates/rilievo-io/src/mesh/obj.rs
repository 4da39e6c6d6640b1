//! Wavefront OBJ: `v`, `vt`, `vn` and `f`; all else (groups, materials, lines, curves) is passed over.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::assemble::{Assembly, Vertex};
use crate::Result;

/// No texture coordinate or normal: past any list, which the limits keep shorter.
const NONE: u32 = u32::MAX;

#[derive(Default)]
struct Lists {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Which vertex a triple of indices became.
    vertices: HashMap<[u32; 3], u32>,
    corners: Vec<u32>,
}

pub(super) fn decode_obj(bytes: &[u8], assembly: &mut Assembly<'_>) -> Result<()> {
    if let Some(at) = bytes.iter().position(|&b| b == 0) {
        let line = bytes[..at].iter().filter(|&&b| b == b'\n').count() + 1;
        let reason = "binary data; this is not a text file, and no mesh format that is known (OBJ, PLY, GLB, glTF)";
        return Err(assembly.damage(format!("line {line}"), reason));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut lists = Lists::default();
    let mut known = false;
    let mut joined = Vec::new();
    let mut joined_from = None;
    for (k, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let end = line.iter().position(|&b| b == b'#').unwrap_or(line.len());
        let line = line[..end].trim_ascii();
        if let Some(begun) = line.strip_suffix(b"\\") {
            joined_from.get_or_insert(k + 1);
            joined.extend_from_slice(begun);
            joined.push(b' ');
            continue;
        }
        match joined_from.take() {
            None => known |= lists.read_line(line, k + 1, assembly)?,
            Some(first) => {
                joined.extend_from_slice(line);
                known |= lists.read_line(&joined, first, assembly)?;
                joined.clear();
            }
        }
    }
    if let Some(first) = joined_from {
        known |= lists.read_line(&joined, first, assembly)?;
    }
    if !known {
        let reason =
            "neither OBJ (it has no vertices or faces) nor any other mesh format that is known (PLY, GLB, glTF)";
        return Err(assembly.damage("file", reason));
    }
    Ok(())
}

impl Lists {
    /// Reads one logical line; whether it was one that OBJ files with a mesh have.
    fn read_line(&mut self, line: &[u8], number: usize, assembly: &mut Assembly<'_>) -> Result<bool> {
        let place = || format!("line {number}");
        let mut tokens = line.split(u8::is_ascii_whitespace).filter(|t| !t.is_empty());
        match tokens.next() {
            Some(b"v") => {
                let xyz = numbers::<3>(tokens).map_err(|e| assembly.damage(place(), e))?;
                assembly.check_vertices(self.positions.len() as u64 + 1)?;
                self.positions.push(Vec3::from_array(xyz));
            }
            Some(b"vt") => {
                // v may be left out; w is for volumes.
                let mut tokens = tokens.chain([&b"0"[..]]);
                let [u, v] = numbers::<2>(&mut tokens).map_err(|e| assembly.damage(place(), e))?;
                assembly.check_vertices(self.uvs.len() as u64 + 1)?;
                // From the bottom row up to from the top row down.
                self.uvs.push(Vec2::new(u, 1.0 - v));
            }
            Some(b"vn") => {
                let xyz = numbers::<3>(tokens).map_err(|e| assembly.damage(place(), e))?;
                assembly.check_vertices(self.normals.len() as u64 + 1)?;
                self.normals.push(Vec3::from_array(xyz));
            }
            Some(b"f" | b"fo") => {
                let mut corners = std::mem::take(&mut self.corners);
                corners.clear();
                for token in tokens {
                    let triple = self.triple(token).map_err(|e| assembly.damage(place(), e))?;
                    corners.push(self.vertex(triple, assembly)?);
                }
                assembly.push_polygon(place, &corners)?;
                self.corners = corners;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `p`, `p/t`, `p//n` or `p/t/n` as indices from zero.
    fn triple(&self, token: &[u8]) -> Result<[u32; 3], String> {
        let mut fields = token.split(|&b| b == b'/');
        let position = fields.next().unwrap_or_default();
        let position = index(position, self.positions.len(), "vertex")?;
        let mut optional = |len: usize, what: &str| match fields.next() {
            None | Some(b"") => Ok(NONE),
            Some(text) => index(text, len, what),
        };
        let uv = optional(self.uvs.len(), "texture coordinate")?;
        let normal = optional(self.normals.len(), "normal")?;
        if fields.next().is_some() {
            return Err(format!("corner {} has more than three indices", shown(token)));
        }
        Ok([position, uv, normal])
    }

    fn vertex(&mut self, triple: [u32; 3], assembly: &mut Assembly<'_>) -> Result<u32> {
        if let Some(&number) = self.vertices.get(&triple) {
            return Ok(number);
        }
        let [p, t, n] = triple.map(|i| i as usize);
        let number = assembly.push_vertex(Vertex {
            position: self.positions[p],
            normal: self.normals.get(n).copied(),
            uv: self.uvs.get(t).copied(),
        })?;
        self.vertices.insert(triple, number);
        Ok(number)
    }
}

/// An index from zero: OBJ counts from 1, and negative ones from the end of what has been read so far.
fn index(text: &[u8], len: usize, what: &str) -> Result<u32, String> {
    let parsed = std::str::from_utf8(text).ok().and_then(|t| t.parse::<i64>().ok());
    let number = parsed.ok_or_else(|| format!("{} is not the index of a {what}", shown(text)))?;
    let from_zero = if number < 0 { number.checked_add(len as i64) } else { number.checked_sub(1) };
    let in_range = from_zero.and_then(|i| usize::try_from(i).ok()).filter(|&i| i < len && i < NONE as usize);
    in_range.map(|i| i as u32).ok_or_else(|| format!("{what} {number} does not exist; there are {len} up to here"))
}

fn numbers<'a, const N: usize>(mut tokens: impl Iterator<Item = &'a [u8]>) -> Result<[f32; N], String> {
    let mut values = [0.0; N];
    for value in &mut values {
        let token = tokens.next().ok_or_else(|| format!("fewer than {N} numbers"))?;
        let parsed = std::str::from_utf8(token).ok().and_then(|t| t.parse::<f32>().ok());
        *value = parsed.filter(|v| v.is_finite()).ok_or_else(|| format!("{} is not a finite number", shown(token)))?;
    }
    Ok(values)
}

/// The start of a token, fit to be printed.
fn shown(token: &[u8]) -> String {
    let start = String::from_utf8_lossy(&token[..token.len().min(32)]);
    format!("\"{}\"", start.escape_debug())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Error, Limits, MeshFile, Source, decode_mesh};

    fn load(text: &str) -> Result<MeshFile> {
        decode_mesh(&Source::from_bytes("a.obj", text.into()), &Limits::default())
    }

    fn place_of(text: &str) -> String {
        match load(text).unwrap_err() {
            Error::Format { place, .. } => place,
            e => panic!("{e}"),
        }
    }

    #[test]
    fn corners_are_shared_by_their_whole_triple() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0.25 7\nvt 1\nvn 0 0 2\n\
                    f 1/1/1 2/2/1 3/2/1\nf 1/1/1 3/2/1 4/3/1\nf 1/3/1 3/2/1 4/3/1\n";
        let mesh = load(text).unwrap().mesh;
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [4, 2, 3]]);
        assert_eq!(mesh.uvs()[..3], [Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75), Vec2::new(1.0, 0.75)]);
        assert_eq!(mesh.normals(), [Vec3::Z; 5]);
    }

    #[test]
    fn negative_indices_count_from_the_last_line_read() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 1 1 0\nf -2 -3 -1\nf 3 2 4";
        assert_eq!(load(text).unwrap().mesh.triangles(), [[0, 1, 2], [2, 1, 3], [2, 1, 3]]);
    }

    #[test]
    fn lines_continue_after_a_backslash_and_the_last_needs_no_end() {
        let text = "v 0 0 0\nv 1 \\\n0 0\r\nv\t0 1 0 # a comment \\\nf 1 \\\r\n2 \\\n3";
        assert_eq!(load(text).unwrap().mesh.triangles(), [[0, 1, 2]]);
    }

    #[test]
    fn some_corners_without_coordinates_are_reported() {
        let file = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nf 1/1 2 3//\n").unwrap();
        assert_eq!(file.mesh.uvs(), [Vec2::splat(0.5), Vec2::ZERO, Vec2::ZERO]);
        assert!(file.warnings[0].starts_with("2 of 3 vertices"), "{:?}", file.warnings);
    }

    #[test]
    fn errors_name_the_line() {
        let start = "# comment\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for (line, text) in [
            (5, "f 1 2 4"),
            (5, "f 1 2 -4"),
            (5, "f 0 1 2"),
            (5, "f 1/1 2 3"),
            (5, "f 1//-1 2 3"),
            (5, "f 1/// 2 3"),
            (5, "f a b c"),
            (5, "v 1 2"),
            (5, "v 1 2 nan"),
            (6, "\nv 1 2 1e39"),
            (7, "f 1 2 \\\n3\nvt x"),
            (5, "f 1 \\\n2 \\\n9"),
            (5, "f 1 2 9223372036854775808"),
            (5, "f 1 2 -9223372036854775808"),
            (6, "\n\0"),
        ] {
            assert_eq!(place_of(&format!("{start}{text}")), format!("line {line}"), "{text:?}");
        }
        assert_eq!(place_of("hello\nworld"), "file");
    }

    #[test]
    fn limits_hold() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
        for (limits, fits) in [
            (Limits { max_vertices: 3, ..Limits::default() }, false),
            (Limits { max_triangles: 1, ..Limits::default() }, false),
            (Limits { max_vertices: 4, max_triangles: 2, ..Limits::default() }, true),
        ] {
            let got = decode_mesh(&Source::from_bytes("a.obj", text.into()), &limits);
            assert_eq!(got.is_ok(), fits);
            assert!(fits || matches!(got, Err(Error::Limits { .. })));
        }
    }
}
