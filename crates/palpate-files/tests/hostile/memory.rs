//! How much memory bad files take.

use std::sync::{Mutex, PoisonError};

use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Held while memory is measured, which is that of all threads.
static MEASURED: Mutex<()> = Mutex::new(());

/// What a reader may take whatever it is given (64 MiB).
const AT_LEAST: usize = 64 << 20;

/// What it may take for every byte of the file.
const A_BYTE: usize = 64;

/// What `read` gives of a file of `size` bytes, if it takes no more memory than that warrants.
pub(crate) fn bounded<T>(size: usize, read: impl FnOnce() -> T) -> T {
    let _alone = MEASURED.lock().unwrap_or_else(PoisonError::into_inner);
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let result = read();
    let taken = MEMORY.peak_usage().saturating_sub(before);
    assert!(taken <= AT_LEAST + A_BYTE * size, "{} KiB of memory for a file of {size} bytes", taken >> 10);
    result
}

#[test]
#[should_panic(expected = "KiB of memory for a file of 10 bytes")]
fn memory_is_measured() {
    let room = bounded(10, || Vec::<u8>::with_capacity(AT_LEAST + 1024));
    assert!(room.is_empty());
}
