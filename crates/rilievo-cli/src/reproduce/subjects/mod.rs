//! What is measured and drawn: made by code, nothing from files.

mod dense;
mod easel;
mod pictures;
mod specimens;
mod surroundings;
mod torus;
mod vase;

pub(crate) use dense::dense;
pub(crate) use easel::Easel;
pub(crate) use pictures::{Shown, crop, difference, psnr_of_covered, shoot};
pub(crate) use specimens::{Frame, Specimen};
pub(crate) use surroundings::surroundings;
pub(crate) use torus::{METHODS, Torus, VIEWS, Way, flat_shaded, quadratic};
pub(crate) use vase::{Cover, Vase};
