//! The polar units: identities and known answers in f64, then the integer models against them.

use core::f64::consts::{FRAC_PI_2, PI};
use rilievo_polar::{Frame, Model, Sample, UnitKind, Width};
use testkit::Random;
use testkit::polar::{Polar, e3, e4, exact, exact_products, exact_z, polar_product, published, uvw};

/// Anywhere on the sphere.
fn anywhere(random: &mut Random) -> Polar {
    Polar { phi: random.range(-PI, PI), theta: random.range(-1.0, 1.0).acos() }
}

#[test]
fn exact_units_are_identities() {
    let mut random = Random::new(1);
    let mut worst = [0.0f64; 4];
    for _ in 0..200_000 {
        let [a, n, b] = [0; 3].map(|_| anywhere(&mut random));
        let (rotated, bump) = (exact(a, n), b.cartesian());
        let dot = rotated.dot(bump);
        let errors = [
            (uvw(a, n) - rotated).abs().max_element(),
            polar_product(Polar::of(rotated), b) - dot,
            e3(a, n, bump) - dot,
            e4(a, n, bump) - dot,
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
    }
    assert!(worst.iter().all(|error| *error <= 1e-12), "{worst:?}");
}

#[test]
fn published_rotation_is_exact_along_the_meridian() {
    let mut random = Random::new(2);
    for _ in 0..10_000 {
        let n = Polar::upper(&mut random);
        for delta in [0.0, PI] {
            let a = Polar { phi: n.phi + delta, theta: Polar::upper(&mut random).theta };
            let error = published(a, n).cartesian().angle_between(exact(a, n));
            assert!(error <= 1e-7, "{a:?} {n:?}: {error}");
            let theta = exact(a, n).truncate().length().atan2(exact(a, n).z);
            assert!((published(a, n).theta - theta).abs() <= 1e-9, "{a:?} {n:?}");
        }
    }
}

#[test]
fn published_rotation_errs_by_the_known_answers() {
    for (delta, theta_a, theta_n, expected) in [
        (90.0, 90.0, 90.0, 45.0),
        (45.0, 90.0, 90.0, 60.0),
        (45.0, 60.0, 0.0, 7.229),
        (60.0, 45.0, 45.0, 16.20),
        (90.0, 60.0, 30.0, 28.96),
    ] {
        let angle = |degrees: f64| degrees.to_radians();
        let a = Polar { phi: angle(delta), theta: angle(theta_a) };
        let n = Polar { phi: 0.0, theta: angle(theta_n) };
        let error = published(a, n).cartesian().angle_between(exact(a, n)).to_degrees();
        assert!((error - expected).abs() <= 0.01, "{delta} {theta_a} {theta_n}: {error}");
    }
}

/// Mean, RMS and largest of angles in degrees over vectors and normals of the upper half with A·N > 0.
fn rotation_errors(rotate: fn(Polar, Polar) -> Polar) -> [f64; 3] {
    let mut random = Random::new(3);
    let (mut sum, mut squares, mut max, mut count) = (0.0, 0.0, 0.0f64, 0);
    while count < 500_000 {
        let [a, n] = [0; 2].map(|_| Polar::upper(&mut random));
        if a.cartesian().dot(n.cartesian()) <= 0.0 {
            continue;
        }
        let error = rotate(a, n).cartesian().angle_between(exact(a, n)).to_degrees();
        sum += error;
        squares += error * error;
        max = max.max(error);
        count += 1;
    }
    let count = f64::from(count);
    [sum / count, (squares / count).sqrt(), max]
}

#[test]
fn published_rotation_errs_by_the_known_statistics() {
    let [mean, rms, max] = rotation_errors(published);
    assert!((mean - 15.8).abs() <= 0.2 && (rms - 19.8).abs() <= 0.2 && max < 60.0, "{mean} {rms} {max}");
}

#[test]
fn exact_z_leaves_the_error_of_the_proportion() {
    let [mean, rms, max] = rotation_errors(exact_z);
    assert!((mean - 4.1).abs() <= 0.1 && (rms - 4.8).abs() <= 0.1, "{mean} {rms}");
    assert!(max <= 8.611 && max > 8.5, "{max}");
    // Where the two angles are 31.65° each.
    let turn = 31.65f64.to_radians();
    let true_angle = (turn.cos() * turn.cos()).acos();
    let proportional = turn + (FRAC_PI_2 - turn) * turn / FRAC_PI_2;
    assert!(((proportional - true_angle).to_degrees() - 8.610).abs() <= 0.001);
}

/// RMS and largest error of a model's inner products against what is to be expected of the same words: vectors and normals
/// of the upper half with A·N > 0, bump vectors within `steepest` degrees of the normal.
fn product_errors(kind: UnitKind, bits: u32, steepest: f64, expected: impl Fn(&Sample) -> [f64; 2]) -> [f64; 2] {
    let width = Width::new(bits).expect("a width of the test");
    let mut random = Random::new(4);
    // The vectors of a frame stay; nothing else differs between units.
    let frame = Frame::default();
    let model = Model::new(kind, width, frame);
    let (mut squares, mut max, mut count) = (0.0, 0.0f64, 0.0);
    for _ in 0..100_000 {
        let [light, half, normal] = [0; 3].map(|_| Polar::upper(&mut random).words());
        let theta = random.range(steepest.to_radians().cos(), 1.0).acos();
        let bump = Polar { phi: random.range(-PI, PI), theta }.words();
        let (light, half) = if kind.is_distant() { (frame.light, frame.half) } else { (light, half) };
        let sample = Sample { light, half, normal, bump };
        let facing = [light, half].map(|v| exact(v.into(), normal.into()).z > 0.0);
        let found = model.products(&sample.words(kind));
        for ((found, expected), facing) in found.into_iter().zip(expected(&sample)).zip(facing) {
            if facing {
                let error = (f64::from(found) / 16384.0 - expected).abs();
                squares += error * error;
                max = max.max(error);
                count += 1.0;
            }
        }
    }
    [(squares / count).sqrt(), max]
}

#[test]
fn integer_models_keep_to_their_bars() {
    let published_products = |sample: &Sample| {
        let bump = sample.bump.into();
        [sample.light, sample.half].map(|v| polar_product(published(v.into(), sample.normal.into()), bump))
    };
    // E1's arc cosine is steep at the pole, and an error there shows with bump vectors that lie: 0.0462 up to 90°.
    for (kind, bits, steepest, [rms, max]) in [
        (UnitKind::E3, 8, 90.0, [0.0015, 0.006]),
        (UnitKind::E4, 8, 90.0, [0.004, 0.07]),
        (UnitKind::E1, 8, 60.0, [0.0025, 0.045]),
        (UnitKind::E1, 8, 90.0, [0.0025, 0.047]),
        (UnitKind::E3, 10, 90.0, [4e-4, 0.002]),
    ] {
        let found = product_errors(kind, bits, steepest, exact_products);
        println!("{kind}, tables of 2^{bits}, up to {steepest}°: {found:.5?}");
        assert!(found[0] <= rms && found[1] <= max, "{kind} {bits}: {found:?}");
    }
    let found = product_errors(UnitKind::Published, 8, 90.0, published_products);
    println!("published, against itself in f64: {found:.5?}");
    assert!(found[0] <= 0.012 && found[1] <= 0.08, "{found:?}");
}

#[test]
fn no_model_exceeds_its_limit() {
    for kind in UnitKind::ALL {
        for bits in [4, 8, 10, 14] {
            let width = Width::new(bits).expect("a width of the test");
            let Some(limit) = Model::new(kind, width, Frame::default()).limit() else { continue };
            let limit = f64::from(limit) / 16384.0;
            // Light maps know nothing below the horizon.
            let floor = if kind == UnitKind::Kugler { 0.0 } else { -1.0 };
            let [rms, max] = product_errors(kind, bits, 90.0, |s| exact_products(s).map(|dot| dot.max(floor)));
            println!("{kind} {bits}: rms {rms:.5} max {max:.5} limit {limit:.5}");
            assert!(max <= limit, "{kind} {bits}: {max} over {limit}");
            // A limit that says nothing is none.
            assert!(limit < 40.0 * max, "{kind} {bits}: {max} under {limit}");
            if kind == UnitKind::Peercy || kind == UnitKind::Kugler {
                break;
            }
        }
    }
}

#[test]
fn what_is_left_of_the_methods_errors_is_theirs() {
    // Of inner products, over the same vectors: what no table can mend.
    let [rms, max] = product_errors(UnitKind::Published, 8, 90.0, exact_products);
    assert!((0.17..0.21).contains(&rms) && max > 0.8, "{rms} {max}");
    let [rms, max] = product_errors(UnitKind::ExactZ, 8, 90.0, exact_products);
    assert!((0.04..0.07).contains(&rms) && max < 0.16, "{rms} {max}");
}
