//! Light and half vectors that are interpolated over triangles instead of computed by the pixel.
//!
//! At a vertex the direction to the light and the half vector are turned into the frame of the surface ([`Rotated`]: L'
//! and H'), so that a pixel needs no frame: its tangent-space normal is multiplied with the interpolated vectors as
//! it comes from the map. How the vectors get from the vertices to the pixel is the method:
//!
//! - linear ([`Linear`]): one sample per vertex; vectors become too short between them;
//! - normalised: the same, divided by its length, whose square is a quadratic polynomial ([`Quadratic::squared_length`]);
//! - quadratic ([`Quadratic`]): six samples, at the vertices and at the [`Midpoints`] of the edges, and no division.
//!
//! All polynomials are over the screen, as in the source, not over the surface: they are not perspective-correct.
//!
//! - **Source:** Hast, Barrera, Bengtsson, "Improved Bump Mapping by using Quadratic Vector Interpolation"; Duff 1979 for
//!   the normalised method; Abbas et al. 2001 for the setup on the actual triangle.

mod frames;
mod order;
mod six_point;

pub use frames::{Corner, Midpoints, Rotated, Viewer};
pub use order::Order;
pub use six_point::{Linear, Quadratic, Sides, SixSamples, ToNormalized, Value};
