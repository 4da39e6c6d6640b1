//! Untrusted pictures: damaged, forged and odd files must give an error or a sound map, and never a panic.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rilievo::{Convention, Grid, MipChain, Normal, NormalTable, Object, QuantizedMap, Tangent};
use rilievo_io::*;
use testkit::{Random, shared_data, uniform_sphere};

/// What every decoder makes of one file: `Ok` means that it loaded and that what it holds is sound.
struct Outcome {
    height: Result<HeightImage>,
    normals: Result<NormalImage<Tangent>>,
    picture: Result<(u32, u32)>,
    materials: Result<()>,
    indexed: Result<IndexedFile>,
}

fn try_all(source: &Source) -> Outcome {
    let limits = Limits { max_texels: 1 << 24, ..Limits::default() };
    let height = decode_height(source, &limits);
    if let Ok(map) = &height {
        assert!(map.heights.texels().iter().all(|h| h.is_finite()), "{}: a height is not finite", source.name());
    }
    let normals = decode_normals(source, Convention::Gl, &limits);
    if let Ok(map) = &normals {
        let unit = |n: &Normal<Tangent>| (n.vec().length() - 1.0).abs() < 1e-5;
        assert!(map.normals.texels().iter().all(unit), "{}: a normal is not of unit length", source.name());
    }
    let indexed = decode_indexed(source, &ImportAs::default(), &limits);
    if let Ok(file) = &indexed {
        let AnyIndexed::Tangent(map) = &file.map else { panic!("{}: tangent is the default", source.name()) };
        assert!(map.expand().texels().iter().all(|n| (n.vec().length() - 1.0).abs() < 1e-5), "{}", source.name());
    }
    Outcome {
        height,
        normals,
        picture: decode_picture(source, &limits).map(|p| p.size()),
        materials: decode_materials(source, &limits).map(|_| ()),
        indexed,
    }
}

impl Outcome {
    fn any_loaded(&self) -> bool {
        self.height.is_ok()
            || self.normals.is_ok()
            || self.picture.is_ok()
            || self.materials.is_ok()
            || self.indexed.is_ok()
    }
}

fn open(path: &Path) -> Source {
    Source::open(path, &Limits::default()).unwrap()
}

fn files_in(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let all = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let wanted = |p: &PathBuf| p.extension().is_some_and(|e| endings.iter().any(|w| e == *w));
    let mut files: Vec<_> = all.filter(wanted).collect();
    files.sort();
    files
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Expect {
    Load,
    Error,
    Either,
}

#[test]
fn malformed_files_do_what_the_collection_expects() {
    let Some(data) = shared_data() else { return };
    let folder = data.join("malformed");
    let text = std::fs::read_to_string(folder.join("EXPECT.json")).unwrap();
    let stated: BTreeMap<String, serde_json::Value> = serde_json::from_str(&text).unwrap();
    let files = files_in(&folder, &["png", "jpg", "hdr"]);
    assert!(files.len() >= 25, "only {} files", files.len());
    for path in files {
        let name = name_of(&path);
        let words =
            stated.get(&name).unwrap_or_else(|| panic!("{name} has no expectation"))["expect"].as_str().unwrap();
        let expect = match words {
            w if w.contains(" or ") && !w.starts_with("error or limit") => Expect::Either,
            w if w.starts_with("error") || w.starts_with("clear error") => Expect::Error,
            _ => Expect::Load,
        };
        let outcome = try_all(&open(&path));
        let loaded = outcome.any_loaded();
        let right = expect == Expect::Either || loaded == (expect == Expect::Load);
        assert!(right, "{name}: expected {expect:?} ({words}), loaded: {loaded}");
        if name == "good_gray16.png" {
            assert_eq!(outcome.height.unwrap().depth, Depth::U16);
        }
    }
}

#[test]
fn named_malformed_files_say_what_is_wrong() {
    let Some(data) = shared_data() else { return };
    let source = |name: &str| open(&data.join("malformed").join(name));
    let limits = Limits::default();
    for (name, words) in [
        ("zero_bytes.png", "empty"),
        ("not_a_png.png", "GIF"),
        ("truncated_50.png", "cut short"),
        ("bad_idat_crc.png", "IDAT"),
        ("dims_2e31.png", "limit"),
        ("dims_65535_bomb.png", "limit"),
        ("bad_dims.hdr", "Radiance"),
        ("truncated.hdr", "Radiance"),
        ("truncated.jpg", "cut short"),
    ] {
        let message = decode_picture(&source(name), &limits).unwrap_err().to_string();
        assert!(message.contains(words) && message.contains(name), "{message}");
    }
    // With the limit out of the way, the promise of 30 000 rows is still not believed.
    let wide = Limits { max_texels: 1 << 30, ..limits };
    let message = decode_picture(&source("dims_65535_bomb.png"), &wide).unwrap_err().to_string();
    assert!(message.contains("cannot hold"), "{message}");
    let odd = decode_normals::<Tangent>(&source("normalmap_zero_and_backfacing.png"), Convention::Gl, &limits).unwrap();
    assert!(odd.warnings.iter().any(|w| w.contains("unit length")), "{:?}", odd.warnings);
    assert!(odd.warnings.iter().any(|w| w.contains("into the surface")), "{:?}", odd.warnings);
    assert_eq!(decode_height(&source("height_37x1.png"), &limits).unwrap().heights.size(), (37, 1));
}

#[test]
fn pngsuite_loads_what_is_valid_and_refuses_what_is_broken() {
    let Some(data) = shared_data() else { return };
    let files = files_in(&data.join("malformed/pngsuite"), &["png"]);
    assert!(files.len() > 150, "only {} files", files.len());
    for path in files {
        let name = name_of(&path);
        let outcome = try_all(&open(&path));
        if name.starts_with('x') {
            assert!(!outcome.any_loaded(), "{name} is broken, but loads");
            continue;
        }
        let size = outcome.picture.unwrap_or_else(|e| panic!("{e}"));
        assert!(size.0 > 0 && size.1 > 0);
        // Names end in: interlacing, colour type (0 gray, 2 RGB, 3 palette, 4 gray + alpha, 6 RGBA), a letter, depth.
        let b = name.as_bytes();
        if name.len() != "basn0g01.png".len() {
            continue;
        }
        let (gray, sixteen) = (matches!(b[4], b'0' | b'4'), &b[6..8] == b"16");
        if gray {
            let height = outcome.height.unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(height.depth == Depth::U16, sixteen, "{name}");
        } else if let Ok(normals) = &outcome.normals {
            assert_eq!(normals.depth == Depth::U16, sixteen, "{name}");
        }
        assert_eq!(outcome.indexed.is_ok(), b[4] == b'3', "{name}");
    }
}

#[test]
fn interlacing_changes_nothing() {
    let Some(data) = shared_data() else { return };
    let folder = data.join("malformed/pngsuite");
    let limits = Limits::default();
    for kind in ["0g01", "0g02", "0g04", "0g08", "0g16", "2c08", "2c16", "3p01", "3p02", "3p04", "3p08", "4a16", "6a08"]
    {
        let picture = |p: &str| decode_picture(&open(&folder.join(format!("{p}{kind}.png"))), &limits).unwrap();
        assert_eq!(picture("basi"), picture("basn"), "{kind}");
    }
    for side in 1..=9 {
        let bits = if side < 5 { 1 } else { 2 };
        let picture =
            |i: &str| decode_picture(&open(&folder.join(format!("s0{side}{i}3p0{bits}.png"))), &limits).unwrap();
        assert_eq!(picture("i"), picture("n"), "{side}");
        assert_eq!(picture("n").size(), (side, side));
    }
}

fn small_map(entries: usize) -> QuantizedMap<Tangent> {
    let table = NormalTable::new(uniform_sphere(entries, 5)).unwrap();
    let mut random = Random::new(3);
    let base = Grid::from_fn(9, 7, |_, _| (random.bits() % entries as u64) as u16).unwrap();
    QuantizedMap::new(table, MipChain::build(base, |block| *block[0])).unwrap()
}

/// Small valid files of every format that can be written here.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let normals = small_map(40).expand();
    let heights = normals.map(|n| n.vec().z * 0.5 + 0.5);
    let codes = normals.map(|&n| rilievo::normal::encode_u8(n));
    let covered = heights.map(|&h| h > 0.3);
    let picture = codes.map(|&[r, g, b]| rilievo::Rgba8::new(r, g, b, 255));
    let npy = {
        let header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (7, 9, 3), }\n";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header);
        bytes.extend(normals.texels().iter().flat_map(|n| n.vec().to_array()).flat_map(f32::to_le_bytes));
        bytes
    };
    let mut tiff = Vec::new();
    let mut writer = tiff::encoder::TiffEncoder::new(std::io::Cursor::new(&mut tiff)).unwrap();
    writer.write_image::<tiff::encoder::colortype::RGB8>(9, 7, codes.texels().as_flattened()).unwrap();
    let mut jpeg = Vec::new();
    let mut writer = ::image::codecs::jpeg::JpegEncoder::new(&mut jpeg);
    writer.encode(codes.texels().as_flattened(), 9, 7, ::image::ExtendedColorType::Rgb8).unwrap();
    vec![
        ("colors.tiff", tiff),
        ("colors.jpg", jpeg),
        ("palette.png", encode_indexed_png(&small_map(11), Convention::Gl).unwrap()),
        ("bytes.png", encode_indexed_png(&small_map(200), Convention::Dx).unwrap()),
        ("r8.ktx2", encode_ktx2(&small_map(200), Convention::Dx).unwrap()),
        ("r16.ktx2", encode_ktx2(&small_map(300), Convention::Gl).unwrap()),
        ("normals16.png", encode_normals_png16(&normals, Convention::Gl, Some(&covered)).unwrap()),
        ("gray16.png", encode_gray_png16(&heights).unwrap()),
        ("frames.png", encode_apng(&[picture.clone(), picture], 40).unwrap()),
        ("normals.exr", encode_normals_exr(&normals, Convention::Gl, Some(&covered)).unwrap()),
        ("normals.npy", npy),
    ]
}

#[test]
fn no_prefix_of_a_file_is_a_file() {
    for (name, bytes) in samples() {
        assert!(try_all(&Source::from_bytes(name, bytes.clone())).any_loaded(), "{name}");
        for length in 0..bytes.len() {
            let outcome = try_all(&Source::from_bytes(name, bytes[..length].to_vec()));
            assert!(!outcome.any_loaded(), "{name} cut to {length} of {} bytes loads", bytes.len());
        }
    }
}

#[test]
fn flipped_bits_and_bytes_never_panic() {
    let mut random = Random::new(2024);
    for (name, bytes) in samples() {
        for round in 0..2000 {
            let mut damaged = bytes.clone();
            for _ in 0..=random.bits() % 4 {
                let at = (random.bits() % bytes.len() as u64) as usize;
                damaged[at] =
                    if round % 2 == 0 { damaged[at] ^ (1 << (random.bits() % 8)) } else { random.bits() as u8 };
            }
            if round % 3 == 0 {
                mend_checksums(&mut damaged);
            }
            // The space may be what flipped, so only the other decoders' promises hold here.
            let source = Source::from_bytes(name, damaged);
            let limits = Limits { max_texels: 1 << 20, ..Limits::default() };
            let _ = decode_indexed(&source, &ImportAs::default(), &limits);
            let _ = decode_picture(&source, &limits);
            let _ = decode_materials(&source, &limits);
            if let Ok(map) = decode_height(&source, &limits) {
                assert!(map.heights.texels().iter().all(|h| h.is_finite()));
            }
            if let Ok(map) = decode_normals::<Object>(&source, Convention::Dx, &limits) {
                assert!(map.normals.texels().iter().all(|n| (n.vec().length() - 1.0).abs() < 1e-5));
            }
        }
    }
}

/// Makes the checksums of a damaged PNG right again, so that the damage reaches what lies behind them.
fn mend_checksums(bytes: &mut [u8]) {
    let mut at = 8;
    while bytes.starts_with(b"\x89PNG") && at + 12 <= bytes.len() {
        let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let Some(end) = at.checked_add(8 + length).filter(|&e| e + 4 <= bytes.len()) else { return };
        let crc = crc32fast::hash(&bytes[at + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&crc);
        at = end + 4;
    }
}
