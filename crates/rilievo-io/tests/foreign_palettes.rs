//! Palette PNGs of other programs are read as quantised normal maps.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "test helpers fail loudly")]

use std::path::Path;
use std::process::{Command, Stdio};

use rilievo::normal::encode_u8;
use rilievo::{Convention, Grid, Normal, NormalMap, Tangent};
use rilievo_io::*;

/// Runs a program on a file and returns what it prints; `None` if it is not installed, after saying so.
///
/// With `CI=true` nothing may be skipped.
fn run(program: &str, arguments: &[&str], input: &Path) -> Option<Vec<u8>> {
    let stdin = std::fs::File::open(input).unwrap();
    let child = Command::new(program).args(arguments).stdin(stdin).stderr(Stdio::null()).output();
    let Ok(output) = child else {
        assert!(
            std::env::var("CI").as_deref() != Ok("true"),
            "{program} is not installed; with CI=true nothing is skipped"
        );
        eprintln!("SKIPPED: {program} is not installed");
        return None;
    };
    assert!(output.status.success(), "{program} fails: {}", output.status);
    Some(output.stdout)
}

/// A dome: every direction of a hemisphere up to 60° of tilt.
fn dome() -> NormalMap<Tangent> {
    let normal = |x: u32, y: u32| {
        let slope = |i: u32| (i as f32 + 0.5) / 32.0 - 1.0;
        Normal::new_or(glam::Vec3::new(slope(x), -slope(y), 1.0), Normal::Z)
    };
    Grid::from_fn(64, 64, normal).unwrap()
}

fn check_import(program: &str, bytes: Vec<u8>, most_deg: f64) {
    let source = Source::from_bytes(format!("{program}.png"), bytes);
    let file = decode_indexed(&source, &ImportAs::default(), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((file.convention, file.map.size(), file.warnings.len()), (Convention::Gl, (64, 64), 0), "{program}");
    let AnyIndexed::Tangent(map) = file.map else { panic!("tangent is the default") };
    assert!((200..=256).contains(&map.table().len()), "{program}: {} entries", map.table().len());
    let (original, read) = (dome(), map.expand());
    let pairs = original.texels().iter().zip(read.texels());
    let squares: f64 = pairs.map(|(a, &b)| a.angle_to(b).to_degrees().powi(2)).sum();
    let rms = (squares / 4096.0).sqrt();
    assert!(rms < most_deg, "{program}: {rms}° RMS");

    // The same file said to be dx is the same map upside down.
    let as_dx = ImportAs { space: Some(SpaceKind::Object), convention: Some(Convention::Dx) };
    let AnyIndexed::Object(flipped) = decode_indexed(&source, &as_dx, &Limits::default()).unwrap().map else {
        panic!("object was asked for")
    };
    assert_eq!(flipped.table().normals()[9].vec().y, -map.table().normals()[9].vec().y);
}

fn write_dome(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("dome.png");
    write_atomic(&path, &encode_normals_png8(&dome().map(|&n| encode_u8(n)), None).unwrap()).unwrap();
    path
}

#[test]
fn pngquant_palettes_are_imported() {
    let folder = tempfile::tempdir().unwrap();
    let Some(bytes) = run("pngquant", &["256", "--nofs", "-"], &write_dome(folder.path())) else { return };
    check_import("pngquant", bytes, 4.0);
}

#[test]
fn netpbm_palettes_are_imported() {
    let folder = tempfile::tempdir().unwrap();
    let Some(pixels) = run("pngtopnm", &[], &write_dome(folder.path())) else { return };
    let (plain, quantised) = (folder.path().join("dome.ppm"), folder.path().join("few.ppm"));
    std::fs::write(&plain, pixels).unwrap();
    let Some(few) = run("pnmquant", &["256"], &plain) else { return };
    std::fs::write(&quantised, few).unwrap();
    let Some(bytes) = run("pnmtopng", &[], &quantised) else { return };
    check_import("netpbm", bytes, 6.0);
}
