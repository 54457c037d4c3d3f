//! Groups spread over cores.

/// Calls `work` with the number and the part of every group: parts of `len` numbers, the last one may be shorter.
///
/// Parts are the same on any number of threads, and so are the bits in them.
pub(super) fn for_each_part<T: Send>(out: &mut [T], len: usize, work: impl Fn(usize, &mut [T]) + Sync + Send) {
    if len == 0 {
        return;
    }
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::{IndexedParallelIterator, ParallelIterator, ParallelSliceMut};
        out.par_chunks_mut(len).enumerate().for_each(|(index, part)| work(index, part));
    }
    #[cfg(not(feature = "rayon"))]
    out.chunks_mut(len).enumerate().for_each(|(index, part)| work(index, part));
}

/// What `of` makes of every number below `count`, in their order.
pub(super) fn for_each<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::{IntoParallelIterator, ParallelIterator};
        (0..count).into_par_iter().map(of).collect()
    }
    #[cfg(not(feature = "rayon"))]
    (0..count).map(of).collect()
}
