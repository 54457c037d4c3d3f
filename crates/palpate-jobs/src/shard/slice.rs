//! Which files, and which tests of them, a slice of a batch has.
//!
//! The files lie end to end in their order, each as long as its bytes, and every slice has the same length. A test of a file with m tests
//! is at its share of the file: slice k takes the tests whose middle is in it. So a file with one test is in one slice, and one with many
//! is divided where slices meet. Only names and sizes decide: every process finds the same slices, in whatever order they run.

use std::ops::Range;

use sha2::{Digest, Sha256};

use super::Shard;
use crate::JobError;
use crate::input::NamedFile;
use crate::output::hexadecimal;

/// The files of one slice of a batch.
#[derive(Debug, Clone)]
pub struct Slice {
    /// Its number, and how many there are.
    pub shard: Shard,
    /// Digest of the names and sizes of all files of the batch, and of how many slices they make.
    pub plan_sha256: String,
    /// How many files the batch has.
    pub total: usize,
    /// The index of the first of its files among them.
    pub first: usize,
    /// Its files, in order.
    pub files: Vec<NamedFile>,
    /// Share of the first file at which it begins.
    pub start: f64,
    /// Share of the last file at which it ends.
    pub end: f64,
}

impl Slice {
    /// The slices with these numbers, of all that the files make.
    ///
    /// # Errors
    /// [`JobError`] for standard input, which no two processes can read.
    pub fn of(files: &[NamedFile], shards: impl IntoIterator<Item = Shard>) -> Result<Vec<Self>, JobError> {
        if let Some(input) = files.iter().find(|file| file.is_standard_input()) {
            let message = "expected files, found standard input, which no other shard can read";
            return Err(JobError::option(message, "name the files").of(input.name().display()));
        }
        // Of equal length where nothing is known.
        let ends: Vec<u128> = files
            .iter()
            .scan(0, |end, file| {
                *end += u128::from(file.size().max(1));
                Some(*end)
            })
            .collect();
        let mut digest = Sha256::new();
        for (file, end) in files.iter().zip(&ends) {
            digest.update(file.name().as_os_str().as_encoded_bytes());
            digest.update([0]);
            digest.update(end.to_le_bytes());
        }
        let plan = hexadecimal(digest.finalize());
        Ok(shards.into_iter().map(|shard| Self::between(files, &ends, &plan, shard)).collect())
    }

    fn between(files: &[NamedFile], ends: &[u128], plan: &str, shard: Shard) -> Self {
        let of = u128::from(shard.of());
        let total = ends.last().copied().unwrap_or(0);
        // Multiplied by the number of slices, so that the places between them are whole.
        let (from, to) = (total * u128::from(shard.number() - 1), total * u128::from(shard.number()));
        let start_of = |index: usize| if index == 0 { 0 } else { ends[index - 1] * of };
        let first = ends.partition_point(|end| end * of <= from);
        let last = (0..ends.len()).collect::<Vec<_>>().partition_point(|index| start_of(*index) < to);
        let share = |index: usize, place: u128| {
            let (start, end) = (start_of(index), ends[index] * of);
            (place.clamp(start, end) - start) as f64 / (end - start) as f64
        };
        let is_empty = first >= last;
        Self {
            shard,
            plan_sha256: plan.to_owned(),
            total: files.len(),
            first,
            files: files.get(first..last).unwrap_or_default().to_vec(),
            start: if is_empty { 0.0 } else { share(first, from) },
            end: if is_empty { 1.0 } else { share(last - 1, to) },
        }
    }

    /// Which of the tests of one of its files are its own.
    pub(crate) fn tests(&self, index: usize, count: usize) -> Range<usize> {
        let at = |share: f64| (share * count as f64).round() as usize;
        let start = if index == 0 { at(self.start) } else { 0 };
        let end = if index + 1 == self.files.len() { at(self.end) } else { count };
        start..end.max(start)
    }

    /// Whether it has a file with another slice, at its start and at its end.
    pub(crate) fn divides(&self) -> [bool; 2] {
        let any = !self.files.is_empty();
        [any && self.start > 0.0, any && self.end < 1.0]
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn files(sizes: &[usize]) -> Vec<NamedFile> {
        let file = |(index, size): (usize, &usize)| {
            NamedFile::Bytes(PathBuf::from(format!("{index}.csv")), vec![0; *size].into())
        };
        sizes.iter().enumerate().map(file).collect()
    }

    /// The tests of every slice, by file and number.
    fn divided(sizes: &[usize], tests: &[usize], of: u32) -> Vec<Vec<(usize, usize)>> {
        let slices = Slice::of(&files(sizes), Shard::all(of).unwrap()).unwrap();
        let of_slice = |slice: &Slice| {
            let own = |index: usize| {
                slice.tests(index, tests[slice.first + index]).map(move |test| (slice.first + index, test))
            };
            (0..slice.files.len()).flat_map(own).collect()
        };
        slices.iter().map(of_slice).collect()
    }

    #[test]
    fn every_test_is_in_one_slice_in_order() {
        let sizes = [100, 1, 0, 9_000, 50, 50, 3_000, 2];
        let tests = [1, 1, 1, 400, 1, 7, 1, 2];
        let all: Vec<(usize, usize)> =
            (0..sizes.len()).flat_map(|file| (0..tests[file]).map(move |test| (file, test))).collect();
        for of in [1, 2, 3, 5, 8, 13, 40, 977] {
            assert_eq!(divided(&sizes, &tests, of).concat(), all, "{of} slices");
        }
        assert_eq!(divided(&[], &[], 3), [[], [], []]);
    }

    #[test]
    fn slices_are_equal_to_half_a_test() {
        // One file of many tests and many files of one test, with the same bytes a test.
        let slices = divided(&[1_000, 10, 10, 10, 970], &[100, 1, 1, 1, 97], 8);
        let sizes: Vec<usize> = slices.iter().map(Vec::len).collect();
        assert_eq!(sizes, [25; 8]);
    }

    #[test]
    fn a_plan_depends_on_names_sizes_and_their_order() {
        let plan = |files: &[NamedFile]| Slice::of(files, Shard::all(2).unwrap()).unwrap()[0].plan_sha256.clone();
        let (one, other) = (files(&[1, 2]), files(&[1, 3]));
        let turned: Vec<NamedFile> = one.iter().rev().cloned().collect();
        assert_eq!(plan(&one), plan(&one.clone()));
        assert!(plan(&one) != plan(&other) && plan(&one) != plan(&turned));
    }
}
