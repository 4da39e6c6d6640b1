//! Normals of 16-bit height maps against the exact normals of the shapes they were sampled from.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic and tell its figures")]

use std::fs::File;
use std::io::BufReader;

use glam::Vec3;
use rilievo::height::{Filter, HeightMap, to_normals};
use rilievo::measure::{AngleStats, angle_stats};
use rilievo::{Edges, Grid, Normal, NormalMap, Tangent};

/// 16-bit grey PNG as heights 0 … 1.
fn read_heights(name: &str) -> Option<Grid<f32>> {
    let path = testkit::shared_file(&format!("analytic/{name}_height16.png"))?;
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Grayscale, png::BitDepth::Sixteen));
    let heights = bytes.chunks_exact(2).map(|b| f32::from(u16::from_be_bytes([b[0], b[1]])) / 65_535.0);
    Some(Grid::new(info.width, info.height, heights.collect()).unwrap())
}

fn read_normals(name: &str) -> Option<NormalMap<Tangent>> {
    let path = testkit::shared_file(&format!("analytic/{name}_normal_f16.npy"))?;
    let (shape, values) = testkit::read_npy_f16(&std::fs::read(path).unwrap());
    assert_eq!((shape.len(), shape[2]), (3, 3));
    let normals = values.chunks_exact(3).map(|n| Normal::new(Vec3::from_slice(n)).unwrap());
    Some(Grid::new(shape[1] as u32, shape[0] as u32, normals.collect()).unwrap())
}

/// Errors against the exact normals, over the texels whose exact normal and those around it pass `smooth`; `None`
/// without test data.
fn errors(
    name: &str,
    depth: f32,
    filter: Filter,
    edges: Edges,
    smooth: impl Fn(Normal<Tangent>) -> bool,
) -> Option<AngleStats> {
    let exact = read_normals(name)?;
    let found = to_normals(&HeightMap::new(read_heights(name)?, depth).unwrap(), filter, edges);
    let (width, height) = exact.size();
    let around = |i: u32, len: u32| (i64::from(i) - 1..=i64::from(i) + 1).map(move |p| edges.resolve(p, len));
    let covered =
        Grid::from_fn(width, height, |x, y| around(y, height).all(|y| around(x, width).all(|x| smooth(exact[(x, y)]))));
    let stats = angle_stats(&exact, &found, Some(&covered.unwrap())).unwrap();
    let [mean, rms, p99, max] = [stats.mean_rad, stats.rms_rad, stats.p99_rad, stats.max_rad].map(f64::to_degrees);
    let count = stats.count;
    println!(
        "{name} {filter:?} {edges:?}: mean {mean:.4}° rms {rms:.4}° p99 {p99:.4}° max {max:.4}° of {count} texels"
    );
    Some(stats)
}

fn everywhere(_: Normal<Tangent>) -> bool {
    true
}

const FILTERS: [Filter; 4] = [Filter::Plane4, Filter::Plane8, Filter::Sobel, Filter::Scharr];

#[test]
fn waves_wrapped_within_3_hundredths_of_a_degree() {
    let Some(stats) = errors("waves_4_4", 0.05, Filter::default(), Edges::Wrap, everywhere) else { return };
    assert!(stats.max_rad.to_degrees() <= 0.03, "{stats:?}");
    // The others smooth across the slope as well, which waves in both directions cannot hide.
    for filter in FILTERS {
        let stats = errors("waves_4_4", 0.05, filter, Edges::Wrap, everywhere).unwrap();
        assert!(stats.max_rad.to_degrees() <= 0.06, "{filter:?} {stats:?}");
    }
}

#[test]
fn ramp_clamped_is_right_in_all_texels() {
    for filter in FILTERS {
        let Some(stats) = errors("ramp", 0.5, filter, Edges::Clamp, everywhere) else { return };
        assert_eq!(stats.count, 512 * 512);
        assert!(stats.max_rad.to_degrees() <= 0.12, "{filter:?} {stats:?}");
    }
}

#[test]
fn flat_is_exact() {
    for filter in FILTERS {
        let Some(stats) = errors("flat", 0.5, filter, Edges::Wrap, everywhere) else { return };
        assert_eq!(stats.max_rad, 0.0);
    }
}

#[test]
fn hemispheres_are_right_away_from_their_rims() {
    for filter in FILTERS {
        // Slopes up to 45°: at the rim they are infinite and jump to 0, which no neighbourhood can follow.
        let caps = |n: Normal<Tangent>| n.vec().z > 0.5f32.sqrt() && n.vec().z < 0.9999;
        let Some(stats) = errors("hemispheres_6", 0.07, filter, Edges::Wrap, caps) else { return };
        assert!(stats.count > 10_000);
        assert!(stats.max_rad.to_degrees() <= 0.1, "{filter:?} {stats:?}");
        errors("hemispheres_6", 0.07, filter, Edges::Wrap, everywhere);
    }
}
