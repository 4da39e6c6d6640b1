//! Interpolated light vectors on tori: how long they are, and how near their pictures are to exact ones.
#![expect(clippy::unwrap_used, reason = "test helpers fail loudly")]

mod lengths;
mod pictures;
mod scene;
