//! The greater and the lesser of two numbers, in one instruction.

/// The greater of two that can be compared. Not `max`: what that makes of NaN takes a second instruction, and a call where
/// processors have none for it, as in WebAssembly.
#[inline(always)]
pub(crate) fn greater<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The lesser of two that can be compared, as [`greater`].
#[inline(always)]
pub(crate) fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}
