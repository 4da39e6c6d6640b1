//! Surfaces: meshes, their frames, built-in shapes, the camera, and maps bent onto meshes.

mod camera;
mod deflect;
mod frame;
mod mesh;
pub mod shapes;

pub use camera::Camera;
pub use deflect::{Deflect, Deflected, MAX_GUTTER, deflect_heights, deflect_normals};
pub use frame::Frame;
pub use mesh::{Mesh, MeshParts};
