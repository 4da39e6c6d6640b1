//! The nodes of a glTF scene, flattened into one mesh in the scene's space.

use glam::{DMat3, DMat4, DQuat, DVec3, Vec2, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::scene::Node;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::super::assemble::{Assembly, Vertex};
use super::accessor::{NORMAL, POSITION, Reader, TEXCOORD};
use super::buffers::Buffers;
use crate::Result;

pub(super) fn decode_scene(root: &Root, buffers: &Buffers<'_>, assembly: &mut Assembly<'_>) -> Result<()> {
    let reader = Reader { root, buffers };
    let Some(roots) = scene_roots(root, assembly)? else {
        // A library of meshes without a scene.
        for mesh in 0..root.meshes.len() {
            place_mesh(&reader, mesh, DMat4::IDENTITY, assembly)?;
        }
        return Ok(());
    };
    let mut visited = vec![false; root.nodes.len()];
    let mut waiting: Vec<(usize, DMat4)> = roots.iter().rev().map(|&k| (k, DMat4::IDENTITY)).collect();
    let mut skins = 0;
    while let Some((k, parent)) = waiting.pop() {
        let place = || format!("node {k}");
        let node = root.nodes.get(k).ok_or_else(|| assembly.damage(place(), "it does not exist"))?;
        // Nodes form a forest, so no node is reached twice; this also ends cycles.
        if std::mem::replace(&mut visited[k], true) {
            return Err(assembly.damage(place(), "it is reached twice; nodes must not form cycles or share children"));
        }
        let transform = parent * local_transform(node);
        skins += usize::from(node.skin.is_some());
        if let Some(mesh) = node.mesh {
            place_mesh(&reader, mesh.value(), transform, assembly)?;
        }
        let children = node.children.iter().flatten().rev();
        waiting.extend(children.map(|child| (child.value(), transform)));
    }
    if skins > 0 {
        assembly.warn("Skins are not applied; meshes stand in their bind pose.");
    }
    Ok(())
}

/// The roots of the default scene, else of the first, else all nodes that are nobody's child; `None` without nodes.
fn scene_roots(root: &Root, assembly: &Assembly<'_>) -> Result<Option<Vec<usize>>> {
    let number = root.scene.map_or(0, |scene| scene.value());
    match root.scenes.get(number) {
        Some(scene) => Ok(Some(scene.nodes.iter().map(Index::value).collect())),
        None if root.scene.is_some() => Err(assembly.damage(format!("scene {number}"), "it does not exist")),
        None if root.nodes.is_empty() => Ok(None),
        None => {
            let mut is_child = vec![false; root.nodes.len()];
            for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
                if let Some(slot) = is_child.get_mut(child.value()) {
                    *slot = true;
                }
            }
            Ok(Some((0..is_child.len()).filter(|&k| !is_child[k]).collect()))
        }
    }
}

fn local_transform(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vec = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    let (scale, translation) = (node.scale.map_or(DVec3::ONE, vec), node.translation.map_or(DVec3::ZERO, vec));
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}

fn place_mesh(reader: &Reader<'_, '_>, number: usize, transform: DMat4, assembly: &mut Assembly<'_>) -> Result<()> {
    let mesh = reader.root.meshes.get(number);
    let mesh = mesh.ok_or_else(|| assembly.damage(format!("mesh {number}"), "it does not exist"))?;
    for (k, primitive) in mesh.primitives.iter().enumerate() {
        place_primitive(reader, primitive, &format!("mesh {number}, primitive {k}"), transform, assembly)?;
    }
    Ok(())
}

fn place_primitive(
    reader: &Reader<'_, '_>,
    primitive: &Primitive,
    place: &str,
    transform: DMat4,
    assembly: &mut Assembly<'_>,
) -> Result<()> {
    let mode = match primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(_) => {
            assembly.warn(format!("Points or lines ({place}) were left out."));
            return Ok(());
        }
        Checked::Invalid => return Err(assembly.damage(place, "its mode is unknown")),
    };
    let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let positions = attribute(Semantic::Positions).ok_or_else(|| assembly.damage(place, "it has no POSITION"))?;
    let positions = reader.floats::<3>(positions, &POSITION, assembly)?;
    let normals = attribute(Semantic::Normals).map(|a| reader.floats::<3>(a, &NORMAL, assembly)).transpose()?;
    let uvs = attribute(Semantic::TexCoords(0)).map(|a| reader.floats::<2>(a, &TEXCOORD, assembly)).transpose()?;
    let count = positions.len();
    let lengths = [normals.as_ref().map(Vec::len), uvs.as_ref().map(Vec::len)];
    if lengths.into_iter().flatten().any(|n| n != count) {
        return Err(assembly.damage(place, "its attributes differ in length"));
    }
    let first = assembly.vertices();
    assembly.check_vertices(first as u64 + count as u64)?;

    let linear = DMat3::from_mat4(transform);
    let mirrored = linear.determinant() < 0.0;
    let to_normal = cofactors(linear) * if mirrored { -1.0 } else { 1.0 };
    for k in 0..count {
        let position = transform.transform_point3(Vec3::from_array(positions[k]).as_dvec3()).as_vec3();
        let uv = uvs.as_ref().map(|uvs| Vec2::from_array(uvs[k]));
        if !(position.is_finite() && uv.unwrap_or_default().is_finite()) {
            return Err(assembly.damage(place, format!("a coordinate of vertex {k} is not a finite number")));
        }
        // Normalised in f64: cofactors are squares of the scale, which f32 may not hold.
        let turned = normals.as_ref().map(|normals| to_normal * Vec3::from_array(normals[k]).as_dvec3());
        let normal = turned.map(|n| n.normalize_or_zero().as_vec3());
        assembly.push_vertex(Vertex { position, normal, uv })?;
    }

    let indices = match primitive.indices {
        Some(indices) => reader.indices(indices, count, assembly)?,
        None => (0..count as u32).collect(),
    };
    // Counter-clockwise from outside, after mirroring too.
    let mut push = |a: u32, b: u32, c: u32| {
        let [a, b, c] = if mirrored { [a, c, b] } else { [a, b, c] };
        assembly.push_triangle([a, b, c].map(|i| i + first as u32))
    };
    match mode {
        Mode::TriangleStrip => {
            for (k, w) in indices.windows(3).enumerate().filter(|(_, w)| w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) {
                // Specification 2.0, section 3.7.2.1: p = (v i, v i + (1 + i % 2), v i + (2 − i % 2)).
                push(w[0], w[1 + k % 2], w[2 - k % 2])?;
            }
        }
        Mode::TriangleFan => {
            for w in indices.get(1..).unwrap_or_default().windows(2) {
                push(w[0], w[1], indices[0])?;
            }
        }
        _ => {
            for t in indices.chunks_exact(3) {
                push(t[0], t[1], t[2])?;
            }
            if indices.len() % 3 != 0 {
                assembly.warn(format!(
                    "{} indices after the last whole triangle ({place}) were left out.",
                    indices.len() % 3
                ));
            }
        }
    }
    Ok(())
}

/// The cofactor matrix: the inverse transpose times the determinant, and so defined for flattening transforms too.
fn cofactors(m: DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

#[cfg(test)]
mod tests {
    use rilievo::surface::Mesh;

    use super::*;
    use crate::{Error, Limits, MeshFile, Source, decode_mesh};

    /// A GLB of four corners of a square with normals and coordinates in u16, around the given JSON members.
    fn glb(members: &str) -> Vec<u8> {
        let mut bin = Vec::new();
        for (x, y) in [(0.0f32, 0.0f32), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            bin.extend([x, y, 0.0, 0.0, 0.0, 1.0].into_iter().flat_map(f32::to_le_bytes));
            bin.extend([x, y].into_iter().flat_map(|v| ((v * 65535.0) as u16).to_le_bytes()));
        }
        bin.extend([0u8, 1, 2, 3, 1, 0, 0, 0]);
        bin.extend([2.0f32, 2.0, 0.0].into_iter().flat_map(f32::to_le_bytes));
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{length}}}],"bufferViews":[
            {{"buffer":0,"byteLength":112,"byteStride":28}},{{"buffer":0,"byteOffset":112,"byteLength":4}},
            {{"buffer":0,"byteOffset":115,"byteLength":1}},{{"buffer":0,"byteOffset":120,"byteLength":12}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}},
            {{"bufferView":0,"byteOffset":12,"componentType":5126,"type":"VEC3","count":4}},
            {{"bufferView":0,"byteOffset":24,"componentType":5123,"normalized":true,"type":"VEC2","count":4}},
            {{"bufferView":1,"componentType":5121,"type":"SCALAR","count":4}},
            {{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"sparse":{{"count":1,
              "indices":{{"bufferView":2,"componentType":5121}},"values":{{"bufferView":3}}}}}}],{members}}}"#,
            length = bin.len()
        );
        let json = format!("{json:w$}", w = json.len().next_multiple_of(4));
        let mut out = b"glTF\x02\0\0\0".to_vec();
        out.extend((28 + json.len() as u32 + bin.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &bin)] {
            out.extend((chunk.len() as u32).to_le_bytes());
            out.extend(kind);
            out.extend(chunk);
        }
        out
    }

    fn load(members: &str) -> Result<MeshFile> {
        decode_mesh(&Source::from_bytes("a.glb", glb(members)), &Limits::default())
    }

    fn square(mode: u32, nodes: &str) -> Mesh {
        load(&format!(
            r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3,
            "mode":{mode}}}]}}],{nodes}"#
        ))
        .unwrap()
        .mesh
    }

    #[test]
    fn modes_keep_their_winding() {
        let nodes = r#""nodes":[{"mesh":0}]"#;
        assert_eq!(square(4, nodes).triangles(), [[0, 1, 2]]);
        assert_eq!(square(5, nodes).triangles(), [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(square(6, nodes).triangles(), [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(square(5, nodes).uvs()[3], Vec2::ONE);
    }

    #[test]
    fn transforms_chain_and_mirrors_keep_the_outside() {
        // Scaled by 2 along z and mirrored in x, then turned by 90 degrees about y, then moved.
        let mesh = square(
            5,
            r#""scenes":[{"nodes":[1]}],"nodes":[{"mesh":0,"scale":[-1,1,2]},
            {"children":[0],"rotation":[0,0.70710678,0,0.70710678],"translation":[0,0,5]}]"#,
        );
        let at = |x: f32, y: f32| Vec3::new(0.0, y, 5.0 + x);
        for (p, (x, y)) in mesh.positions().iter().zip([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]) {
            assert!(p.distance(at(x, y)) < 1e-6, "{p}");
        }
        assert_eq!(mesh.triangles(), [[0, 2, 1], [1, 2, 3]]);
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
            assert!((b - a).cross(c - a).dot(mesh.normals()[t[0] as usize]) > 0.0);
        }
        assert!(mesh.normals().iter().all(|n| n.distance(Vec3::X) < 1e-6));
    }

    #[test]
    fn uneven_scale_turns_normals_by_the_inverse_transpose() {
        // Turned by 45 degrees about x, then flattened to half along y: the plane y = −z becomes y = −z/2.
        let mesh = square(
            4,
            r#""nodes":[{"mesh":0,"rotation":[0.38268343,0,0,0.92387953]},{"children":[0],"scale":[1,0.5,1]}]"#,
        );
        let [a, b, c] = [0, 1, 2].map(|i| mesh.positions()[i]);
        let face = (b - a).cross(c - a).normalize();
        assert!(mesh.normals()[0].distance(face) < 1e-6, "{} {face}", mesh.normals()[0]);
    }

    #[test]
    fn sparse_values_replace() {
        let mesh = load(r#""meshes":[{"primitives":[{"attributes":{"POSITION":4},"mode":5}]}]"#).unwrap().mesh;
        assert_eq!(mesh.positions()[3], Vec3::new(2.0, 2.0, 0.0));
        assert_eq!(mesh.positions()[1], Vec3::X);
    }

    #[test]
    fn node_graphs_that_are_no_forest_are_errors() {
        let mesh = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;
        for nodes in [
            r#""scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0],"mesh":0}]"#,
            r#""scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{"mesh":0}]"#,
            r#""scenes":[{"nodes":[0]}],"nodes":[{"children":[0],"mesh":0}]"#,
            r#""scenes":[{"nodes":[7]}],"nodes":[{"mesh":0}]"#,
            r#""scene":3,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}]"#,
            r#""nodes":[{"mesh":1}]"#,
        ] {
            assert!(matches!(load(&format!("{mesh},{nodes}")), Err(Error::Format { .. })), "{nodes}");
        }
    }
}
