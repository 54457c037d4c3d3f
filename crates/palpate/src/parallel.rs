//! The same work on many things, on all cores where there are threads.

/// What `of` makes of every number below `count`, in their order.
pub(crate) fn for_each<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::{IntoParallelIterator, ParallelIterator};
        (0..count).into_par_iter().map(of).collect()
    }
    #[cfg(not(feature = "rayon"))]
    (0..count).map(of).collect()
}

/// What two pieces of work return, side by side where there are threads.
#[cfg(feature = "std")]
pub(crate) fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(feature = "rayon")]
    {
        rayon::join(a, b)
    }
    #[cfg(not(feature = "rayon"))]
    (a(), b())
}
