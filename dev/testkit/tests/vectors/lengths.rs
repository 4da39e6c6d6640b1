//! How far from unit length interpolated vectors are.
