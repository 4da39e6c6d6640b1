//! Which texels a pixel sees, and how much of each.

use glam::Vec2;

use crate::grid::Edges;
use crate::mip::MipChain;

/// How a pixel gathers texels. Maps repeat beyond 0 … 1, as glTF's default sampler has it.
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

impl Footprint {
    /// The footprint in a map that repeats.
    pub(super) fn repeated(self, repeat: Vec2) -> Self {
        Self { uv: self.uv * repeat, uv_dx: self.uv_dx * repeat, uv_dy: self.uv_dy * repeat }
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
    pub(super) fn gather<T>(chain: &MipChain<T>, filter: TextureFilter, at: &Footprint) -> Self {
        let mut taps = Self::default();
        match filter {
            TextureFilter::Nearest => taps.nearest(chain, at.uv),
            TextureFilter::Bilinear => taps.bilinear(chain, at.uv, 0, 1.0),
            TextureFilter::Trilinear => {
                let last = chain.levels().len() - 1;
                let lod = level_of_detail(chain.base().size(), at).clamp(0.0, last as f32);
                let (level, mix) = (lod.floor() as usize, lod.fract());
                taps.bilinear(chain, at.uv, level, 1.0 - mix);
                if mix > 0.0 {
                    taps.bilinear(chain, at.uv, level + 1, mix);
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

    fn nearest<T>(&mut self, chain: &MipChain<T>, uv: Vec2) {
        let (width, height) = chain.base().size();
        let x = Edges::Wrap.resolve((uv.x * width as f32).floor() as i64, width);
        let y = Edges::Wrap.resolve((uv.y * height as f32).floor() as i64, height);
        self.push(Tap { level: 0, x, y, weight: 1.0 });
    }

    fn bilinear<T>(&mut self, chain: &MipChain<T>, uv: Vec2, level: usize, share: f32) {
        let (width, height) = chain.level(level).size();
        // Texel centres lie at (i + ½) / size.
        let p = uv * Vec2::new(width as f32, height as f32) - 0.5;
        let (corner, f) = (p.floor(), p - p.floor());
        let xs = [0, 1].map(|i| Edges::Wrap.resolve(corner.x as i64 + i, width));
        let ys = [0, 1].map(|i| Edges::Wrap.resolve(corner.y as i64 + i, height));
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
        let uv_dx = Vec2::new(texels_per_pixel / 8.0, 0.0);
        let at = Footprint { uv: uv.into(), uv_dx, uv_dy: Vec2::new(0.0, texels_per_pixel / 4.0) };
        let chain = chain();
        let taps = Taps::gather(&chain, filter, &at);
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
    fn trilinear_goes_down_the_levels() {
        // Two texels to a pixel is level 1; its texel (1, 0) is the mean of 2, 3, 12, 13.
        assert!((sample(TextureFilter::Trilinear, [3.0 / 8.0, 0.25], 2.0) - 7.5).abs() < 1e-4);
        // A pixel larger than the map sees its mean.
        assert!((sample(TextureFilter::Trilinear, [0.3, 0.9], 1e6) - 18.5).abs() < 1e-4);
    }
}
