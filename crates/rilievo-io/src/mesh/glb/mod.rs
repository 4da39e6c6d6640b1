//! glTF 2.0, binary (GLB) or JSON with its buffers inside or beside it.

mod accessor;
mod buffers;
mod scene;

use std::path::Path;

use gltf::json::Root;

use super::assemble::Assembly;
use crate::{Error, Result};
use buffers::Buffers;

/// Extensions that change how a mesh looks, but not its shape or its texture coordinates.
const HARMLESS: [&str; 5] =
    ["KHR_lights_punctual", "KHR_texture_basisu", "KHR_xmp_json_ld", "EXT_texture_webp", "EXT_texture_avif"];

pub(super) fn decode_glb(bytes: &[u8], assembly: &mut Assembly<'_>) -> Result<()> {
    let (json, bin) = split_chunks(bytes, assembly)?;
    decode(json, bin, None, assembly)
}

pub(super) fn decode_gltf(bytes: &[u8], path: &Path, assembly: &mut Assembly<'_>) -> Result<()> {
    // Only a file that is there has files beside it; the standard input has none.
    let folder = path.parent().filter(|_| path.is_file());
    decode(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None, folder, assembly)
}

fn decode(json: &[u8], bin: Option<&[u8]>, folder: Option<&Path>, assembly: &mut Assembly<'_>) -> Result<()> {
    let root = Root::from_slice(json).map_err(|e| assembly.damage("JSON", e.to_string()))?;
    if root.asset.version != "2.0" && !root.asset.version.starts_with("2.") {
        let what = format!("glTF version {:?}", root.asset.version);
        return Err(Error::unsupported(assembly.name, what, "export it as glTF 2.0"));
    }
    let unknown = |e: &&String| !HARMLESS.contains(&e.as_str()) && !e.starts_with("KHR_materials_");
    if let Some(extension) = root.extensions_required.iter().find(unknown) {
        let remedy = match extension.as_str() {
            "KHR_draco_mesh_compression" => "export it without Draco compression",
            "EXT_meshopt_compression" => "export it without meshopt compression",
            "KHR_mesh_quantization" => "export it with positions as floats",
            _ => "export it without this extension",
        };
        return Err(Error::unsupported(assembly.name, format!("the required extension {extension:?}"), remedy));
    }
    let buffers = Buffers::new(&root, bin, folder, assembly)?;
    scene::decode_scene(&root, &buffers, assembly)
}

/// The JSON and binary chunks of a GLB; chunks of other kinds, after them, are passed over, as the format demands.
fn split_chunks<'b>(bytes: &'b [u8], assembly: &mut Assembly<'_>) -> Result<(&'b [u8], Option<&'b [u8]>)> {
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b));
    let cut = |at: usize| assembly.damage(format!("byte {at}"), "the file is cut here");
    let version = word(4).ok_or_else(|| cut(bytes.len()))?;
    if version != 2 {
        return Err(Error::unsupported(assembly.name, format!("GLB version {version}"), "export it as glTF 2.0"));
    }
    let length = word(8).ok_or_else(|| cut(bytes.len()))? as usize;
    if length > bytes.len() {
        let reason = format!("the header declares {length} bytes, but there are {}; the file is cut", bytes.len());
        return Err(assembly.damage("byte 8", reason));
    }
    let (mut at, mut json, mut bin) = (12, None, None);
    while at < length {
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else { return Err(cut(at)) };
        let begin = at + 8;
        let end = begin.checked_add(size as usize).filter(|&end| end <= length);
        let end = end.ok_or_else(|| {
            let reason = format!("a chunk of {size} bytes is longer than the rest of the file");
            assembly.damage(format!("byte {at}"), reason)
        })?;
        let slot = match &kind.to_le_bytes() {
            b"JSON" => &mut json,
            b"BIN\0" => &mut bin,
            _ if json.is_some() => &mut None,
            _ => return Err(assembly.damage(format!("byte {at}"), "the first chunk is not JSON")),
        };
        if slot.replace(&bytes[begin..end]).is_some() {
            return Err(assembly.damage(format!("byte {at}"), "a second chunk of the same kind"));
        }
        if json.is_none() {
            return Err(assembly.damage(format!("byte {at}"), "the first chunk is not JSON"));
        }
        at = end;
    }
    if length < bytes.len() {
        assembly.warn(format!("{} bytes after the end of the GLB were left out.", bytes.len() - length));
    }
    let json = json.ok_or_else(|| assembly.damage("byte 12", "no JSON chunk"))?;
    Ok((json, bin))
}
