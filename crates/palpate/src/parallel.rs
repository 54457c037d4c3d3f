//! The same work on many things, on all cores where there are threads.

#[cfg(feature = "rayon")]
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// The threads that work is spread over.
#[derive(Clone, Copy, Default)]
pub(crate) struct Threads<'a> {
    /// The calling thread and those of this pool; without it those of the pool that the calling thread is of, or of the process.
    #[cfg(feature = "rayon")]
    pub(crate) pool: Option<&'a rayon::ThreadPool>,
    /// Whether they have just worked: to wake one takes longer than a step of ten thousand contacts.
    pub(crate) are_awake: bool,
    #[cfg(not(feature = "rayon"))]
    none: std::marker::PhantomData<&'a ()>,
}

#[cfg(feature = "rayon")]
impl Threads<'_> {
    /// How many there are.
    pub(crate) fn count(self) -> usize {
        self.pool.map_or_else(rayon::current_num_threads, rayon::ThreadPool::current_num_threads)
    }

    /// What `work` makes of every part, in their order; the first part is the calling thread's.
    ///
    /// The calling thread does not leave its processor: parts may take microseconds, and a thread that sleeps is woken late.
    pub(crate) fn map<T: Send, R: Send>(self, parts: Vec<T>, work: &(impl Fn(T) -> R + Sync)) -> Vec<R> {
        let mut results: Vec<Option<R>> = parts.iter().map(|_| None).collect();
        let under_way = AtomicUsize::new(parts.len().saturating_sub(1));
        match self.pool {
            None => rayon::in_place_scope(|scope| share(scope, &mut results, parts, work, &under_way)),
            Some(pool) => pool.in_place_scope(|scope| share(scope, &mut results, parts, work, &under_way)),
        }
        results.into_iter().flatten().collect()
    }
}

/// Gives all parts but the first to other threads, works on the first, and waits.
#[cfg(feature = "rayon")]
fn share<'scope, T: Send + 'scope, R: Send>(
    scope: &rayon::Scope<'scope>,
    results: &'scope mut [Option<R>],
    parts: Vec<T>,
    work: &'scope (impl Fn(T) -> R + Sync),
    under_way: &'scope AtomicUsize,
) {
    /// How often to look whether the others are done before this thread sleeps: for some 50 us.
    const LOOKS: u32 = 2000;

    let mut pairs = results.iter_mut().zip(parts);
    let own = pairs.next();
    for (result, part) in pairs {
        scope.spawn(move |_| {
            *result = Some(work(part));
            under_way.fetch_sub(1, Ordering::Release);
        });
    }
    if let Some((result, part)) = own {
        *result = Some(work(part));
    }
    for _ in 0..LOOKS {
        if under_way.load(Ordering::Acquire) == 0 {
            break;
        }
        std::hint::spin_loop();
    }
}

#[cfg(not(feature = "rayon"))]
impl Threads<'_> {
    /// How many there are.
    pub(crate) fn count(self) -> usize {
        1
    }

    /// What `work` makes of every part, in their order.
    pub(crate) fn map<T, R>(self, parts: Vec<T>, work: &impl Fn(T) -> R) -> Vec<R> {
        parts.into_iter().map(work).collect()
    }
}

#[cfg(all(test, feature = "rayon"))]
mod tests {
    use super::*;

    #[test]
    fn results_of_parts_are_in_their_order_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let square = |part: usize| {
                // The first ones end last.
                (0..20_000 * (9 - part)).for_each(|_| std::hint::spin_loop());
                part * part
            };
            let expected: Vec<usize> = (0..9).map(|part| part * part).collect();
            let beside = Threads {
                pool: Some(&pool),
                are_awake: true,
            };
            assert_eq!((beside.count(), beside.map((0..9).collect(), &square)), (threads, expected.clone()));
            assert_eq!(pool.install(|| Threads::default().map((0..9).collect(), &square)), expected);
            assert!(beside.map(Vec::<usize>::new(), &square).is_empty());
        }
    }
}
