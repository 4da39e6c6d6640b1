//! Rectangular arrays of texels, and what lies beyond their edges.

use crate::error::{Error, Result};

/// The longest side a grid may have, in texels.
pub const MAX_SIDE: u32 = 65_536;
/// The largest area a grid may have, in texels (32 768 × 32 768).
pub const MAX_TEXELS: u64 = 1 << 30;

/// A rectangle of texels, row-major, row 0 on top. Never empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid<T> {
    width: u32,
    height: u32,
    texels: Vec<T>,
}

/// Checks a size before anything is allocated for it; returns the number of texels.
///
/// # Errors
/// [`Error::Size`] if a side is zero or too long, or the area too large.
pub fn check_size(width: u64, height: u64) -> Result<usize> {
    let fits = |side: u64| (1..=u64::from(MAX_SIDE)).contains(&side);
    if !fits(width) || !fits(height) || width * height > MAX_TEXELS {
        return Err(Error::Size { width, height });
    }
    Ok((width * height) as usize)
}

impl<T> Grid<T> {
    /// Wraps texels in row-major order.
    ///
    /// # Errors
    /// [`Error::Size`] for an impossible size, [`Error::Length`] if `texels` does not fill it.
    pub fn new(width: u32, height: u32, texels: Vec<T>) -> Result<Self> {
        let expected = check_size(width.into(), height.into())?;
        if texels.len() != expected {
            return Err(Error::Length { what: "texels", expected, actual: texels.len() });
        }
        Ok(Self { width, height, texels })
    }

    /// A grid whose texel at (x, y) is `f(x, y)`.
    ///
    /// # Errors
    /// [`Error::Size`] for an impossible size.
    pub fn from_fn(width: u32, height: u32, mut f: impl FnMut(u32, u32) -> T) -> Result<Self> {
        let mut texels = Vec::with_capacity(check_size(width.into(), height.into())?);
        for y in 0..height {
            texels.extend((0..width).map(|x| f(x, y)));
        }
        Ok(Self { width, height, texels })
    }

    /// Width in texels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in texels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Width and height in texels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// All texels, row-major.
    pub fn texels(&self) -> &[T] {
        &self.texels
    }

    /// All texels, row-major, to be written.
    pub fn texels_mut(&mut self) -> &mut [T] {
        &mut self.texels
    }

    /// Takes the texels out, row-major.
    pub fn into_texels(self) -> Vec<T> {
        self.texels
    }

    /// Row `y`, left to right.
    ///
    /// # Panics
    /// If `y` is not below the height.
    pub fn row(&self, y: u32) -> &[T] {
        let w = self.width as usize;
        &self.texels[y as usize * w..][..w]
    }

    /// The rows from the top.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, T> {
        self.texels.chunks_exact(self.width as usize)
    }

    /// The texel at (x, y), or `None` outside.
    pub fn get(&self, x: u32, y: u32) -> Option<&T> {
        (x < self.width && y < self.height).then(|| &self.texels[self.offset(x, y)])
    }

    /// A grid of the same size whose texels are `f(texel)`.
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Grid<U> {
        Grid { width: self.width, height: self.height, texels: self.texels.iter().map(f).collect() }
    }

    /// Fails unless `other` has this grid's size.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] naming both sizes; `what` says what `other` is.
    pub fn expect_same_size<U>(&self, what: &'static str, other: &Grid<U>) -> Result<()> {
        if self.size() == other.size() {
            return Ok(());
        }
        Err(Error::SizeMismatch { what, expected: self.size(), actual: other.size() })
    }

    fn offset(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }
}

impl<T: Clone> Grid<T> {
    /// A grid with the same value everywhere.
    ///
    /// # Errors
    /// [`Error::Size`] for an impossible size.
    pub fn filled(width: u32, height: u32, value: T) -> Result<Self> {
        let len = check_size(width.into(), height.into())?;
        Ok(Self { width, height, texels: vec![value; len] })
    }
}

impl<T> std::ops::Index<(u32, u32)> for Grid<T> {
    type Output = T;

    fn index(&self, (x, y): (u32, u32)) -> &T {
        assert!(x < self.width && y < self.height, "texel ({x}, {y}) is outside {} × {}", self.width, self.height);
        &self.texels[self.offset(x, y)]
    }
}

impl<T> std::ops::IndexMut<(u32, u32)> for Grid<T> {
    fn index_mut(&mut self, (x, y): (u32, u32)) -> &mut T {
        assert!(x < self.width && y < self.height, "texel ({x}, {y}) is outside {} × {}", self.width, self.height);
        let offset = self.offset(x, y);
        &mut self.texels[offset]
    }
}

/// What a map continues with beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Edges {
    /// The map repeats: a tiling texture.
    #[default]
    Wrap,
    /// The border texel goes on for ever.
    Clamp,
    /// The map is mirrored at its border; the border texel is not doubled twice (… 1 0 | 0 1 … n−1 | n−1 n−2 …).
    Mirror,
}

impl Edges {
    /// The texel inside `0..len` that stands for position `i`.
    ///
    /// # Panics
    /// If `len` is zero.
    pub fn resolve(self, i: i64, len: u32) -> u32 {
        assert!(len > 0, "a grid is never empty");
        let n = i64::from(len);
        let inside = match self {
            Self::Wrap => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let m = i.rem_euclid(2 * n);
                if m < n { m } else { 2 * n - 1 - m }
            }
        };
        inside as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_refuses_wrong_length_and_empty() {
        assert_eq!(Grid::new(2, 2, vec![0u8; 3]), Err(Error::Length { what: "texels", expected: 4, actual: 3 }));
        assert_eq!(Grid::<u8>::new(0, 2, vec![]), Err(Error::Size { width: 0, height: 2 }));
        assert!(check_size(u64::MAX, u64::MAX).is_err());
        assert!(check_size(65_536, 65_536).is_err());
    }

    #[test]
    fn from_fn_is_row_major_from_the_top() {
        let g = Grid::from_fn(3, 2, |x, y| 10 * y + x).unwrap();
        assert_eq!(g.texels(), [0, 1, 2, 10, 11, 12]);
        assert_eq!(g[(2, 1)], 12);
        assert_eq!(g.row(1), [10, 11, 12]);
        assert_eq!(g.get(3, 0), None);
    }

    #[test]
    fn edges_resolve_far_outside() {
        let seen = |e: Edges| (-4..7).map(|i| e.resolve(i, 3)).collect::<Vec<_>>();
        assert_eq!(seen(Edges::Wrap), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(seen(Edges::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(seen(Edges::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(Edges::Mirror.resolve(i64::from(i32::MIN), 1), 0);
    }
}
