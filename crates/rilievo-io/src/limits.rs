//! What a file may cost before it is refused.

use crate::error::{Error, Result};

/// Upper bounds that untrusted files are held to, checked before anything is allocated.
///
/// The largest map they admit (2^28 texels, 16 384 × 16 384) takes 3 GiB as a normal map of floats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The longest side of a picture or map, in texels.
    pub max_side: u32,
    /// The largest area of a picture or map, in texels.
    pub max_texels: u64,
    /// The longest file, in bytes.
    pub max_file_bytes: u64,
    /// The most vertices of a mesh.
    pub max_vertices: usize,
    /// The most triangles of a mesh.
    pub max_triangles: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Limits {
    /// The limits by default.
    pub const DEFAULT: Self = Self {
        max_side: 65_536,
        max_texels: 1 << 28,
        max_file_bytes: 8 << 30,
        max_vertices: 1 << 26,
        max_triangles: 1 << 27,
    };

    /// Checks a picture's size before anything is allocated for it; returns the number of texels.
    pub(crate) fn check_size(&self, name: &str, width: u64, height: u64) -> Result<usize> {
        if width == 0 || height == 0 {
            return Err(Error::format(name, "header", format!("the size {width} × {height} is empty")));
        }
        let what = || format!("a size of {width} × {height}");
        if width.max(height) > u64::from(self.max_side) {
            return Err(Error::limits(name, what(), format!("{} texels a side", self.max_side)));
        }
        // Below 2^32 each, so the product cannot overflow.
        if width * height > self.max_texels {
            return Err(Error::limits(name, what(), format!("{} texels", self.max_texels)));
        }
        rilievo::grid::check_size(width, height).map_err(|e| Error::invalid(name, e))
    }
}

/// Refuses a file that declares more data than its bytes can hold: compression has a highest possible ratio, so a
/// huge size in the header of a small file is a lie, found here before memory is spent on it.
pub(crate) fn check_plausible(name: &str, declared: u64, stored: u64, max_ratio: u64) -> Result<()> {
    // Headers and the first bytes of a stream cost a little; 1 KiB is on the safe side.
    if declared / max_ratio > stored + 1024 {
        let reason = format!(
            "the header promises {declared} bytes of texels, which {stored} bytes of compressed data cannot hold; \
             the file is cut short or forged"
        );
        return Err(Error::format(name, "header", reason));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_refused_by_side_area_and_emptiness() {
        let limits = Limits { max_side: 100, max_texels: 1000, ..Limits::default() };
        assert_eq!(limits.check_size("a", 100, 10).unwrap(), 1000);
        assert!(matches!(limits.check_size("a", 101, 1), Err(Error::Limits { .. })));
        assert!(matches!(limits.check_size("a", 100, 11), Err(Error::Limits { .. })));
        assert!(matches!(limits.check_size("a", 0, 11), Err(Error::Format { .. })));
        assert!(matches!(Limits::default().check_size("a", 1 << 31, 1 << 31), Err(Error::Limits { .. })));
        assert!(check_plausible("a", 1 << 30, 10_000, 1032).is_err());
        assert!(check_plausible("a", 1 << 20, 100, 1032).is_ok());
    }
}
