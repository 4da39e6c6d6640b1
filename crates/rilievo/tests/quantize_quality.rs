//! How close tables come to the best there can be, on a uniform sphere and on a real map.

use std::fs::File;
use std::io::BufReader;

use rilievo::normal::decode_u8;
use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, fejes_toth_rms_rad, quantize};
use rilievo::{Grid, NormalMap, Object};

/// RMS angle in degrees, by the definition.
#[expect(clippy::print_stdout, reason = "shows the figures that are measured here")]
fn rms_deg(map: &NormalMap<Object>, entries: u32, effort: Effort) -> f64 {
    let start = std::time::Instant::now();
    let quantized = quantize(map, &Options { entries, effort, ..Options::default() }, &Silent).expect("valid options");
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!(quantized.map.table().len(), entries as usize);
    let expanded = quantized.map.expand();
    assert_eq!(quantized.error.count, map.texels().len() as u64);
    let squares = map.texels().iter().zip(expanded.texels()).map(|(a, b)| a.angle_to(*b).powi(2));
    let rms = (squares.sum::<f64>() / map.texels().len() as f64).sqrt().to_degrees();
    assert!((quantized.error.rms_rad.to_degrees() - rms).abs() < 1e-6);
    println!("{entries:6} {effort:?}: {rms:.4}° in {seconds:.3} s, {} distinct", quantized.distinct);
    rms
}

#[test]
fn uniform_sphere_comes_close_to_the_bound() {
    let map = Grid::new(1000, 1000, testkit::uniform_sphere(1_000_000, 1)).unwrap();
    for (entries, effort, allowed) in [
        (256, Effort::Fast, 1.03),
        (256, Effort::Normal, 1.005),
        (2048, Effort::Normal, 1.005),
        // 61 points per entry: the table fits the sample, not the sphere.
        (16_384, Effort::Normal, 1.0),
    ] {
        let (found, bound) = (rms_deg(&map, entries, effort), fejes_toth_rms_rad(entries).to_degrees());
        println!("       {:.4} × the bound", found / bound);
        assert!(found < bound * allowed, "{entries}: {found}° is {:.4} × the bound", found / bound);
    }
}

#[test]
fn bunny_map_has_small_errors() {
    let Some(path) = testkit::shared_file("normal/bunny_object_1536x1024.png") else { return };
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    let normals = bytes[..info.buffer_size()].chunks_exact(3).map(|c| decode_u8([c[0], c[1], c[2]])).collect();
    let map = Grid::new(info.width, info.height, normals).unwrap();
    for (entries, allowed) in [(256, 4.25), (2048, 1.385), (16_384, 0.420)] {
        let found = rms_deg(&map, entries, Effort::Normal);
        assert!(found <= allowed, "{entries}: {found}°");
    }
}
