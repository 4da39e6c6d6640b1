//! The reference renderer (owned by the lead).
