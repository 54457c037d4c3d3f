//! How much memory bad files take.

use peak_alloc::PeakAlloc;

use crate::{any_file, corpus};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What a reader may take whatever it is given.
const AT_LEAST: usize = 64 << 20;

/// What it may take for every byte of the file.
const A_BYTE: usize = 64;

// Other tests of this binary take memory too where they run in the same process: they count, and are small.
#[test]
fn no_file_takes_more_memory_than_its_size_warrants() {
    for example in corpus::all() {
        let file = example.file();
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        match example.kind {
            Some(_) => drop(any_file::read_all(example.name(), &file)),
            None => drop(example.read()),
        }
        let taken = MEMORY.peak_usage().saturating_sub(before);
        assert!(taken <= AT_LEAST + A_BYTE * file.len(), "{}: {} KiB", example.place, taken >> 10);
    }
}
