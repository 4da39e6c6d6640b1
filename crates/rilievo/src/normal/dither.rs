//! Dithering normals to 8 bits.
use super::*;
use crate::grid::Edges;
/// x
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DitherU8 {
    /// Round to nearest.
    #[default]
    None,
    /// Ordered.
    Ordered,
    /// Error diffusion.
    Diffusion,
}
/// x
pub fn encode_map_u8<S: Space>(map: &NormalMap<S>, _dither: DitherU8) -> Grid<[u8; 3]> {
    let _ = Edges::Wrap;
    map.map(|n| encode_u8(*n))
}
