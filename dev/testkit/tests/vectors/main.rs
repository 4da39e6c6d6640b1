//! Interpolated light vectors on tori: how long they are, and how near their pictures are to exact ones.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "tests fail loudly and tell their figures")]

mod lengths;
mod pictures;
mod scene;
