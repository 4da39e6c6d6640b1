use rilievo::progress::Silent;
use rilievo::quantize::{Effort, Options, fejes_toth_rms_rad, quantize};
use rilievo::{Grid, NormalMap, Object};
fn cpu() -> f64 { let s = std::fs::read_to_string("/proc/self/schedstat").unwrap(); s.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-9 }
#[test]
fn go() {
    let e: u32 = std::env::var("K").unwrap().parse().unwrap();
    let n: usize = std::env::var("N").map_or(1_000_000, |v| v.parse().unwrap());
    let effort = match std::env::var("EFF").as_deref() { Ok("fast") => Effort::Fast, Ok("best") => Effort::Best, _ => Effort::Normal };
    let map: NormalMap<Object> = if std::env::var("BUNNY").is_ok() {
        let mut reader = png::Decoder::new(std::io::BufReader::new(std::fs::File::open("/work/shared/data/normal/bunny_object_1536x1024.png").unwrap())).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        Grid::new(info.width, info.height, bytes[..info.buffer_size()].chunks_exact(3).map(|c| rilievo::normal::decode_u8([c[0], c[1], c[2]])).collect()).unwrap()
    } else { Grid::new(n as u32 / 1000, 1000, testkit::uniform_sphere(n / 1000 * 1000, 1)).unwrap() };
    let q = quantize(&map, &Options { entries: e, effort, ..Options::default() }, &Silent).unwrap();
    let x = q.map.expand();
    let r = (map.texels().iter().zip(x.texels()).map(|(a, b)| a.angle_to(*b).powi(2)).sum::<f64>() / x.texels().len() as f64).sqrt().to_degrees();
    let _ = cpu();
    println!("RESULT K={e} {effort:?} rms={r:.4} ratio={:.4}", r / fejes_toth_rms_rad(e).to_degrees());
}
