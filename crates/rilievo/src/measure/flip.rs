//! LDR-FLIP.
use crate::Result;
use crate::color::Picture;
/// Mean LDR-FLIP.
///
/// # Errors
/// x
pub fn flip_mean(reference: &Picture, other: &Picture, pixels_per_degree: f32) -> Result<f64> {
    let _ = (reference, other, pixels_per_degree);
    Ok(0.0)
}
