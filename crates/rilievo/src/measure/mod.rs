//! Errors of normal maps in angles, and of pictures in the usual measures (contract; the owner of this folder completes it).
mod angle;
mod flip;
mod picture;
pub use angle::{AngleStats, angle_stats};
pub use flip::flip_mean;
pub use picture::{PictureStats, picture_stats};
