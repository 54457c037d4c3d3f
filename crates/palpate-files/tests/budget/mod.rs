//! What a reader may take of the processor and of memory for what it is given: shared by the tests of bad files and by the fuzz targets.
//!
//! The numbers are those of an unoptimised build that is watched; `docs/guides/file-formats.md` has those of an optimised one.

use std::{
    fs,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Held while memory is measured, which is that of all threads.
static MEASURED: Mutex<()> = Mutex::new(());

/// Memory that may be taken whatever is given (64 MiB).
pub(crate) const MEMORY_AT_LEAST: usize = 64 << 20;

/// Memory that may be taken for every byte.
pub(crate) const MEMORY_A_BYTE: usize = 64;

/// Processor time that may be taken whatever is given: what unpacks to 16 MiB may be small.
pub(crate) const TIME_AT_LEAST: Duration = Duration::from_secs(10);

/// Processor time that may be taken for every byte: 20 s for a MiB.
pub(crate) const TIME_A_BYTE: Duration = Duration::from_micros(20);

/// What was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Taken {
    pub(crate) time: Duration,
    pub(crate) memory: usize,
}

/// Processor time of this thread, of which a busy machine takes nothing; the time on the wall where the system does not state it.
fn time() -> Duration {
    static START: Mutex<Option<Instant>> = Mutex::new(None);
    let stated = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = stated.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(
        || START.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(Instant::now).elapsed(),
        Duration::from_nanos,
    )
}

/// What `read` gives, and what it takes.
pub(crate) fn measured<T>(read: impl FnOnce() -> T) -> (T, Taken) {
    let _alone = MEASURED.lock().unwrap_or_else(PoisonError::into_inner);
    let (before, began) = (MEMORY.current_usage(), time());
    MEMORY.reset_peak_usage();
    let result = read();
    let taken = Taken {
        time: time().saturating_sub(began),
        memory: MEMORY.peak_usage().saturating_sub(before),
    };
    (result, taken)
}

/// What `read` gives of `size` bytes, if it takes no more than they warrant.
pub(crate) fn bounded<T>(size: usize, read: impl FnOnce() -> T) -> T {
    let (result, Taken { time, memory }) = measured(read);
    let most = MEMORY_AT_LEAST.saturating_add(MEMORY_A_BYTE.saturating_mul(size));
    assert!(memory <= most, "{} KiB of memory for a file of {size} bytes", memory >> 10);
    let most = TIME_AT_LEAST + TIME_A_BYTE * u32::try_from(size).unwrap_or(u32::MAX);
    assert!(time <= most, "{} ms of processor time for a file of {size} bytes", time.as_millis());
    result
}
