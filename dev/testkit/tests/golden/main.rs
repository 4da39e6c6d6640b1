//! Golden pictures: scenes of the whole pipeline against pictures that were looked at.
//!
//! `cargo xtask bless` takes today's as the golden ones; look at each before it is committed.
#![expect(clippy::unwrap_used, reason = "scenes fail loudly")]

mod relief;
mod scenes;
mod store;

use testkit::golden::Tolerance;

/// Rendered pictures. Shapes and shades go through the platform's libm (`sin`, `powf`), which may differ in the last
/// bit: that moves a channel by 1, and hardly ever a silhouette by a sub-pixel (scenes average 2 × 2 samples, so then
/// by a quarter of the contrast).
const RENDERED: Tolerance = Tolerance { per_channel: 2, share_over: 0.001, hard_cap: 48 };
/// Maps, tables and indices are made with IEEE arithmetic in a fixed order: the same bits everywhere.
const DATA: Tolerance = Tolerance::EXACT;

/// One test per golden file, named as the file, and the list of the names.
macro_rules! goldens {
    ($($name:ident: $check:expr;)*) => {
        const NAMES: &[&str] = &[$(stringify!($name)),*];
        $(#[test] fn $name() { $check(stringify!($name)); })*
    };
}

goldens! {
    smooth_sphere: |name| store::check_picture(name, &scenes::smooth_sphere(), RENDERED);
    torus_exact: |name| store::check_picture(name, &scenes::torus(scenes::Shading::Exact), RENDERED);
    torus_table: |name| store::check_picture(name, &scenes::torus(scenes::Shading::Table), RENDERED);
    vase_table: |name| store::check_picture(name, &scenes::vase(), RENDERED);
    normals_wrap_and_clamp: |name| store::check_picture(name, &scenes::normals_wrap_and_clamp(), DATA);
    flat_map: |name| store::check_map(name, &scenes::flat_map());
    flat_relit: |name| store::check_picture(name, &scenes::flat_relit(), RENDERED);
    cube_map: |name| store::check_map(name, &scenes::cube_map());
    cube_table: |name| store::check_picture(name, &scenes::cube(), RENDERED);
    mirrored_tangent: |name| store::check_picture(name, &scenes::mirrored_tangent(), RENDERED);
    grazing_trilinear: |name| store::check_picture(name, &scenes::grazing_trilinear(), RENDERED);
}

/// A golden file that no scene makes any more would look like one that is checked.
#[test]
fn every_golden_file_is_used() {
    let unused: Vec<String> = store::files().into_iter().filter(|f| !NAMES.contains(&f.as_str())).collect();
    assert!(unused.is_empty(), "no scene makes {unused:?}; delete these files from {}", store::folder().display());
}
