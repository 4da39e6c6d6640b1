//! Errors of normal maps in angles, and of pictures in the usual measures.

mod angle;
mod angle_sums;
mod flip;
mod picture;

pub use angle::{AngleStats, angle_stats};
pub(crate) use angle::{angle_of_chord, weighted_angle_stats};
pub(crate) use angle_sums::AngleSums;
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, flip_map, flip_mean};
pub use picture::{PictureStats, picture_stats};
