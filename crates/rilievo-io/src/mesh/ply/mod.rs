//! PLY, the Stanford polygon format: ASCII and binary of both byte orders (Turk 1994, "The PLY Polygon File Format").

mod body;
mod header;

use glam::{Vec2, Vec3};

use super::assemble::{Assembly, Vertex};
use crate::Result;
use body::Body;
use header::{Element, Header, Kind};

/// Names that writers use for what a vertex has. Texture coordinates come from scanners' tools (s, t), Blender and
/// Assimp (s, t or u, v) and MeshLab (texture_u, texture_v).
const VERTEX_NAMES: [&[&str]; 8] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx", "normal_x"],
    &["ny", "normal_y"],
    &["nz", "normal_z"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
];

pub(super) fn decode_ply(bytes: &[u8], assembly: &mut Assembly<'_>) -> Result<()> {
    let header = Header::parse(bytes).map_err(|(line, reason)| assembly.damage(format!("line {line}"), reason))?;
    let mut body = Body::new(&header, &bytes[header.length..]);
    let mut known = 0;
    for element in &header.elements {
        let read = match element.name.as_str() {
            "vertex" => read_vertices(element, &mut body, assembly),
            "face" => read_lists(element, Lists::Polygons, &mut body, assembly),
            "tristrips" => read_lists(element, Lists::Strips, &mut body, assembly),
            _ => {
                skip(element, &mut body, assembly)?;
                continue;
            }
        };
        read?;
        known += 1;
    }
    if known == 0 {
        return Err(assembly.damage("header", "neither vertices nor faces are declared"));
    }
    Ok(())
}

/// Checks a declared count against the bytes that are left, which also bounds all that is allocated for it.
fn check_count(element: &Element, body: &Body<'_>, assembly: &Assembly<'_>) -> Result<()> {
    let (needed, left) = (body.least_bytes(element), body.left() as u64);
    if needed > u128::from(left) {
        let Element { name, count, .. } = element;
        let reason = format!("{count} × {name} need at least {needed} bytes, but only {left} are left");
        return Err(assembly.damage("header", format!("{reason}; the file is cut or its counts are wrong")));
    }
    Ok(())
}

fn skip(element: &Element, body: &mut Body<'_>, assembly: &Assembly<'_>) -> Result<()> {
    check_count(element, body, assembly)?;
    if element.properties.is_empty() {
        return Ok(());
    }
    for k in 0..element.count {
        body.read(element, |_, _| {}).map_err(|e| body.damage(element, k, e, assembly))?;
    }
    Ok(())
}

fn read_vertices(element: &Element, body: &mut Body<'_>, assembly: &mut Assembly<'_>) -> Result<()> {
    check_count(element, body, assembly)?;
    assembly.check_vertices(element.count)?;
    // Which of the eight numbers each property is.
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|p| match p.kind {
            Kind::Scalar(_) => VERTEX_NAMES.iter().position(|names| names.contains(&p.name.as_str())),
            Kind::List { .. } => None,
        })
        .collect();
    let has = |k: usize| slots.contains(&Some(k));
    if !(0..3).all(has) {
        return Err(assembly.damage("header", "vertices have no x, y and z"));
    }
    let (with_normal, with_uv) = ((3..6).all(has), (6..8).all(has));
    for k in 0..element.count {
        let mut v = [0.0f32; 8];
        body.read(element, |property, value| {
            if let Some(slot) = slots[property] {
                v[slot] = value as f32;
            }
        })
        .map_err(|e| body.damage(element, k, e, assembly))?;
        let position = Vec3::new(v[0], v[1], v[2]);
        // v from the bottom row up, as all known writers have it, to v down.
        let uv = with_uv.then(|| Vec2::new(v[6], 1.0 - v[7]));
        if !(position.is_finite() && uv.unwrap_or_default().is_finite()) {
            return Err(body.damage(element, k, "a coordinate is not a finite number".into(), assembly));
        }
        let normal = with_normal.then(|| Vec3::new(v[3], v[4], v[5]));
        assembly.push_vertex(Vertex { position, normal, uv })?;
    }
    Ok(())
}

/// What the index lists of an element are.
#[derive(Clone, Copy, PartialEq)]
enum Lists {
    Polygons,
    Strips,
}

fn read_lists(element: &Element, lists: Lists, body: &mut Body<'_>, assembly: &mut Assembly<'_>) -> Result<()> {
    check_count(element, body, assembly)?;
    let is_list = |k: Kind| matches!(k, Kind::List { .. });
    let indices = element
        .properties
        .iter()
        .position(|p| is_list(p.kind) && matches!(p.name.as_str(), "vertex_indices" | "vertex_index"));
    let Some(indices) = indices else {
        let reason = format!("{} elements have no list vertex_indices", element.name);
        return Err(assembly.damage("header", reason));
    };
    if element.properties.iter().any(|p| is_list(p.kind) && p.name == "texcoord") {
        assembly.warn("Texture coordinates of faces' corners are not read; store them with the vertices, or use OBJ.");
    }
    let vertices = assembly.vertices() as f64;
    let mut corners: Vec<u32> = Vec::new();
    for k in 0..element.count {
        corners.clear();
        let mut wrong = None;
        body.read(element, |property, value| {
            if property != indices {
                return;
            }
            let restart = lists == Lists::Strips && value == -1.0;
            let valid = value >= 0.0 && value < vertices && value.fract() == 0.0;
            if !(valid || restart) {
                wrong = Some(value);
            }
            corners.push(if restart { RESTART } else { value as u32 });
        })
        .map_err(|e| body.damage(element, k, e, assembly))?;
        if let Some(index) = wrong {
            let reason = format!("vertex index {index} is not one of the {vertices} vertices before it");
            return Err(body.damage(element, k, reason, assembly));
        }
        match lists {
            Lists::Polygons => assembly.push_polygon(|| format!("face {k}"), &corners)?,
            Lists::Strips => push_strips(&corners, assembly)?,
        }
    }
    Ok(())
}

/// Ends a strip; not a vertex, since the limits keep their numbers below it.
const RESTART: u32 = u32::MAX;

/// Strips between restarts; every second triangle is wound the other way. Repeated vertices are how writers join strips
/// and turn their winding; the triangles they make are none.
fn push_strips(corners: &[u32], assembly: &mut Assembly<'_>) -> Result<()> {
    for strip in corners.split(|&i| i == RESTART) {
        for (k, w) in strip.windows(3).enumerate() {
            let [a, b, c] = if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            if a != b && b != c && c != a {
                assembly.push_triangle([a, b, c])?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Error, Limits, MeshFile, Source, decode_mesh};

    fn load(bytes: impl Into<Vec<u8>>) -> Result<MeshFile> {
        decode_mesh(&Source::from_bytes("a.ply", bytes.into()), &Limits::default())
    }

    const HEAD: &str = "element vertex 4\nproperty double x\nproperty float32 y\nproperty short z\n\
        property uchar confidence\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n\
        property float t\nelement other 2\nproperty list ushort int16 junk\nelement face 2\nproperty int flag\n\
        property list uint8 uint vertex_indices\nend_header\n";

    fn binary(order: &str) -> Vec<u8> {
        let big = order == "big";
        let mut out = format!("ply\nformat binary_{order}_endian 1.0\ncomment c\nobj_info o\n{HEAD}").into_bytes();
        let mut put = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            if big {
                bytes.reverse();
            }
            out.extend(bytes);
        };
        for (x, y) in [(0.0f64, 0.0f32), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            put(&x.to_le_bytes());
            put(&y.to_le_bytes());
            put(&(-3i16).to_le_bytes());
            put(&[200]);
            for n in [0.0f32, 0.0, -4.0, x as f32, y * 0.25] {
                put(&n.to_le_bytes());
            }
        }
        for junk in [&[7i16, 8][..], &[]] {
            put(&(junk.len() as u16).to_le_bytes());
            junk.iter().for_each(|j| put(&j.to_le_bytes()));
        }
        for face in [&[0u32, 1, 2][..], &[0, 1, 2, 3]] {
            put(&(-1i32).to_le_bytes());
            put(&[face.len() as u8]);
            face.iter().for_each(|i| put(&i.to_le_bytes()));
        }
        out
    }

    fn ascii() -> String {
        format!(
            "ply\r\nformat ascii 1.0\r\n{}0 0 -3 200 0 0 -4 0 0\n1 0 -3 200 0 0 -4 1 0\n\n1 1 -3 200 0 0 -4 1 .25\n\
             0 1 -3 200 0 0 -4 0 .25 \n2 7 8\n0\n-1 3 0 1 2\n-1 4 0 1 2 3",
            HEAD.replace('\n', "\r\n")
        )
    }

    #[test]
    fn all_encodings_read_the_same() {
        let mesh = load(ascii()).unwrap().mesh;
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions()[2], Vec3::new(1.0, 1.0, -3.0));
        assert_eq!(mesh.normals(), [-Vec3::Z; 4]);
        assert_eq!(mesh.uvs()[2], Vec2::new(1.0, 0.75));
        assert_eq!(load(binary("little")).unwrap().mesh, mesh);
        assert_eq!(load(binary("big")).unwrap().mesh, mesh);
    }

    #[test]
    fn every_prefix_is_an_error() {
        for whole in [ascii().into_bytes(), binary("little"), binary("big")] {
            // The last byte of the text is a digit of the last index; its line end is not needed.
            for n in 0..whole.len() {
                assert!(load(&whole[..n]).is_err(), "{n} of {}", whole.len());
            }
        }
    }

    #[test]
    fn strips_alternate_and_restart() {
        let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
            element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
            0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n10 0 1 2 3 3 -1 2 3 4 -1\n";
        let mesh = load(text).unwrap().mesh;
        assert_eq!(mesh.triangles(), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(mesh.dropped_triangles(), 0);
        assert_eq!(mesh.normals(), [Vec3::Z; 5]);
    }

    #[test]
    fn errors_name_their_place() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        load(text).unwrap();
        for (from, to, expected) in [
            ("3 0 1 2", "3 0 1 3", "line 13"),
            ("3 0 1 2", "3 0 1 2 2", "line 13"),
            ("3 0 1 2", "4 0 1 2", "line 13"),
            ("3 0 1 2", "-3 0 1 2", "line 13"),
            ("1 0 0", "1 0 x", "line 11"),
            ("1 0 0", "1 0", "line 11"),
            ("1 0 0", "inf 0 0", "line 11"),
            ("face 1", "face 2", "line 13"),
            ("vertex 3", "vertex -3", "line 3"),
            ("vertex 3", "vertex 400000000", "header"),
            ("uchar int", "float int", "line 8"),
            ("uchar int", "uchar", "line 8"),
            ("1.0", "2.0", "line 2"),
            ("property float z", "property float w", "header"),
        ] {
            match load(text.replacen(from, to, 1)).unwrap_err() {
                Error::Format { place, .. } => assert_eq!(place, expected, "{to}"),
                e => panic!("{to}: {e}"),
            }
        }
    }
}
