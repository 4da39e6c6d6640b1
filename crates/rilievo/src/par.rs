//! The one place that knows whether rayon is there.
//!
//! Work is cut into the same pieces either way, so results do not depend on the feature or on the thread count.

/// Calls `f(row_index, row)` for each `width`-long row of `data`.
#[cfg(feature = "rayon")]
pub fn for_each_row<T: Send>(data: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    use rayon::prelude::*;
    data.par_chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// Calls `f(row_index, row)` for each `width`-long row of `data`.
#[cfg(not(feature = "rayon"))]
pub fn for_each_row<T: Send>(data: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    data.chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// `f(0), f(1) … f(n − 1)`, in that order.
#[cfg(feature = "rayon")]
pub fn map_range<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    (0..n).into_par_iter().map(f).collect()
}

/// `f(0), f(1) … f(n − 1)`, in that order.
#[cfg(not(feature = "rayon"))]
pub fn map_range<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    (0..n).map(f).collect()
}

/// Sorts values whose equals cannot be told apart, so that the result does not depend on the method.
#[cfg(feature = "rayon")]
pub fn sort_unstable<T: Ord + Send>(values: &mut [T]) {
    use rayon::prelude::*;
    values.par_sort_unstable();
}

/// Sorts values whose equals cannot be told apart, so that the result does not depend on the method.
#[cfg(not(feature = "rayon"))]
pub fn sort_unstable<T: Ord + Send>(values: &mut [T]) {
    values.sort_unstable();
}
