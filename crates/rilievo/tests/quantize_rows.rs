//! Maps that pass by in rows come out like maps in memory.

use rilievo::normal::{decode_u16, encode_u8, encode_u16};
use rilievo::progress::Silent;
use rilievo::quantize::{Band, BandTexels, Dither, Options, Quantized, RowSource, Visit, quantize, quantize_rows};
use rilievo::{Error, Grid, MaterialMap, Normal, NormalMap, Object};
use testkit::Random;

/// A map in memory, shown in bands of uneven heights.
#[derive(Clone, Copy)]
struct Bands<'a> {
    colors: Option<&'a Grid<[u8; 3]>>,
    normals: &'a NormalMap<Object>,
    covered: Option<&'a Grid<bool>>,
    materials: Option<&'a MaterialMap>,
    /// Shows so many texels too few.
    missing: usize,
}

impl RowSource<Object> for Bands<'_> {
    type Error = Error;

    fn size(&self) -> (u32, u32) {
        self.normals.size()
    }

    fn rows(&mut self, visit: &mut Visit<'_, Object, Error>) -> Result<(), Error> {
        let (width, end) = (self.normals.width() as usize, self.normals.texels().len() - self.missing);
        let (mut first, mut rows) = (0, 1);
        while first < end {
            let part = first..end.min(first + rows * width);
            let texels = match self.colors {
                Some(colors) => BandTexels::Rgb8(&colors.texels()[part.clone()]),
                None => BandTexels::Normals(&self.normals.texels()[part.clone()]),
            };
            let covered = self.covered.map(|c| &c.texels()[part.clone()]);
            visit(Band { texels, covered, materials: self.materials.map(|m| &m.texels()[part.clone()]) })?;
            (first, rows) = (part.end, rows % 5 + 1);
        }
        Ok(())
    }
}

/// Waves with some noise.
fn waves(width: u32, height: u32, seed: u64) -> NormalMap<Object> {
    let mut random = Random::new(seed);
    Grid::from_fn(width, height, |x, y| {
        let (u, v) = (f64::from(x) * 0.11, f64::from(y) * 0.07);
        let noise = 0.05 * random.range(-1.0, 1.0);
        let v = [u.sin() + noise, (u * 0.3 + v).cos(), 0.8 + v.sin()];
        Normal::new_or(glam::DVec3::from_array(v).as_vec3(), Normal::Z)
    })
    .expect("a valid size")
}

fn expect_same(a: &Quantized<Object>, b: &Quantized<Object>) {
    assert_eq!(a.map, b.map);
    assert_eq!((a.distinct, a.zador_rms_rad), (b.distinct, b.zador_rms_rad));
    // Sums may be in another order.
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b;
    for (a, b) in [(&a.error, &b.error)].into_iter().chain(a.level_errors.iter().zip(&b.level_errors)) {
        assert!(close(a.rms_rad, b.rms_rad) && close(a.mean_rad, b.mean_rad), "{a:?} {b:?}");
        assert_eq!((a.p99_rad, a.max_rad, a.count), (b.p99_rad, b.max_rad, b.count));
    }
    assert_eq!(a.level_errors.len(), b.level_errors.len());
}

#[test]
fn colours_in_rows_give_the_same_bits_as_in_memory() {
    for (width, height) in [(1, 1), (37, 90), (200, 131)] {
        let colors = waves(width, height, 7).map(|&n| encode_u8(n));
        let normals = colors.map(|&c| rilievo::normal::decode_u8(c));
        let holes = Grid::from_fn(width, height, |x, y| (x / 9 + y / 7) % 5 > 0 || x == 0).expect("a valid size");
        for covered in [None, Some(&holes)] {
            for dither in [Dither::None, Dither::Diffusion, Dither::BlueNoise] {
                for (entries, mip_levels) in [(60, true), (1000, false), (65_536, true)] {
                    let options = Options { entries, mip_levels, dither, ..Options::default() };
                    let whole = quantize(&colors, &Options { covered, ..options }, &Silent).unwrap();
                    let mut bands =
                        Bands { colors: Some(&colors), normals: &normals, covered, materials: None, missing: 0 };
                    expect_same(&quantize_rows(&mut bands, &options, &Silent).unwrap(), &whole);
                }
            }
        }
    }
}

#[test]
fn normals_and_materials_in_rows_are_as_good_as_in_memory() {
    let (width, height) = (300, 200);
    let normals = waves(width, height, 3).map(|&n| decode_u16(encode_u16(n)));
    let colors = normals.map(|&n| encode_u8(n));
    let decoded = colors.map(|&c| rilievo::normal::decode_u8(c));
    let materials = Grid::from_fn(width, height, |x, y| ((x / 40 + y / 30) % 3 * 5) as u8).expect("a valid size");
    let holes = Grid::from_fn(width, height, |x, y| (x / 9 + y / 7) % 5 > 0).expect("a valid size");
    for (colors, normals) in [(None, &normals), (Some(&colors), &decoded)] {
        for (materials, covered) in [(None, Some(&holes)), (Some(&materials), None), (Some(&materials), Some(&holes))] {
            let options = Options { entries: 300, mip_levels: true, ..Options::default() };
            let whole = quantize(normals, &Options { materials, covered, ..options }, &Silent).unwrap();
            let found =
                quantize_rows(&mut Bands { colors, normals, covered, materials, missing: 0 }, &options, &Silent)
                    .unwrap();
            let ratio = found.error.rms_rad / whole.error.rms_rad;
            assert!((0.99..1.01).contains(&ratio), "{ratio}");
            assert_eq!(found.error.count, whole.error.count);
            assert_eq!(found.level_errors.len(), whole.level_errors.len());
            // Entries are the nearest of their material, and the error is what it is said to be.
            let table = found.map.table();
            let mut squares = 0.0;
            for (i, (n, &entry)) in normals.texels().iter().zip(found.map.base().texels()).enumerate() {
                if covered.is_some_and(|c| !c.texels()[i]) {
                    continue;
                }
                assert!(materials.is_none_or(|m| m.texels()[i] == table.material_of(entry)));
                let squared = |e: usize| (n.vec().as_dvec3() - table.normals()[e].vec().as_dvec3()).length_squared();
                let own = squared(usize::from(entry));
                if i % 97 == 0 {
                    let span = table.spans().iter().find(|s| s.entries.contains(&u32::from(entry))).unwrap();
                    assert!(span.entries.clone().all(|e| squared(e as usize) >= own));
                }
                squares += (2.0 * (own.sqrt() / 2.0).asin()).powi(2);
            }
            let rms = (squares / found.error.count as f64).sqrt();
            assert!((rms / found.error.rms_rad - 1.0).abs() < 1e-6, "{rms} {}", found.error.rms_rad);
        }
    }
}

#[test]
fn few_distinct_normals_are_kept_and_bad_rows_are_refused() {
    let normals = Grid::from_fn(64, 64, |x, y| waves(8, 1, 1)[((x + y) % 8, 0)]).expect("a valid size");
    let options = Options { entries: 100, ..Options::default() };
    let bands = Bands { colors: None, normals: &normals, covered: None, materials: None, missing: 0 };
    let found = quantize_rows(&mut bands.clone(), &options, &Silent).unwrap();
    assert_eq!((found.distinct, found.map.table().len()), (8, 8));
    assert!(found.error.max_rad < 1e-4);

    for missing in [1, 64] {
        let error = quantize_rows(&mut Bands { missing, ..bands }, &options, &Silent).unwrap_err();
        assert!(matches!(error, Error::Length { expected: 4096, .. }), "{error}");
    }
    let nowhere = Grid::filled(64, 64, false).expect("a valid size");
    let error = quantize_rows(&mut Bands { covered: Some(&nowhere), ..bands }, &options, &Silent).unwrap_err();
    assert!(matches!(error, Error::Missing { .. }), "{error}");
    let given = Options { covered: Some(&nowhere), ..options };
    assert!(matches!(quantize_rows(&mut bands.clone(), &given, &Silent), Err(Error::Parameter { .. })));
}
