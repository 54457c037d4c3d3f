//! Many pieces of work over threads, each of which hears that the whole is to end.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use palpate::watch::{Cancelled, Progress, Watch};

use crate::JobError;

/// How often the watch hears of the progress.
const LOOK: Duration = Duration::from_millis(50);

/// The watch of one thread: it says how far that is, and hears whether it is to end.
#[derive(Clone, Copy)]
pub(crate) struct Share<'a> {
    stop: &'a AtomicBool,
    done: &'a AtomicU64,
}

impl Share<'_> {
    /// So much more is done.
    pub(crate) fn advance(&self, more: u64) -> Result<(), Cancelled> {
        self.done.fetch_add(more, Ordering::Relaxed);
        if self.stop.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}

impl Watch for Share<'_> {
    fn report(&mut self, _: Progress<'_>) -> Result<(), Cancelled> {
        self.advance(0)
    }
}

/// Does the pieces with indices below `count` over threads, all processors if it is not stated how many, and returns what came of them in
/// their order. `progress` is where the whole stands at the beginning. The first error ends all.
pub(crate) fn over_threads<T: Send>(
    count: usize,
    threads: Option<NonZeroUsize>,
    progress: Progress<'_>,
    watch: &mut dyn Watch,
    work: impl Fn(usize, Share<'_>) -> Result<T, JobError> + Sync,
) -> Result<Vec<T>, JobError> {
    let threads = threads.or_else(|| thread::available_parallelism().ok()).map_or(1, usize::from);
    let (next, stop, done) = (AtomicUsize::new(0), AtomicBool::new(false), AtomicU64::new(progress.done));
    let share = Share {
        stop: &stop,
        done: &done,
    };
    let mut made: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let mut failed: Option<JobError> = None;
    let (sender, results) = channel();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, count.max(1)) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                while share.advance(0).is_ok() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    // The receiver lives as long as the threads do.
                    let _ = sender.send((index, work(index, share)));
                }
            });
        }
        drop(sender);
        loop {
            let done = done.load(Ordering::Relaxed);
            let heard = watch.report(Progress { done, ..progress }).map_err(JobError::from);
            let error = match results.recv_timeout(LOOK) {
                Ok((index, Ok(piece))) => {
                    made[index] = Some(piece);
                    heard.err()
                }
                Ok((_, Err(error))) => heard.err().or(Some(error)),
                Err(RecvTimeoutError::Timeout) => heard.err(),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if let Some(error) = error {
                stop.store(true, Ordering::Relaxed);
                failed.get_or_insert(error);
            }
        }
    });
    match failed {
        Some(error) => Err(error),
        None => Ok(made.into_iter().flatten().collect()),
    }
}
