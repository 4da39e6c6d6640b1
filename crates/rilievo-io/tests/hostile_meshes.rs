//! Damaged, odd and real mesh files: nothing panics, nothing is swallowed, and what loads is sound.

#![allow(clippy::unwrap_used, reason = "tests, and their helpers")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rilievo::surface::Mesh;
use rilievo_io::{Error, Limits, MeshFile, Result, Source, decode_mesh};
use testkit::{Random, shared_data, shared_file};

/// Small enough that hostile counts cannot hide behind a large machine.
fn limits() -> Limits {
    Limits { max_file_bytes: 64 << 20, max_vertices: 1 << 20, max_triangles: 1 << 21, ..Limits::default() }
}

fn open(path: &Path) -> Result<MeshFile> {
    decode_mesh(&Source::open(path, &Limits::default())?, &limits())
}

fn decode(name: &str, bytes: Vec<u8>) -> Result<MeshFile> {
    decode_mesh(&Source::from_bytes(name, bytes), &limits())
}

/// What every loaded mesh must be, whatever its file was.
fn check_sound(what: &str, mesh: &Mesh) {
    assert!(!mesh.triangles().is_empty() || mesh.dropped_triangles() > 0, "{what}");
    let vertices = mesh.positions().len();
    assert!(mesh.triangles().iter().flatten().all(|&i| (i as usize) < vertices), "{what}");
    assert!(mesh.positions().iter().all(|p| p.is_finite()), "{what}");
    assert_eq!(mesh.normals().len(), vertices, "{what}");
    assert!(mesh.normals().iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{what}");
    assert!(mesh.uvs().is_empty() || mesh.uvs().len() == vertices, "{what}");
    assert!(mesh.uvs().iter().all(|uv| uv.is_finite()), "{what}");
    let (center, radius) = mesh.bounding_sphere();
    assert!(center.is_finite() && radius.is_finite() && radius > 0.0, "{what}");
    if mesh.uvs().is_empty() {
        return;
    }
    let mesh = mesh.clone().with_tangents().unwrap();
    assert_eq!(mesh.tangents().len(), mesh.positions().len(), "{what}");
    for t in mesh.tangents() {
        assert!((t.truncate().length() - 1.0).abs() < 1e-5 && t.w.abs() == 1.0, "{what}: {t}");
    }
}

fn mesh_files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|p| matches!(p.extension().and_then(|e| e.to_str()), Some("obj" | "ply" | "glb" | "gltf")))
        .collect();
    files.sort();
    files
}

/// The list's own words: entries that begin with "error" must fail, all others must load.
#[test]
fn malformed_files_do_what_the_list_says() {
    let Some(folder) = shared_data().map(|data| data.join("malformed")) else { return };
    let list = std::fs::read_to_string(folder.join("EXPECT.json")).unwrap();
    let list: BTreeMap<String, BTreeMap<String, String>> = serde_json::from_str(&list).unwrap();
    // What the list leaves open, and what was chosen: `Some(n)` loads with n triangles, `None` is an error.
    let chosen: BTreeMap<&str, Option<usize>> = BTreeMap::from([
        ("inf_vertex.obj", None),
        ("two_vertex_face.obj", Some(18)),
        ("latin1_name.obj", Some(18)),
        ("ngon_concave.obj", Some(3)),
        // These are valid, but their only face has three corners in a line.
        ("index_negative_ok.obj", Some(0)),
        ("no_final_newline_continuation.obj", Some(0)),
    ]);
    let mut seen = 0;
    for path in mesh_files(&folder) {
        let name = path.file_name().unwrap().to_str().unwrap();
        let expect = list.get(name).unwrap_or_else(|| panic!("{name} is not in the list"))["expect"].as_str();
        seen += 1;
        let got = open(&path);
        let shown = got.as_ref().map(|f| (f.mesh.triangles().len(), &f.warnings)).map_err(ToString::to_string);
        eprintln!("{name}: {expect} | {shown:?}");
        if let Some(&chosen) = chosen.get(name) {
            assert_eq!(got.as_ref().ok().map(|f| f.mesh.triangles().len()), chosen, "{name}");
        } else {
            assert_eq!(got.is_err(), expect.starts_with("error"), "{name}: {expect}, but {shown:?}");
        }
        match got {
            Ok(file) => check_sound(name, &file.mesh),
            Err(e) => assert!(e.to_string().contains(name.split('.').next().unwrap()), "{name} is not named in {e}"),
        }
    }
    assert_eq!(seen, 61);
}

#[test]
fn malformed_files_say_where() {
    let Some(folder) = shared_data().map(|data| data.join("malformed")) else { return };
    let message = |name: &str| open(&folder.join(name)).unwrap_err().to_string();
    for name in ["nan_vertex", "inf_vertex", "index_out_of_range", "index_zero", "index_negative_bad", "index_huge"] {
        assert!(message(&format!("{name}.obj")).contains("line "), "{name}");
    }
    assert!(message("uri_missing.gltf").contains(".bin"));
    assert!(message("node_cycle.glb").contains("node"));
    let warnings = |name: &str| open(&folder.join(name)).unwrap().warnings.join(" ");
    assert!(warnings("zero_area.obj").contains("without an area"));
    for name in ["index_negative_ok.obj", "no_final_newline_continuation.obj"] {
        assert!(warnings(name).contains("nothing to be seen"), "{name}");
    }
    assert!(warnings("two_vertex_face.obj").contains("fewer than three corners"));
    // The same mesh in other spellings.
    let mesh = |name: &str| open(&folder.join(name)).unwrap().mesh;
    assert_eq!(mesh("crlf_tabs.obj"), mesh("no_uv.obj"));
    for name in ["unit_scale_tiny.obj", "unit_scale_huge.obj"] {
        assert_eq!(mesh(name).triangles(), mesh("no_uv.obj").triangles(), "{name}");
    }
}

/// All of these lack either geometry or the data of it (their accessors have no buffers and so are all zero), so none can
/// load; what matters is that each is refused in words, never by a panic.
#[test]
fn gltf_validator_files_are_refused_in_words() {
    let Some(folder) = shared_data().map(|data| data.join("malformed/gltf-validator")) else { return };
    let mut seen = 0;
    for part in ["accessor", "glb", "mesh", "mesh_data"] {
        for path in mesh_files(&folder.join(part)) {
            let name = path.file_name().unwrap().to_str().unwrap();
            let error = open(&path).err().unwrap_or_else(|| panic!("{name} has no geometry, but loads")).to_string();
            eprintln!("{error}");
            assert!(error.contains(name), "{error}");
            seen += 1;
        }
    }
    assert_eq!(seen, 79);
}

fn good_files() -> Vec<(String, Vec<u8>)> {
    let Some(folder) = shared_data().map(|data| data.join("malformed")) else { return Vec::new() };
    let names = ["good.glb", "good_le.ply", "no_uv.obj", "uv_mirrored.obj", "ngon_concave.obj"];
    names.map(|name| (name.to_owned(), std::fs::read(folder.join(name)).unwrap())).into()
}

#[test]
fn prefixes_never_panic() {
    for (name, whole) in good_files() {
        for n in 0..whole.len() {
            let got = decode(&name, whole[..n].to_vec());
            // A cut OBJ may be a smaller one; the other formats know their length.
            assert!(got.is_err() || name.ends_with(".obj"), "{name} cut to {n} of {} bytes", whole.len());
            if let Ok(file) = got {
                check_sound(&name, &file.mesh);
            }
        }
    }
}

#[test]
fn flipped_bits_never_panic() {
    let mut random = Random::new(0x5eed);
    for (name, whole) in good_files() {
        for _ in 0..4000 {
            let mut bytes = whole.clone();
            for _ in 0..1 + random.bits() % 4 {
                let at = (random.bits() % bytes.len() as u64) as usize;
                bytes[at] ^= 1 << (random.bits() % 8);
            }
            if let Ok(file) = decode(&name, bytes) {
                check_sound(&name, &file.mesh);
            }
        }
    }
}

#[test]
fn counts_are_checked_before_they_are_believed() {
    let header = |n: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\nproperty float y\n\
             property float z\nelement face {n}\nproperty list uint int vertex_indices\nend_header\n"
        )
    };
    // Unlimited limits: only the bytes that are there can refuse these.
    let limits = Limits { max_vertices: usize::MAX, max_triangles: usize::MAX, ..Limits::default() };
    for n in ["4000000000", "18446744073709551615", "9223372036854775807"] {
        let source = Source::from_bytes("huge.ply", header(n).into_bytes());
        assert!(matches!(decode_mesh(&source, &limits), Err(Error::Format { .. })), "{n}");
    }
    let mut long_list = header("1").replace("vertex 1", "vertex 0").into_bytes();
    long_list.extend(u32::MAX.to_le_bytes());
    assert!(matches!(decode_mesh(&Source::from_bytes("list.ply", long_list), &limits), Err(Error::Format { .. })));
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn gzip_is_unpacked_within_the_limit() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let packed = gzip(text);
    assert_eq!(decode("a.obj.gz", packed.clone()).unwrap().mesh, decode("a.obj", text.to_vec()).unwrap().mesh);
    for n in 2..packed.len() {
        assert!(matches!(decode("a.obj.gz", packed[..n].to_vec()), Err(Error::Format { .. })), "{n}");
    }
    let bomb = gzip(&vec![b'\n'; 65 << 20]);
    assert!(bomb.len() < 1 << 20);
    assert!(matches!(decode("bomb.obj.gz", bomb), Err(Error::Limits { .. })));
}

#[test]
fn real_meshes_have_their_counts() {
    for (name, faces, with_uvs) in [
        ("meshes/spot.obj", 5_856, true),
        ("meshes/stanford-bunny.obj", 69_451, false),
        ("meshes/dragon_vrip_res3.ply.gz", 47_794, false),
        ("meshes/dragon_vrip.ply.gz", 871_414, false),
        ("gltf/boombox.glb", 18_108 / 3, true),
    ] {
        let Some(path) = shared_file(name) else { return };
        let start = std::time::Instant::now();
        let file = open(&path).unwrap();
        eprintln!("{name}: {:.2} s, {:?}", start.elapsed().as_secs_f64(), file.warnings);
        assert_eq!(file.mesh.triangles().len() + file.mesh.dropped_triangles(), faces, "{name}");
        assert_eq!(!file.mesh.uvs().is_empty(), with_uvs, "{name}");
        check_sound(name, &file.mesh);
    }
}

#[test]
fn draco_is_refused_with_a_remedy() {
    let Some(path) = shared_file("gltf/suzi.glb") else { return };
    let error = open(&path).unwrap_err();
    assert!(
        matches!(&error, Error::Unsupported { what, .. } if what.contains("KHR_draco_mesh_compression")),
        "{error}"
    );
    assert!(error.to_string().contains("without Draco"));
}
