//! How far a reader has got.

use std::{
    io::{self, Read, Seek, SeekFrom},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

/// Bytes read so far, seen from outside.
#[derive(Debug, Clone, Default)]
pub(super) struct Count(Arc<AtomicU64>);

impl Count {
    pub(super) fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// A reader whose progress can be seen from outside.
#[derive(Debug)]
pub(super) struct Counting<R> {
    inner: R,
    count: Count,
}

impl<R> Counting<R> {
    pub(super) fn of(inner: R) -> Self {
        Self {
            inner,
            count: Count::default(),
        }
    }

    pub(super) fn count(&self) -> Count {
        self.count.clone()
    }
}

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let got = self.inner.read(into)?;
        self.count.0.fetch_add(got as u64, Ordering::Relaxed);
        Ok(got)
    }
}

impl<R: Seek> Seek for Counting<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}
