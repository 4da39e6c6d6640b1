//! What dithering is for: normals averaged over a few texels come out right; and what it must leave alone.

use std::f32::consts::{PI, TAU};
use std::fs::File;
use std::io::BufReader;

use glam::{DVec3, Vec3};
use rilievo::measure::angle_stats;
use rilievo::normal::decode_u8;
use rilievo::progress::Silent;
use rilievo::quantize::{Dither, Options, Quantized, quantize};
use rilievo::{Edges, Grid, MaterialMap, Normal, NormalMap, Object};

const METHODS: [Dither; 2] = [Dither::Diffusion, Dither::BlueNoise];

fn with(entries: u32, dither: Dither) -> Options<'static> {
    Options { entries, dither, ..Options::default() }
}

fn run(map: &NormalMap<Object>, options: &Options<'_>) -> Quantized<Object> {
    quantize(map, options, &Silent).expect("valid options")
}

fn normal(v: [f32; 3]) -> Normal<Object> {
    Normal::new(Vec3::from_array(v)).expect("valid by construction")
}

/// Smooth hills: every direction of a wide cap, changing slowly.
fn hills(width: u32, height: u32) -> NormalMap<Object> {
    let slope = |t: u32, period: f32| (t as f32 / period).sin();
    Grid::from_fn(width, height, |x, y| {
        normal([slope(x + 3 * y, 97.0), slope(2 * y, 71.0) + 0.3 * slope(x, 31.0), 1.0])
    })
    .expect("valid by construction")
}

/// A ball unrolled: every direction there is, changing slowly.
fn ball(width: u32, height: u32) -> NormalMap<Object> {
    Grid::from_fn(width, height, |x, y| {
        let (longitude, latitude) = ((x as f32 / width as f32 - 0.5) * TAU, (y as f32 / height as f32 - 0.5) * PI);
        let v = Vec3::new(longitude.cos() * latitude.cos(), longitude.sin() * latitude.cos(), latitude.sin());
        // Turned, so that no row or column goes along a great circle of the axes.
        normal(
            Vec3::new(
                v.dot(Vec3::new(0.36, 0.48, -0.8)),
                v.dot(Vec3::new(-0.8, 0.6, 0.0)),
                v.dot(Vec3::new(0.48, 0.64, 0.6)),
            )
            .to_array(),
        )
    })
    .expect("valid by construction")
}

/// Normals averaged with a Gaussian of σ = 1 texel, cut at 3, the border going on; made unit length again.
fn low_pass(map: &NormalMap<Object>) -> Grid<DVec3> {
    let weights: Vec<f64> = (-3..=3).map(|i| (-f64::from(i * i) / 2.0).exp()).collect();
    let (w, h) = map.size();
    let line = |f: &dyn Fn(i64) -> DVec3| (-3..=3).zip(&weights).map(|(i, w)| f(i) * *w).sum::<DVec3>();
    let near = |c: u32, i: i64, size| Edges::Clamp.resolve(i64::from(c) + i, size);
    let rows =
        Grid::from_fn(w, h, |x, y| line(&|i| map[(near(x, i, w), y)].vec().as_dvec3())).expect("valid by construction");
    Grid::from_fn(w, h, |x, y| line(&|i| rows[(x, near(y, i, h))]).normalize()).expect("valid by construction")
}

fn rms_deg(a: &Grid<DVec3>, b: &Grid<DVec3>) -> f64 {
    let square = |(a, b): (&DVec3, &DVec3)| (2.0 * ((*a - *b).length() / 2.0).asin()).powi(2);
    let sum = a.texels().iter().zip(b.texels()).map(square).sum::<f64>();
    (sum / a.texels().len() as f64).sqrt().to_degrees()
}

/// RMS errors after the low-pass with diffusion and with blue noise, as shares of those without dithering.
#[expect(clippy::print_stdout, reason = "shows the figures that are measured here")]
fn shares(map: &NormalMap<Object>, entries: u32) -> [f64; 2] {
    let meant = low_pass(map);
    let [none, diffusion, blue_noise] = [Dither::None, Dither::Diffusion, Dither::BlueNoise].map(|dither| {
        let quantized = run(map, &with(entries, dither));
        let low = rms_deg(&meant, &low_pass(&quantized.map.expand()));
        let single = quantized.error.rms_rad.to_degrees();
        println!("{entries:6} {dither:?}: {low:.4}° after the low-pass, {single:.3}° for single texels");
        low
    });
    println!("       shares: {:.4} diffusion, {:.4} blue noise", diffusion / none, blue_noise / none);
    [diffusion / none, blue_noise / none]
}

#[test]
fn averages_of_the_bunny_are_right() {
    let Some(path) = testkit::shared_file("normal/bunny_object_1536x1024.png") else { return };
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let normals = bytes[..info.buffer_size()].chunks_exact(3).map(|c| decode_u8([c[0], c[1], c[2]])).collect();
    let map = Grid::new(info.width, info.height, normals).unwrap();
    for (entries, allowed) in [(256, [0.30, 0.42]), (2048, [0.42, 0.78])] {
        let found = shares(&map, entries);
        assert!(found[0] <= allowed[0] && found[1] <= allowed[1], "{entries}: {found:?}");
    }
}

#[test]
fn averages_of_smooth_maps_are_right() {
    // The hills have normals beyond their outermost entries, which no average reaches: the fewer entries, the more.
    for (map, entries, allowed) in [
        (ball(600, 300), 32, [0.15, 0.19]),
        (ball(600, 300), 256, [0.17, 0.23]),
        (hills(400, 300), 8, [0.62, 0.66]),
        (hills(400, 300), 256, [0.56, 0.77]),
    ] {
        let found = shares(&map, entries);
        assert!(found[0] <= allowed[0] && found[1] <= allowed[1], "{entries}: {found:?}");
    }
}

/// Also the lines and points that have no triangles, and tables of one entry.
#[test]
fn table_materials_and_smaller_levels_are_those_without_dithering() {
    let map = hills(61, 47);
    let ridge = map.map(|n| normal([n.vec().x, 0.0, n.vec().z]));
    for map in [&map, &ridge] {
        for entries in [4, 5, 9, 100] {
            for cell in [1, 3, 16] {
                let materials = Grid::from_fn(61, 47, |x, y| ((x / cell + 2 * (y / cell)) % 4 * 9) as u8).unwrap();
                let options =
                    |dither| Options { materials: Some(&materials), mip_levels: true, ..with(entries, dither) };
                let plain = run(map, &options(Dither::None));
                for dither in METHODS {
                    let dithered = run(map, &options(dither));
                    assert_eq!(dithered.map.table(), plain.map.table());
                    assert_eq!(dithered.map.expand_materials(), materials, "{dither:?}");
                    assert_eq!(dithered.map.indices().levels()[1..], plain.map.indices().levels()[1..]);
                    // Chords are taken from the table here and from the map there, and all sum in their own order.
                    let measured = angle_stats(map, &dithered.map.expand(), None).unwrap();
                    let [found, expected] = [dithered.error, measured].map(|e| [e.rms_rad, e.p99_rad, e.max_rad]);
                    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b;
                    assert!(found.iter().zip(&expected).all(close), "{found:?} {expected:?}");
                    assert!(dithered.error.rms_rad >= plain.error.rms_rad * (1.0 - 1e-9));
                    // (Diffusion needs neighbours of the same material.)
                    assert!(entries < 100 || cell == 1 || dithered.map.base() != plain.map.base());
                }
            }
        }
    }
}

/// What one material is, or gutter is, does not show in another.
#[test]
fn errors_stay_where_they_are() {
    let map = hills(80, 60);
    let inside = Grid::from_fn(80, 60, |x, y| (x / 7 + y / 5) % 2 == 0).unwrap();
    let materials: MaterialMap = inside.map(|&i| u8::from(i));
    // Other normals in the other places, with the same statistics: each table stays as it is.
    let mut other = map.clone();
    for y in 0..60 {
        let mut row: Vec<_> = (0..80).filter(|&x| !inside[(x, y)]).collect();
        let values: Vec<_> = row.iter().map(|&x| map[(x, y)]).collect();
        row.reverse();
        row.into_iter().zip(values).for_each(|(x, n)| other[(x, y)] = n);
    }
    for dither in METHODS {
        for (materials, covered) in [(Some(&materials), None), (None, Some(&inside))] {
            let options = Options { materials, covered, ..with(40, dither) };
            let (a, b) = (run(&map, &options).map, run(&other, &options).map);
            assert_eq!(a.table(), b.table());
            let plain = run(&map, &Options { dither: Dither::None, ..options }).map;
            let mut changed = 0;
            for (i, &is_inside) in inside.texels().iter().enumerate() {
                let [a, b, plain] = [&a, &b, &plain].map(|m| m.base().texels()[i]);
                assert!(a == b || !is_inside, "{dither:?}");
                assert!(a == plain || is_inside || covered.is_none(), "{dither:?}: gutter has its nearest entries");
                changed += u32::from(a != plain);
            }
            assert!(changed > 500, "{dither:?}: {changed}");
        }
        // And the other way round: gutter does not depend on what is covered.
        let outside = inside.map(|&i| !i);
        let options = Options { covered: Some(&outside), ..with(40, dither) };
        let (dithered, plain) = (run(&map, &options).map, run(&map, &Options { dither: Dither::None, ..options }).map);
        let same = |i: usize| dithered.base().texels()[i] == plain.base().texels()[i];
        assert!((0..4800).all(|i| outside.texels()[i] || same(i)), "{dither:?}");
    }
}

#[test]
fn what_the_table_holds_is_not_dithered() {
    let hills = hills(90, 50);
    // Flat ground between hills: its normal is an entry of its own.
    let map = Grid::from_fn(90, 50, |x, y| if (30..60).contains(&x) { Normal::Z } else { hills[(x, y)] }).unwrap();
    let materials = Grid::from_fn(90, 50, |x, _| u8::from((30..60).contains(&x))).unwrap();
    for dither in METHODS {
        let few = run(&map, &Options { materials: Some(&materials), ..with(30, dither) }).map;
        let entry = few.base()[(45, 0)];
        assert!((0..50).all(|y| (30..60).all(|x| few.base()[(x, y)] == entry)), "{dither:?}");
        // And within one material: entries are as many as normals.
        let coarse = run(&hills, &with(50, Dither::None)).map.expand();
        assert_eq!(run(&coarse, &with(50, dither)).map.expand(), coarse, "{dither:?}");
    }
}

#[test]
fn methods_are_the_same_bits_on_any_number_of_threads() {
    let map = hills(190, 130);
    let covered = Grid::from_fn(190, 130, |x, y| (x * 7 + y * 3) % 11 > 1).unwrap();
    let materials = Grid::from_fn(190, 130, |x, y| (x / 50 + y / 40) as u8).unwrap();
    for dither in METHODS {
        let make = || run(&map, &Options { covered: Some(&covered), materials: Some(&materials), ..with(120, dither) });
        let expected = make();
        #[cfg(feature = "rayon")]
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(make).map, expected.map, "{threads} threads");
        }
        assert_eq!(make().map, expected.map);
    }
}

/// Errors as slopes against the meant normals, along two axes of the tangent plane.
fn errors(map: &NormalMap<Object>, dither: Dither, entries: u32) -> [Grid<f64>; 2] {
    let found = run(map, &with(entries, dither)).map.expand();
    [DVec3::X, DVec3::Y].map(|axis| {
        Grid::from_fn(map.width(), map.height(), |x, y| {
            let n = map[(x, y)].vec().as_dvec3();
            (found[(x, y)].vec().as_dvec3() - n).dot((axis - n * n.dot(axis)).normalize())
        })
        .expect("valid by construction")
    })
}

/// Correlation of errors a step apart.
fn correlation(error: &Grid<f64>, (dx, dy): (u32, i32)) -> f64 {
    let (w, h) = error.size();
    let pairs = (8..h - 8).flat_map(|y| (8..w - 8).map(move |x| ((x, y), (x + dx, (y as i32 + dy) as u32))));
    let (mut product, mut square) = (0.0, 0.0);
    for (a, b) in pairs {
        product += error[a] * error[b];
        square += error[a] * error[a];
    }
    product / square
}

/// Share of the error's power at periods above 8 texels, against white noise of the same power.
fn low_frequencies(error: &Grid<f64>) -> f64 {
    let (w, h) = error.size();
    let side = 8;
    let (mut low, mut all) = (0.0, 0.0);
    for y in 0..h / side {
        for x in 0..w / side {
            let block = (0..side * side).map(|i| error[(x * side + i % side, y * side + i / side)]);
            let (sum, squares) = block.fold((0.0, 0.0), |(s, q), e| (s + e, q + e * e));
            low += sum * sum / f64::from(side * side);
            all += squares;
        }
    }
    low / all * f64::from(side * side)
}

#[test]
fn noise_is_fine_and_has_no_direction() {
    let map = ball(768, 384);
    for (dither, most_low, most_uneven) in [(Dither::Diffusion, 0.14, 0.3), (Dither::BlueNoise, 0.19, 0.05)] {
        for error in errors(&map, dither, 64) {
            let low = low_frequencies(&error);
            let along =
                [(1, 0), (0, 1), (1, 1), (1, -1), (2, 0), (0, 2), (3, 0), (0, 3)].map(|step| correlation(&error, step));
            println!("{dither:?}: low frequencies {low:.4} of white noise, correlations {along:.3?}");
            assert!(low < most_low, "{dither:?}: {low}");
            for pair in along.chunks(2) {
                assert!((pair[0] - pair[1]).abs() < most_uneven, "{dither:?}: {along:?}");
            }
        }
    }
    let low = low_frequencies(&errors(&map, Dither::None, 64)[0]);
    println!("None: low frequencies {low:.4} of white noise");
    assert!(low > 3.0, "facets are low frequencies: {low}");
}
