//! Meshes: OBJ, PLY and glTF, plain or gzipped.
//!
//! OBJ and PLY have readers of their own: a mesh of untrusted origin needs messages with line numbers, counts that are
//! checked against the bytes that are there before anything is allocated, and polygons cut without flipped triangles.
//! The JSON of glTF is typed by the `gltf` crate; what it points to is read here, because the crate's iterators index
//! buffers by what an unchecked accessor says.

mod assemble;
mod glb;
mod obj;
mod ply;
mod polygon;

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;
use rilievo::surface::Mesh;

use crate::{Error, Limits, Result, Source};
use assemble::Assembly;

/// A mesh, and what its file had that was not used as it stands.
#[derive(Debug, Clone)]
pub struct MeshFile {
    /// The mesh.
    pub mesh: Mesh,
    /// Complete sentences for the user, without the file's name.
    pub warnings: Vec<String>,
}

/// Reads a mesh: OBJ, PLY (ASCII and binary of both byte orders), GLB or glTF; each may be gzipped.
///
/// The format is told by the content; only OBJ, which has no signature, is taken for what is left. All parts of the file
/// become one mesh: glTF nodes are placed by their transforms, polygons are cut into triangles. OBJ and PLY texture
/// coordinates, whose v runs up from the bottom row, are turned to the library's v down. Triangles without an area
/// and what cannot be used (points, lines, skins) are left out with a warning.
///
/// A `.gltf` may keep its buffers beside it, in the folder of the source's name; they are read within the same limits.
///
/// # Errors
/// [`Error::Format`] for damage, with its line or element; [`Error::Limits`] for more vertices, triangles or unpacked
/// bytes than allowed; [`Error::Unsupported`] for required extensions (Draco and the like) and buffers outside the
/// folder; [`Error::Invalid`] if the mesh is none (no faces, NaN positions); [`Error::Io`] for a buffer file that cannot be read.
pub fn decode_mesh(source: &Source, limits: &Limits) -> Result<MeshFile> {
    let name = source.name();
    if !source.bytes().starts_with(&[0x1f, 0x8b]) {
        return decode(name, source.bytes(), limits);
    }
    decode(name, &gunzip(name, source.bytes(), limits)?, limits)
}

fn decode(name: &str, bytes: &[u8], limits: &Limits) -> Result<MeshFile> {
    let mut assembly = Assembly::new(name, limits);
    let visible = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if bytes.is_empty() {
        return Err(Error::format(name, "start", "the file is empty; give a mesh"));
    } else if bytes.starts_with(b"glTF") {
        glb::decode_glb(bytes, &mut assembly)?;
    } else if visible.starts_with(b"{") {
        glb::decode_gltf(bytes, Path::new(name), &mut assembly)?;
    } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        ply::decode_ply(bytes, &mut assembly)?;
    } else {
        obj::decode_obj(bytes, &mut assembly)?;
    }
    assembly.finish()
}

/// Unpacks a gzip file, all its members, up to the limit on files.
fn gunzip(name: &str, bytes: &[u8], limits: &Limits) -> Result<Vec<u8>> {
    let mut unpacked = Vec::new();
    let mut from = MultiGzDecoder::new(bytes).take(limits.max_file_bytes.saturating_add(1));
    from.read_to_end(&mut unpacked)
        .map_err(|e| Error::format(name, "gzip stream", format!("{e}; the file is cut or damaged")))?;
    if unpacked.len() as u64 > limits.max_file_bytes {
        return Err(Error::limits(name, "what the gzip file unpacks to", format!("{} bytes", limits.max_file_bytes)));
    }
    Ok(unpacked)
}
