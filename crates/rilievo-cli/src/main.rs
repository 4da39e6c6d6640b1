//! The rilievo program.
fn main() {}
