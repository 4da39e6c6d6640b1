//! What a file may cost before it is refused.

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
        Self {
            max_side: 65_536,
            max_texels: 1 << 28,
            max_file_bytes: 8 << 30,
            max_vertices: 1 << 26,
            max_triangles: 1 << 27,
        }
    }
}
