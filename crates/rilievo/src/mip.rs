//! Chains of ever smaller levels of a map.

use crate::color::{LinearRgb, Picture};
use crate::grid::Grid;

/// The levels of a map, largest first; each level is half the one before (rounded down, at least 1), to 1 × 1 at most.
#[derive(Debug, Clone, PartialEq)]
pub struct MipChain<T> {
    levels: Vec<Grid<T>>,
}

/// Size of the level after one of size `(width, height)`; `None` after 1 × 1.
pub fn next_size((width, height): (u32, u32)) -> Option<(u32, u32)> {
    (width > 1 || height > 1).then(|| ((width / 2).max(1), (height / 2).max(1)))
}

impl<T> MipChain<T> {
    /// A chain of one level.
    pub fn single(level: Grid<T>) -> Self {
        Self { levels: vec![level] }
    }

    /// Builds all levels below `base`; `reduce` makes one texel of the block of 2 × 2 (3 along an odd side's end) above it.
    pub fn build(base: Grid<T>, reduce: impl Fn(&[&T]) -> T) -> Self {
        let mut levels = vec![base];
        while let Some(level) = levels.last().and_then(|above| reduced(above, &reduce)) {
            levels.push(level);
        }
        Self { levels }
    }

    /// Wraps levels that were read from somewhere.
    ///
    /// # Errors
    /// [`crate::Error::SizeMismatch`] where a level is not half the one before.
    pub fn from_levels(levels: Vec<Grid<T>>) -> crate::Result<Self> {
        if levels.is_empty() {
            return Err(crate::Error::Missing { what: "mip levels", remedy: "give at least the full-size level" });
        }
        for pair in levels.windows(2) {
            let expected = next_size(pair[0].size()).unwrap_or((1, 1));
            if pair[1].size() != expected || pair[0].size() == (1, 1) {
                return Err(crate::Error::SizeMismatch { what: "mip level", expected, actual: pair[1].size() });
            }
        }
        Ok(Self { levels })
    }

    /// The full-size level.
    pub fn base(&self) -> &Grid<T> {
        &self.levels[0]
    }

    /// All levels, largest first; never empty.
    pub fn levels(&self) -> &[Grid<T>] {
        &self.levels
    }

    /// The level whose texels are at least `lod` halvings small, or the last.
    pub fn level(&self, lod: usize) -> &Grid<T> {
        &self.levels[lod.min(self.levels.len() - 1)]
    }
}

impl MipChain<LinearRgb> {
    /// The levels of a base colour: a picture in linear light, averaged there. Alpha plays no part.
    pub fn from_picture(picture: &Picture) -> Self {
        Self::build(picture.map(|p| LinearRgb::from_srgb(p.rgb())), |block| {
            let sum = block.iter().fold(LinearRgb::BLACK, |sum, &&c| sum + c);
            sum * (1.0 / block.len() as f32)
        })
    }
}

/// The texels of a side of length `above` that texel `i` of the halved side covers.
pub(crate) fn span(i: u32, above: u32) -> std::ops::Range<u32> {
    let half = (above / 2).max(1);
    let end = if i + 1 == half { above } else { 2 * i + 2 };
    2 * i..end
}

fn reduced<T>(above: &Grid<T>, reduce: impl Fn(&[&T]) -> T) -> Option<Grid<T>> {
    let (width, height) = next_size(above.size())?;
    let mut block = Vec::with_capacity(9);
    let level = Grid::from_fn(width, height, |x, y| {
        block.clear();
        for sy in span(y, above.height()) {
            block.extend(span(x, above.width()).map(|sx| &above[(sx, sy)]));
        }
        reduce(&block)
    });
    Some(level.expect("invariant: half of a valid size is valid"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_sizes_lose_no_texel() {
        for (w, h) in [(1, 1), (5, 3), (7, 1), (1, 6), (8, 8)] {
            // Summing instead of averaging: the last level must hold the sum of all texels.
            let base = Grid::from_fn(w, h, |x, y| u64::from(x * 31 + y * 17)).unwrap();
            let total: u64 = base.texels().iter().sum();
            let chain = MipChain::build(base, |b| b.iter().copied().sum());
            assert_eq!(chain.levels().last().unwrap().texels(), [total], "{w}×{h}");
            assert!(MipChain::from_levels(chain.levels().to_vec()).is_ok());
        }
    }

    #[test]
    fn pictures_are_averaged_in_linear_light() {
        let picture = Grid::from_fn(2, 1, |x, _| crate::Rgba8::new(x as u8 * 255, 0, 0, 255)).unwrap();
        // Half the light of full red is code 188, not 128.
        let mean = MipChain::from_picture(&picture).level(1)[(0, 0)];
        assert_eq!(mean.to_srgb().rgb(), [188, 0, 0]);
    }

    #[test]
    fn from_levels_refuses_wrong_sizes() {
        let level = |w, h| Grid::filled(w, h, 0u8).unwrap();
        assert!(MipChain::from_levels(vec![level(4, 4), level(2, 1)]).is_err());
        assert!(MipChain::from_levels(vec![level(1, 1), level(1, 1)]).is_err());
        assert!(MipChain::<u8>::from_levels(vec![]).is_err());
    }
}
