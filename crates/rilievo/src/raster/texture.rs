//! Which texels a pixel sees, and how much of each.

use glam::Vec2;

use crate::grid::Edges;
use crate::mip::MipChain;

/// How a pixel gathers texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureFilter {
    /// The one texel under the pixel centre, full-size level.
    Nearest,
    /// The four texels about the pixel centre, full-size level.
    Bilinear,
    /// Bilinear on the two mip levels whose texels come nearest to the pixel's size, mixed.
    #[default]
    Trilinear,
}

/// Texture coordinates of a pixel centre, and their change to the next pixel to the right and below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Footprint {
    pub(super) uv: Vec2,
    pub(super) uv_dx: Vec2,
    pub(super) uv_dy: Vec2,
}

/// How a map is looked up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampling {
    pub(super) filter: TextureFilter,
    /// What lies beyond the texture square, and beyond each copy of the map on it.
    pub(super) edges: Edges,
    /// Copies of the map on the texture square, along u and v.
    pub(super) repeat: Vec2,
}

impl Sampling {
    /// The footprint in one copy of the map: its coordinates are within 0 … 1.
    fn in_copy(&self, at: &Footprint) -> Footprint {
        let place = |t, repeat| place_in_copy(t, repeat, self.edges);
        Footprint {
            uv: Vec2::new(place(at.uv.x, self.repeat.x), place(at.uv.y, self.repeat.y)),
            uv_dx: at.uv_dx * self.repeat,
            uv_dy: at.uv_dy * self.repeat,
        }
    }
}

/// Where coordinate `t` lies in its copy of the map, 0 … 1.
///
/// Always before it is scaled to texels: coordinates may be as large as numbers go, texel numbers may not. What is no
/// number any more lies at 0.
fn place_in_copy(t: f32, repeat: f32, edges: Edges) -> f32 {
    let fraction = |t: f32| t - t.floor();
    let square = match edges {
        Edges::Wrap => return Some(fraction(t * repeat)).filter(|f| f.is_finite()).unwrap_or(0.0),
        Edges::Clamp => t.clamp(0.0, 1.0),
        Edges::Mirror => 1.0 - (1.0 - t.rem_euclid(2.0)).abs(),
    };
    let inside = fraction(square * repeat);
    match inside.is_finite() {
        // The far rim is the end of the last copy, not the start of one more.
        true if inside == 0.0 && square > 0.0 => 1.0,
        true => inside,
        false => 0.0,
    }
}

/// One texel and its share; the shares of a pixel sum to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Tap {
    pub(super) level: usize,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) weight: f32,
}

/// Up to eight taps: two levels of four.
#[derive(Debug, Default)]
pub(super) struct Taps {
    taps: [Tap; 8],
    len: usize,
}

impl Taps {
    /// The texels of `chain` that a pixel sees.
    pub(super) fn gather<T>(chain: &MipChain<T>, sampling: Sampling, at: &Footprint) -> Self {
        let mut taps = Self::default();
        let (at, edges) = (sampling.in_copy(at), sampling.edges);
        match sampling.filter {
            TextureFilter::Nearest => taps.nearest(chain, at.uv, edges),
            TextureFilter::Bilinear => taps.bilinear(chain, at.uv, edges, (0, 1.0)),
            TextureFilter::Trilinear => {
                let last = chain.levels().len() - 1;
                let lod = level_of_detail(chain.base().size(), &at).clamp(0.0, last as f32);
                let (level, mix) = (lod.floor() as usize, lod.fract());
                taps.bilinear(chain, at.uv, edges, (level, 1.0 - mix));
                if mix > 0.0 {
                    taps.bilinear(chain, at.uv, edges, (level + 1, mix));
                }
            }
        }
        taps
    }

    pub(super) fn iter(&self) -> std::slice::Iter<'_, Tap> {
        self.taps[..self.len].iter()
    }

    fn push(&mut self, tap: Tap) {
        self.taps[self.len] = tap;
        self.len += 1;
    }

    fn nearest<T>(&mut self, chain: &MipChain<T>, uv: Vec2, edges: Edges) {
        let (width, height) = chain.base().size();
        let x = edges.resolve((uv.x * width as f32).floor() as i64, width);
        let y = edges.resolve((uv.y * height as f32).floor() as i64, height);
        self.push(Tap { level: 0, x, y, weight: 1.0 });
    }

    fn bilinear<T>(&mut self, chain: &MipChain<T>, uv: Vec2, edges: Edges, (level, share): (usize, f32)) {
        let (width, height) = chain.level(level).size();
        // Texel centres lie at (i + ½) / size.
        let p = uv * Vec2::new(width as f32, height as f32) - 0.5;
        let (corner, f) = (p.floor(), p - p.floor());
        let xs = [0, 1].map(|i| edges.resolve(corner.x as i64 + i, width));
        let ys = [0, 1].map(|i| edges.resolve(corner.y as i64 + i, height));
        for (y, wy) in ys.into_iter().zip([1.0 - f.y, f.y]) {
            for (x, wx) in xs.into_iter().zip([1.0 - f.x, f.x]) {
                self.push(Tap { level, x, y, weight: wx * wy * share });
            }
        }
    }
}

/// log2 of the longer side of the pixel's footprint in texels of the full-size level (isotropic, as GPUs have it).
fn level_of_detail((width, height): (u32, u32), at: &Footprint) -> f32 {
    let size = Vec2::new(width as f32, height as f32);
    let longest = (at.uv_dx * size).length_squared().max((at.uv_dy * size).length_squared());
    0.5 * longest.max(f32::MIN_POSITIVE).log2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    fn chain() -> MipChain<f32> {
        let base = Grid::from_fn(8, 4, |x, y| (x + 10 * y) as f32).unwrap();
        MipChain::build(base, |b| b.iter().copied().sum::<f32>() / b.len() as f32)
    }

    fn sample(filter: TextureFilter, uv: [f32; 2], texels_per_pixel: f32) -> f32 {
        sample_by(Sampling { filter, edges: Edges::Wrap, repeat: Vec2::ONE }, uv, texels_per_pixel)
    }

    fn sample_by(sampling: Sampling, uv: [f32; 2], texels_per_pixel: f32) -> f32 {
        let uv_dx = Vec2::new(texels_per_pixel / 8.0, 0.0);
        let at = Footprint { uv: uv.into(), uv_dx, uv_dy: Vec2::new(0.0, texels_per_pixel / 4.0) };
        let chain = chain();
        let taps = Taps::gather(&chain, sampling, &at);
        let total: f32 = taps.iter().map(|t| t.weight).sum();
        assert!((total - 1.0).abs() < 1e-6);
        taps.iter().map(|t| chain.levels()[t.level][(t.x, t.y)] * t.weight).sum()
    }

    #[test]
    fn texel_centres_give_the_texel() {
        for filter in [TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear] {
            assert_eq!(sample(filter, [3.5 / 8.0, 2.5 / 4.0], 1.0), 23.0);
        }
    }

    #[test]
    fn bilinear_mixes_and_wraps() {
        assert!((sample(TextureFilter::Bilinear, [4.0 / 8.0, 2.5 / 4.0], 1.0) - 23.5).abs() < 1e-5);
        // Between the last and the first column.
        assert!((sample(TextureFilter::Bilinear, [0.0, 0.5 / 4.0], 1.0) - 3.5).abs() < 1e-5);
        assert_eq!(sample(TextureFilter::Nearest, [-0.01, 1.01], 1.0), 7.0);
    }

    #[test]
    fn coordinates_without_a_fraction_still_give_texels() {
        for filter in [TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear] {
            for edges in [Edges::Wrap, Edges::Clamp, Edges::Mirror] {
                for repeat in [Vec2::ONE, Vec2::splat(1e5)] {
                    for u in [1e38, -1e38, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
                        let value = sample_by(Sampling { filter, edges, repeat }, [u, -u], 1.0);
                        assert!((0.0..=37.0).contains(&value), "{filter:?} {edges:?} {repeat} {u}: {value}");
                    }
                }
            }
        }
        // No fraction is the start of a copy.
        assert_eq!(sample(TextureFilter::Nearest, [1e38, f32::NAN], 1.0), 0.0);
        // A pixel that spans all numbers sees the mean.
        assert!((sample(TextureFilter::Trilinear, [1e38, 1e38], f32::MAX) - 18.5).abs() < 1e-4);
    }

    #[test]
    fn edges_say_what_lies_beyond_the_square() {
        let bilinear = |edges, repeat, u| {
            let sampling = Sampling { filter: TextureFilter::Bilinear, edges, repeat: Vec2::new(repeat, 1.0) };
            sample_by(sampling, [u, 0.5 / 4.0], 1.0)
        };
        for rim in [0.0, -0.0, -1e-7, -3.3, 0.5 / 8.0] {
            assert_eq!(bilinear(Edges::Clamp, 1.0, rim), 0.0, "{rim}");
        }
        for rim in [1.0, 1.0 + 1e-6, 4.0, 7.5 / 8.0] {
            assert_eq!(bilinear(Edges::Clamp, 1.0, rim), 7.0, "{rim}");
            assert_eq!(bilinear(Edges::Clamp, 3.0, rim.max(1.0)), 7.0, "{rim}, three copies");
        }
        // Two copies, the second one's third texel.
        assert!((bilinear(Edges::Clamp, 2.0, 0.5 + 2.5 / 16.0) - 2.0).abs() < 1e-5);
        for (u, expected) in [(1.0, 7.0), (1.0 + 2.5 / 8.0, 5.0), (-1.5 / 8.0, 1.0), (2.0, 0.0), (-2.0, 0.0)] {
            assert!((bilinear(Edges::Mirror, 1.0, u) - expected).abs() < 1e-5, "{u}");
        }
        let nearest = Sampling { filter: TextureFilter::Nearest, edges: Edges::Clamp, repeat: Vec2::ONE };
        assert_eq!(sample_by(nearest, [1.0, 1.0], 1.0), 37.0);
        // The coarser levels keep to the square as well: texel (0, 0) of level 1 is the mean of 0, 1, 10, 11.
        let trilinear = Sampling { filter: TextureFilter::Trilinear, ..nearest };
        assert!((sample_by(trilinear, [0.0, 0.0], 2.0) - 5.5).abs() < 1e-4);
    }

    #[test]
    fn trilinear_goes_down_the_levels() {
        // Two texels to a pixel is level 1; its texel (1, 0) is the mean of 2, 3, 12, 13.
        assert!((sample(TextureFilter::Trilinear, [3.0 / 8.0, 0.25], 2.0) - 7.5).abs() < 1e-4);
        // A pixel larger than the map sees its mean.
        assert!((sample(TextureFilter::Trilinear, [0.3, 0.9], 1e6) - 18.5).abs() < 1e-4);
    }
}
