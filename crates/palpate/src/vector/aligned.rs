//! Numbers that begin where a cache line does.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line, and of the widest vector: one that lies across two lines costs two loads.
const LINE: usize = 64;

/// A column of fixed length that begins at a cache line.
#[derive(Debug, Default)]
pub(crate) struct Aligned {
    numbers: Vec<f64>,
    from: usize,
    len: usize,
}

impl Aligned {
    /// `len` zeros.
    pub(crate) fn zeros(len: usize) -> Self {
        let numbers = vec![0.0; len + LINE / size_of::<f64>()];
        // Where nothing is known about addresses this is as good as any other place.
        let from = numbers.as_ptr().align_offset(LINE).min(numbers.len() - len);
        Self { numbers, from, len }
    }
}

impl Deref for Aligned {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.numbers[self.from..self.from + self.len]
    }
}

impl DerefMut for Aligned {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.numbers[self.from..self.from + self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_begin_at_a_cache_line_whatever_their_length() {
        for len in [0, 1, 7, 8, 100] {
            let mut column = Aligned::zeros(len);
            column.fill(1.5);
            assert_eq!(*column, vec![1.5; len]);
            assert_eq!(column.as_ptr() as usize % LINE, 0);
        }
    }
}
