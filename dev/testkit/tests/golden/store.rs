//! Golden files: reading, blessing, and what is left behind when a picture differs.

use std::path::{Path, PathBuf};

use rilievo::color::Picture;
use rilievo::{Convention, QuantizedMap, Rgba8, Space};
use rilievo_io::{
    AnyIndexed, ImportAs, Limits, Source, decode_indexed, decode_picture, encode_indexed_png, encode_picture_png,
    write_atomic,
};
use testkit::golden::{Difference, Tolerance, side_by_side};

/// Small files: a golden picture is there to be looked at and to be kept for ever.
const MOST_BYTES: usize = 20 * 1024;

/// Where the golden files are.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

/// The names of all golden files, without `.png`; other files keep their ending, so that they are found unused.
/// (Not hidden ones: those that are being written beside this.)
pub(crate) fn files() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let name = |e: std::io::Result<std::fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
    let visible = entries.map(name).filter(|n| !n.starts_with('.'));
    visible.map(|n| n.strip_suffix(".png").unwrap_or(&n).to_owned()).collect()
}

/// Fails unless `actual` is within `tolerance` of the golden picture `name`.
pub(crate) fn check_picture(name: &str, actual: &Picture, tolerance: Tolerance) {
    let expected = open(name).map(|source| decode_picture(&source, &Limits::default()).unwrap());
    let difference = expected.as_ref().and_then(|e| Difference::between(e, actual, &tolerance));
    if bless(name, expected.as_ref() == Some(actual), || encode_picture_png(actual).unwrap()) {
        return;
    }
    if !difference.is_some_and(|d| d.is_within(&tolerance)) {
        fail(name, expected.as_ref(), actual, difference, &tolerance);
    }
}

/// Fails unless the table and every index of `actual` are those of the golden indexed PNG `name`.
pub(crate) fn check_map<S: Space>(name: &str, actual: &QuantizedMap<S>) {
    let bytes = encode_indexed_png(actual, Convention::Gl).unwrap();
    // As it comes back from a file, so that both sides are of one type; a round trip loses nothing (`rilievo-io`).
    let actual = decode_map(&Source::from_bytes(name, bytes.clone()));
    let expected = open(name).map(|source| decode_map(&source));
    if bless(name, expected.as_ref() == Some(&actual), || bytes.clone()) || expected.as_ref() == Some(&actual) {
        return;
    }
    let shown = |source: &Source| decode_picture(source, &Limits::default()).unwrap();
    let expected = open(name).map(|s| shown(&s));
    let actual = shown(&Source::from_bytes(name, bytes));
    let difference = expected.as_ref().and_then(|e| Difference::between(e, &actual, &Tolerance::EXACT));
    fail(name, expected.as_ref(), &actual, difference, &Tolerance::EXACT);
}

fn decode_map(source: &Source) -> AnyIndexed {
    let file = decode_indexed(source, &ImportAs::default(), &Limits::default()).unwrap();
    assert_eq!(file.warnings, Vec::<String>::new(), "{}", source.name());
    file.map
}

fn path(name: &str) -> PathBuf {
    folder().join(name).with_extension("png")
}

fn open(name: &str) -> Option<Source> {
    path(name).exists().then(|| Source::open(&path(name), &Limits::default()).unwrap())
}

/// Writes the golden file if that was asked for and it is not `same` already; says whether it was asked for.
fn bless(name: &str, same: bool, encode: impl FnOnce() -> Vec<u8>) -> bool {
    if std::env::var("RILIEVO_BLESS").as_deref() != Ok("1") {
        return false;
    }
    if !same {
        let bytes = encode();
        assert!(bytes.len() <= MOST_BYTES, "{name}: {} bytes; make the picture smaller", bytes.len());
        write_atomic(&path(name), &bytes).unwrap();
    }
    true
}

/// Leaves expected | difference | actual, today's picture and the numbers in a folder, and fails with their names.
fn fail(
    name: &str,
    expected: Option<&Picture>,
    actual: &Picture,
    difference: Option<Difference>,
    tolerance: &Tolerance,
) -> ! {
    let left = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    std::fs::create_dir_all(&left).unwrap();
    let sheet = left.join(format!("{name}.png"));
    write_atomic(&sheet, &encode_picture_png(&side_by_side(expected, actual)).unwrap()).unwrap();
    let size = |p: &rilievo::Grid<Rgba8>| [p.width(), p.height()];
    let numbers = serde_json::json!({
        "name": name,
        "expected_size": expected.map(size),
        "actual_size": size(actual),
        "largest": difference.map(|d| d.largest),
        "pixels_over": difference.map(|d| d.pixels_over),
        "pixels": actual.texels().len(),
        "tolerance": {
            "per_channel": tolerance.per_channel,
            "share_over": tolerance.share_over,
            "hard_cap": tolerance.hard_cap,
        },
    });
    write_atomic(&left.join(format!("{name}.json")), format!("{numbers:#}\n").as_bytes()).unwrap();
    let what = match (expected, difference) {
        (None, _) => "has no golden file (`cargo xtask bless` writes one)".to_owned(),
        (Some(_), None) => "has another size than its golden picture".to_owned(),
        // Entries of a table are finer than the picture of its palette.
        (_, Some(d)) if d.largest == 0 => "differs from its golden map in what 8 bits do not show".to_owned(),
        (_, Some(d)) => {
            format!(
                "differs by {} at most, and in {} of {} pixels over the tolerance",
                d.largest, d.pixels_over, d.pixels
            )
        }
    };
    panic!("{name} {what}; expected | difference | actual: {}", sheet.display());
}
