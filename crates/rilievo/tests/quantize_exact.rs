//! What quantising promises on every map: exact nearest entries, materials that stay, the same bits always.

use proptest::prelude::*;
use rilievo::normal::{decode_u16, encode_u16};
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, Quantized, quantize};
use rilievo::{Error, Grid, MaterialMap, Normal, NormalMap, Object};
use testkit::Random;

fn normal(v: [f64; 3]) -> Normal<Object> {
    Normal::new_or(glam::DVec3::from_array(v).as_vec3(), Normal::Z)
}

fn run(map: &NormalMap<Object>, options: &Options<'_>) -> Quantized<Object> {
    quantize(map, options, &Silent).expect("valid options")
}

fn with(entries: u32) -> Options<'static> {
    Options { entries, ..Options::default() }
}

/// A map of several kinds of difficulty: all over the sphere, tiny clusters, antipodes, few values, lines.
fn hard_map(width: u32, height: u32, kind: u32, seed: u64) -> NormalMap<Object> {
    let mut random = Random::new(seed);
    let center = [random.range(-1.0, 1.0), random.range(-1.0, 1.0), random.range(-1.0, 1.0)];
    let mut around =
        |size: f64, sign: f64| normal([0, 1, 2].map(|k| sign * center[k] + size * random.range(-1.0, 1.0)));
    let texel = |x: u32, y: u32| {
        let i = x + y * width;
        match kind {
            0 => around(1.0, 0.0),
            1 => around(1e-5, if i.is_multiple_of(2) { 1.0 } else { -1.0 }),
            2 => around([1.0, 1e-2, 1e-4, 3e-7][i as usize % 4], 1.0),
            3 => decode_u16(encode_u16(around(0.3, 1.0)).map(|c| c & 0xf000)),
            4 => normal([0.0, 0.0, if i.is_multiple_of(3) { -1.0 } else { 1.0 }]),
            _ => normal([1e-30 * f64::from(i), f64::from(x) * 1e-3, 1.0]),
        }
    };
    Grid::from_fn(width, height, texel).expect("a valid size")
}

/// The definition, in f64: the first of the entries `allowed` at the least distance.
fn oracle(table: &[Normal<Object>], allowed: std::ops::Range<usize>, n: Normal<Object>) -> usize {
    let distance = |e: usize| {
        let [x, y, z] = (n.vec().as_dvec3() - table[e].vec().as_dvec3()).to_array();
        x * x + y * y + z * z
    };
    allowed.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).expect("a table is never empty")
}

fn span_of(quantized: &Quantized<Object>, material: u8) -> Option<std::ops::Range<usize>> {
    let span = quantized.map.table().spans().iter().find(|s| s.material == material)?;
    Some(span.entries.start as usize..span.entries.end as usize)
}

fn check(
    map: &NormalMap<Object>,
    materials: &MaterialMap,
    covered: Option<&Grid<bool>>,
    quantized: &Quantized<Object>,
) {
    let table = quantized.map.table().normals();
    for n in table {
        assert!((n.vec().length() - 1.0).abs() < 1e-6);
        assert_eq!(decode_u16::<Object>(encode_u16(*n)), *n, "files must agree with memory");
    }
    for (texel, (&n, &index)) in map.texels().iter().zip(quantized.map.base().texels()).enumerate() {
        let span = span_of(quantized, materials.texels()[texel]);
        assert!(span.is_some() || covered.is_some_and(|c| !c.texels()[texel]));
        let expected = oracle(table, span.unwrap_or(0..table.len()), n);
        assert_eq!(usize::from(index), expected, "texel {texel}, {n:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn every_texel_has_its_nearest_entry(
        (width, height) in (1u32..60, 1u32..40), kind in 0u32..6, seed: u64, entries in 8u32..400,
        materials in 1u64..6, gutter: bool, effort in 0usize..3,
    ) {
        let map = hard_map(width, height, kind, seed);
        let mut random = Random::new(seed ^ 1);
        let materials = Grid::from_fn(width, height, |_, _| (random.bits() % materials * 50) as u8).unwrap();
        let mut covered = Grid::from_fn(width, height, |_, _| !random.bits().is_multiple_of(3)).unwrap();
        covered[(width / 2, height / 2)] = true;
        let covered = gutter.then_some(&covered);
        let effort = [Effort::Fast, Effort::Normal, Effort::Best][effort];
        let options = Options { effort, materials: Some(&materials), covered, mip_levels: true, ..with(entries) };
        let quantized = run(&map, &options);
        check(&map, &materials, covered, &quantized);
        prop_assert_eq!(quantized.map.table().len(), quantized.distinct.min(entries as usize));

        // Once more: what has at most `entries` values already keeps them exactly, and the table keeps its order.
        let reduced = quantized.map.expand();
        let again = run(&reduced, &Options { covered: None, ..options });
        let gutter_adds_pairs = again.distinct > entries as usize;
        prop_assert!(gutter_adds_pairs || again.map.expand() == reduced);
    }
}

#[test]
fn more_entries_than_normals_gives_just_the_normals() {
    for kind in 0..6 {
        let map = hard_map(23, 17, kind, 5);
        let quantized = run(&map, &with(65_536));
        let mut bits: Vec<_> = map.texels().iter().map(|n| n.vec().to_array().map(|c| (c + 0.0).to_bits())).collect();
        bits.sort_unstable();
        bits.dedup();
        assert_eq!((quantized.distinct, quantized.map.table().len()), (bits.len(), bits.len()));
        for (a, b) in map.texels().iter().zip(quantized.map.expand().texels()) {
            assert!(a.angle_to(*b).to_degrees() < 0.005, "only the rounding to 16 bits");
        }
    }
}

#[test]
fn smallest_maps_and_tables_work() {
    let single = Grid::filled(1, 1, Normal::<Object>::X).unwrap();
    let quantized = run(&single, &Options { mip_levels: true, ..with(2) });
    assert_eq!((quantized.map.table().len(), quantized.map.indices().levels().len()), (1, 1));
    let opposite = Grid::new(2, 1, vec![normal([0.0, 0.0, 1.0]), normal([0.0, 0.0, -1.0])]).unwrap();
    assert_eq!(run(&opposite, &Options { mip_levels: true, ..with(1) }).map.table().len(), 1);
    let both = run(&opposite, &with(2)).map.expand();
    assert!(both.texels().iter().zip(opposite.texels()).all(|(a, b)| a.angle_to(*b) < 1e-4));
}

#[test]
fn bad_options_are_refused_with_both_numbers() {
    let map = hard_map(4, 4, 0, 1);
    let refused = |options: &Options<'_>| quantize(&map, options, &Silent).unwrap_err();
    assert!(matches!(refused(&with(0)), Error::Parameter { name: "entries", .. }));
    assert!(matches!(refused(&with(65_537)), Error::Parameter { name: "entries", .. }));
    let materials = Grid::from_fn(4, 4, |x, y| (x + 4 * y) as u8).unwrap();
    let message = refused(&Options { materials: Some(&materials), ..with(15) }).to_string();
    assert!(message.contains("15") && message.contains("16"), "{message}");
    let small = Grid::filled(3, 4, true).unwrap();
    assert!(matches!(refused(&Options { covered: Some(&small), ..with(4) }), Error::SizeMismatch { .. }));
    let none = Grid::filled(4, 4, false).unwrap();
    assert!(matches!(refused(&Options { covered: Some(&none), ..with(4) }), Error::Missing { .. }));
}

#[test]
fn gutter_does_not_shape_the_table() {
    let mut map = hard_map(40, 40, 2, 3);
    let covered = Grid::from_fn(40, 40, |x, _| x < 20).unwrap();
    let options = Options { covered: Some(&covered), ..with(32) };
    let table = run(&map, &options).map.table().clone();
    for y in 0..40 {
        for x in 20..40 {
            map[(x, y)] = Normal::Y;
        }
    }
    assert_eq!(*run(&map, &options).map.table(), table);
}

#[test]
fn entries_go_to_the_material_that_varies() {
    // Material 4 is flat, material 9 is rough: sharing by need gives nearly all entries to the rough one.
    let rough = hard_map(64, 64, 0, 8);
    let map = Grid::from_fn(64, 64, |x, y| if x < 32 { Normal::Z } else { rough[(x, y)] }).unwrap();
    let materials = Grid::from_fn(64, 64, |x, _| if x < 32 { 4 } else { 9 }).unwrap();
    let quantized = run(&map, &Options { materials: Some(&materials), ..with(100) });
    assert_eq!(span_of(&quantized, 4).unwrap().len(), 1);
    assert_eq!(span_of(&quantized, 9).unwrap().len(), 99);
    assert_eq!(quantized.map.expand_materials(), materials);
}

/// Each mip texel has the entry nearest to the f64 mean of the level-0 normals of the material that wins the vote.
#[test]
fn mip_levels_have_the_nearest_entry_to_the_mean() {
    for (width, height) in [(16, 16), (13, 7), (1, 9)] {
        let map = hard_map(width, height, 2, 11);
        let quantized = run(&map, &Options { mip_levels: true, ..with(40) });
        let table = quantized.map.table().normals();
        let sums = Grid::from_fn(width, height, |x, y| map[(x, y)].vec().as_dvec3()).unwrap();
        let means = rilievo::MipChain::build(sums, |block| block.iter().copied().sum());
        let levels = quantized.map.indices().levels();
        assert_eq!(levels.len(), means.levels().len());
        for (level, sums) in levels.iter().zip(means.levels()).skip(1) {
            for (&index, sum) in level.texels().iter().zip(sums.texels()) {
                let mean = sum.normalize();
                let angle = |e: &Normal<Object>| (e.vec().as_dvec3() - mean).length();
                let best = table.iter().map(angle).min_by(f64::total_cmp).unwrap();
                assert!(angle(&table[usize::from(index)]) <= best + 1e-6);
            }
        }
    }
}

#[test]
fn mip_materials_are_voted_for() {
    let map = hard_map(4, 2, 0, 2);
    let materials = Grid::new(4, 2, vec![7, 7, 3, 7, 7, 3, 7, 3]).unwrap();
    let quantized = run(&map, &Options { materials: Some(&materials), mip_levels: true, ..with(8) });
    let found = quantized.map.indices().level(1).map(|&i| quantized.map.table().material_of(i));
    assert_eq!(found.texels(), [7, 3], "the majority, and of equals the lowest");
}

/// The same bits from any number of threads. The digest also holds the build without `rayon` to the same bits.
#[test]
fn results_are_the_same_bits_everywhere() {
    // Made without sine and cosine, so that the digest is the same on every platform.
    let map = hard_map(300, 200, 0, 9);
    let materials = Grid::from_fn(300, 200, |x, y| (x / 90 + y / 150) as u8).unwrap();
    let digest = || {
        let options = Options { materials: Some(&materials), mip_levels: true, ..with(300) };
        let quantized = run(&map, &options);
        let table = quantized.map.table().normals().iter().flat_map(|&n| encode_u16(n));
        let indices = quantized.map.indices().levels().iter().flat_map(|l| l.texels().iter().copied());
        // FNV-1a.
        table.chain(indices).fold(0xcbf2_9ce4_8422_2325u64, |h, v| (h ^ u64::from(v)).wrapping_mul(0x100_0000_01b3))
    };
    let expected = DIGEST;
    assert_eq!(digest(), expected);
    #[cfg(feature = "rayon")]
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(digest), expected, "{threads} threads");
    }
}

/// Changes whenever the algorithm does; then copy the new value from the failing test, after looking at the errors
/// `quantize_quality.rs` prints.
const DIGEST: u64 = 2_096_909_968_394_062_122;

#[test]
fn colours_and_their_normals_give_the_same() {
    let mut random = Random::new(5);
    let mut color = || [0, 1, 2].map(|k| (random.range(0.0, 40.0) as u8) * if k == 2 { 6 } else { 3 });
    let codes = Grid::from_fn(90, 70, |_, _| color()).unwrap();
    let map = codes.map(|&c| rilievo::normal::decode_u8::<Object>(c));
    let materials = Grid::from_fn(90, 70, |x, _| (x / 30) as u8).unwrap();
    let covered = Grid::from_fn(90, 70, |x, y| (x + y) % 9 != 0).unwrap();
    for (materials, covered) in [(None, None), (None, Some(&covered)), (Some(&materials), Some(&covered))] {
        for entries in [40, 65_536] {
            let options = Options { entries, materials, covered, mip_levels: true, ..Options::default() };
            let (a, b) = (run(&map, &options), quantize::<Object>(&codes, &options, &Silent).unwrap());
            assert_eq!((a.map, a.distinct, a.error), (b.map, b.distinct, b.error));
        }
    }
}
