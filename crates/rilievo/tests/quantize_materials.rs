//! How well entries are shared out among materials: against the best split that a search over splits finds.

#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

use std::collections::HashMap;

use rilievo::progress::Silent;
use rilievo::quantize::{Options, quantize};
use rilievo::{Grid, MaterialMap, Normal, NormalMap, Object};
use testkit::Random;

const SIDE: u32 = 40;
const MAPS: u64 = 100;

/// Patches of 2 to 16 materials; each has its own direction and spread, from nearly flat to all over the sphere.
fn random_map(random: &mut Random) -> (NormalMap<Object>, MaterialMap) {
    let count = 2 + (random.range(0.0, 15.0) as usize).min(14);
    let mut kind = || {
        let mut place = |s: f64| [0, 1, 2].map(|_| random.range(-s, s));
        (place(1.0), place(f64::from(SIDE)))
    };
    let kinds: Vec<_> = (0..count).map(|_| kind()).collect();
    let spreads: Vec<f64> = (0..count).map(|_| random.range(-3.0, 0.5).exp2().powi(2)).collect();
    // Each texel belongs to the nearest of some random places: patches of very different sizes.
    let material = |x: u32, y: u32| {
        let distance = |m: &usize| {
            let [px, py, _] = kinds[*m].1;
            (f64::from(x) - px.abs()).powi(2) + (f64::from(y) - py.abs()).powi(2)
        };
        (0..count).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap() as u8
    };
    let materials = Grid::from_fn(SIDE, SIDE, material).unwrap();
    let normals = Grid::from_fn(SIDE, SIDE, |x, y| {
        let m = usize::from(materials[(x, y)]);
        let v = [0, 1, 2].map(|k| kinds[m].0[k] + spreads[m] * random.range(-1.0, 1.0));
        Normal::new_or(glam::DVec3::from_array(v).as_vec3(), Normal::Z)
    });
    (normals.unwrap(), materials)
}

/// The sum of squared angles of each material alone, by the number of its entries; each is computed once.
struct Curves<'a> {
    map: &'a NormalMap<Object>,
    masks: Vec<Grid<bool>>,
    known: HashMap<(usize, u32), f64>,
}

impl Curves<'_> {
    fn at(&mut self, material: usize, entries: u32) -> f64 {
        let (map, mask) = (self.map, &self.masks[material]);
        *self.known.entry((material, entries)).or_insert_with(|| {
            let options = Options { entries, covered: Some(mask), ..Options::default() };
            let error = quantize(map, &options, &Silent).unwrap().error;
            error.rms_rad.powi(2) * error.count as f64
        })
    }

    /// Moves entries between materials, one at a time and always the best move, as long as that helps.
    fn climb(&mut self, mut split: Vec<u32>) -> f64 {
        loop {
            let materials = 0..split.len();
            let loss: Vec<f64> = materials
                .clone()
                .map(|m| match split[m] {
                    1 => f64::INFINITY,
                    k => self.at(m, k - 1) - self.at(m, k),
                })
                .collect();
            let gain: Vec<f64> = materials.clone().map(|m| self.at(m, split[m]) - self.at(m, split[m] + 1)).collect();
            let moves = materials.clone().flat_map(|from| materials.clone().map(move |to| (from, to)));
            let best = moves
                .filter(|(from, to)| from != to)
                .max_by(|a, b| (gain[a.1] - loss[a.0]).total_cmp(&(gain[b.1] - loss[b.0])));
            match best {
                Some((from, to)) if gain[to] - loss[from] > 1e-12 => {
                    split[from] -= 1;
                    split[to] += 1;
                }
                _ => return materials.map(|m| self.at(m, split[m])).sum(),
            }
        }
    }
}

#[test]
fn entries_are_shared_out_as_well_as_a_search_would() {
    let mut ratios = Vec::new();
    for seed in 0..MAPS {
        let mut random = Random::new(seed);
        let (map, materials) = random_map(&mut random);
        let mut in_use: Vec<u8> = materials.texels().to_vec();
        in_use.sort_unstable();
        in_use.dedup();
        let count = in_use.len() as u32;
        let entries = count + random.range(f64::from(count), 6.0 * f64::from(count)) as u32;
        let options = Options { entries, materials: Some(&materials), ..Options::default() };
        let quantized = quantize(&map, &options, &Silent).unwrap();
        let table = quantized.map.table();
        let index = &quantized.map.indices().levels()[0];
        for (texel, &entry) in index.texels().iter().enumerate() {
            assert_eq!(table.material_of(entry), materials.texels()[texel], "map {seed}, texel {texel}");
        }

        let masks = in_use.iter().map(|m| materials.map(|t| t == m)).collect();
        let mut curves = Curves { map: &map, masks, known: HashMap::new() };
        let own: Vec<u32> = table.spans().iter().map(|s| s.entries.end - s.entries.start).collect();
        // One entry each and the next where it helps most: the best split, if errors fall ever slower.
        let mut greedy = vec![1; in_use.len()];
        for _ in count..table.len() as u32 {
            let gain = |m: usize, curves: &mut Curves<'_>| curves.at(m, greedy[m]) - curves.at(m, greedy[m] + 1);
            let gains: Vec<f64> = (0..greedy.len()).map(|m| gain(m, &mut curves)).collect();
            let best = (0..gains.len()).max_by(|&a, &b| gains[a].total_cmp(&gains[b])).unwrap();
            greedy[best] += 1;
        }
        let searched = curves.climb(greedy).min(curves.climb(own));
        let found = quantized.error.rms_rad.powi(2) * quantized.error.count as f64;
        ratios.push(((found / searched).sqrt(), seed));
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (worst, seed) = ratios[ratios.len() - 1];
    println!(
        "RMS against the best split found: median {:.4}, worst {worst:.4} (map {seed})",
        ratios[ratios.len() / 2].0
    );
    assert!(worst <= 1.03, "map {seed}: {worst:.4} × the best split found");
}
