//! The one place that knows whether rayon is there.
//!
//! Work is cut into the same pieces either way, so results do not depend on the feature or on the thread count.
//!
//! Without rayon each piece is a call of a function of its own, and so it should be wherever a loop goes over all texels: an
//! engine of WebAssembly begins with code that was compiled in a hurry, and comes to the good one at the next call only.

#[cfg(not(feature = "rayon"))]
use std::ops::Range;

/// Calls `f(row_index, row)` for each `width`-long row of `data`.
#[cfg(feature = "rayon")]
pub fn for_each_row<T: Send>(data: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    use rayon::prelude::*;
    data.par_chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// Calls `f(row_index, row)` for each `width`-long row of `data`.
#[cfg(not(feature = "rayon"))]
pub fn for_each_row<T: Send>(data: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    #[inline(never)]
    fn one<T>(y: usize, row: &mut [T], f: &impl Fn(usize, &mut [T])) {
        f(y, row);
    }
    data.chunks_mut(width).enumerate().for_each(|(y, row)| one(y, row, &f));
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
    #[inline(never)]
    fn some<T>(all: &mut Vec<T>, run: Range<usize>, f: &impl Fn(usize) -> T) {
        all.extend(run.map(f));
    }
    let mut all = Vec::with_capacity(n);
    let run = n.div_ceil(64).max(1);
    (0..n).step_by(run).for_each(|first| some(&mut all, first..n.min(first + run), &f));
    all
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

/// Rows of three arrays that belong together: calls `f(row_index, (row_a, row_b, row_c))`, rows `widths` long.
#[cfg(feature = "rayon")]
pub(crate) fn for_each_row3<A: Send, B: Send, C: Send>(
    (a, b, c): (&mut [A], &mut [B], &mut [C]),
    widths: [usize; 3],
    f: impl Fn(usize, (&mut [A], &mut [B], &mut [C])) + Sync + Send,
) {
    use rayon::prelude::*;
    let rows = a.par_chunks_mut(widths[0]).zip(b.par_chunks_mut(widths[1])).zip(c.par_chunks_mut(widths[2]));
    rows.enumerate().for_each(|(y, ((a, b), c))| f(y, (a, b, c)));
}

/// Rows of three arrays that belong together: calls `f(row_index, (row_a, row_b, row_c))`, rows `widths` long.
#[cfg(not(feature = "rayon"))]
pub(crate) fn for_each_row3<A: Send, B: Send, C: Send>(
    (a, b, c): (&mut [A], &mut [B], &mut [C]),
    widths: [usize; 3],
    f: impl Fn(usize, (&mut [A], &mut [B], &mut [C])) + Sync + Send,
) {
    let rows = a.chunks_mut(widths[0]).zip(b.chunks_mut(widths[1])).zip(c.chunks_mut(widths[2]));
    rows.enumerate().for_each(|(y, ((a, b), c))| f(y, (a, b, c)));
}
