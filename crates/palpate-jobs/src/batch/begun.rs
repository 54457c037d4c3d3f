//! What a process had begun when it ended without a word: a test that ends its process whenever it is analysed is passed over.
//!
//! Every step of a file is noted before it is done: step 0 opens the file, step j + 1 analyses its test j. The first process after one that
//! was killed analyses what that had begun and not ended, each alone; a step with which a process ended in company and twice alone is a
//! failure like others. What was cancelled ended by itself.
//!
//! A process may also have been killed from outside, and a step is not to blame for that. So a step waits before it is done alone, the
//! second time longer: whatever kills at fixed or random times would have to meet a step of milliseconds behind two different waits. It may meet
//! one of many seconds, so such a failure does not last: when the shard runs again, the step is tried again.
//!
//! The notes lie among the pieces of a store, under keys alone: `run 2`, `begun 2 FILE STEP`, `alone 2 FILE STEP`, `passed 2 FILE STEP`,
//! `ended 2 FILE`, `cancelled 2`.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;
use std::time::Duration;

use crate::store::Store;
use crate::{ErrorKind, JobError};

/// How many processes a step may end that do it alone.
const MOST_ALONE: usize = WAITS.len();

/// How long a step waits before it is done alone.
const WAITS: [Duration; 2] = [Duration::from_millis(200), Duration::from_secs(2)];

/// What earlier processes had begun, and the notes of this one.
pub(super) struct Begun<'a> {
    store: &'a Store,
    run: u64,
    /// Steps that the last process may have ended with, by file and number, and how long each waits.
    suspected: Vec<((usize, usize), Duration)>,
    /// Steps that processes ended with.
    passed_over: HashSet<(usize, usize)>,
}

impl<'a> Begun<'a> {
    /// Reads the notes in a store, and begins those of this process.
    pub(super) fn open(store: &'a Store) -> Result<Self, JobError> {
        let noted = |what: &str| -> Vec<Vec<u64>> {
            let numbers = |key: &str| key.strip_prefix(what)?.split(' ').map(|number| number.parse().ok()).collect();
            store.keys().filter_map(numbers).collect()
        };
        let runs: BTreeSet<u64> = noted("run ").into_iter().flatten().collect();
        let cancelled: HashSet<u64> = noted("cancelled ").into_iter().flatten().collect();
        let steps = |what| -> HashSet<[u64; 3]> {
            let of_killed = noted(what).into_iter().filter_map(|note| <[u64; 3]>::try_from(note).ok());
            of_killed.filter(|[run, ..]| !cancelled.contains(run)).collect()
        };
        let (begun, mut alone, passed) = (steps("begun "), steps("alone "), steps("passed "));
        let ended: HashSet<Vec<u64>> = noted("ended ").into_iter().collect();
        alone.retain(|note| !passed.contains(note));
        // The steps of a file are begun in their order, and the next one only when the last has ended.
        let mut last: BTreeMap<[u64; 2], u64> = BTreeMap::new();
        for [run, file, test] in begun.into_iter().filter(|[run, file, _]| !ended.contains(&vec![*run, *file])) {
            last.entry([run, file]).and_modify(|last| *last = test.max(*last)).or_insert(test);
        }
        let before = runs.last().copied().unwrap_or(0);
        let index = |[_, file, test]: [u64; 3]| {
            (usize::try_from(file).unwrap_or(usize::MAX), usize::try_from(test).unwrap_or(usize::MAX))
        };
        let in_company = last.into_iter().map(|([run, file], test)| [run, file, test]);
        let suspected: BTreeSet<(usize, usize)> =
            in_company.chain(alone.iter().copied()).filter(|[run, ..]| *run == before).map(index).collect();
        let mut times: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        alone.into_iter().for_each(|note| *times.entry(index(note)).or_default() += 1);
        let passed_over: HashSet<(usize, usize)> =
            times.iter().filter(|(_, times)| **times >= MOST_ALONE).map(|(step, _)| *step).collect();
        let wait = |step| Some((step, *WAITS.get(times.get(&step).copied().unwrap_or(0))?));
        let begun = Self {
            store,
            run: before + 1,
            suspected: suspected.into_iter().filter_map(wait).collect(),
            passed_over,
        };
        begun.note(&format!("run {}", begun.run))?;
        Ok(begun)
    }

    /// Steps to do alone, before all others.
    pub(super) fn suspected(&self) -> &[((usize, usize), Duration)] {
        &self.suspected
    }

    /// Notes that a step is done alone, or that it has ended.
    pub(super) fn alone(&self, (file, step): (usize, usize), has_ended: bool) -> Result<(), JobError> {
        let what = if has_ended { "passed" } else { "alone" };
        self.note(&format!("{what} {} {file} {step}", self.run))
    }

    /// Notes that a step of the file of a `name` is done; or why it is passed over.
    pub(super) fn begin(&self, file: usize, step: usize, name: &Path) -> Result<Option<JobError>, JobError> {
        if self.passed_over.contains(&(file, step)) {
            let message = format!("the process ended each of {} times that this test was analysed", MOST_ALONE + 1);
            let hint = "analyse the file alone to see why; the shard tries it again when it runs again".to_owned();
            return Ok(Some(JobError::new(ErrorKind::Ended, message, hint).of(name.display())));
        }
        self.note(&format!("begun {} {file} {step}", self.run))?;
        Ok(None)
    }

    /// Notes that a file is done.
    pub(super) fn end(&self, file: usize) -> Result<(), JobError> {
        self.note(&format!("ended {} {file}", self.run))
    }

    /// Notes that this process ends since it was to.
    pub(super) fn cancel(&self) -> Result<(), JobError> {
        self.note(&format!("cancelled {}", self.run))
    }

    fn note(&self, key: &str) -> Result<(), JobError> {
        self.store.add(key, b"").map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a process suspects and passes over, before `work` and a kill.
    fn process(folder: &Path, work: impl FnOnce(&Begun<'_>)) -> (Vec<(usize, usize)>, bool) {
        let store = Store::open(folder, "test", "d", false).unwrap();
        let begun = Begun::open(&store).unwrap();
        work(&begun);
        (begun.suspected().iter().map(|(step, _)| *step).collect(), !begun.passed_over.is_empty())
    }

    #[test]
    fn a_test_that_ends_its_process_three_times_is_passed_over_and_its_neighbour_is_not() {
        let folder = tempfile::tempdir().unwrap();
        // File 0 is done, file 1 ends the process in its third test, file 2 was begun beside it.
        let company = |begun: &Begun<'_>| {
            begun.begin(0, 0, Path::new("a")).unwrap();
            begun.end(0).unwrap();
            begun.begin(2, 0, Path::new("a")).unwrap();
            (0..3).for_each(|test| assert_eq!(begun.begin(1, test, Path::new("a")).unwrap(), None));
        };
        let alone = |begun: &Begun<'_>| {
            for (test, _) in begun.suspected().to_vec() {
                begun.alone(test, false).unwrap();
                if test == (1, 2) {
                    return;
                }
                begun.alone(test, true).unwrap();
            }
        };
        assert_eq!(process(folder.path(), company), (vec![], false));
        assert_eq!(process(folder.path(), alone), (vec![(1, 2), (2, 0)], false));
        assert_eq!(process(folder.path(), alone), (vec![(1, 2)], false));
        let (suspected, any) = process(folder.path(), |begun| {
            assert!(begun.begin(1, 2, Path::new("a")).unwrap().unwrap().message.contains("3 times"));
            assert_eq!(begun.begin(2, 0, Path::new("a")).unwrap(), None);
        });
        assert_eq!((suspected, any), (vec![], true));
    }

    #[test]
    fn a_process_that_was_cancelled_is_held_against_no_test() {
        let folder = tempfile::tempdir().unwrap();
        for _ in 0..5 {
            let found = process(folder.path(), |begun| {
                begun.begin(0, 0, Path::new("a")).unwrap();
                begun.cancel().unwrap();
            });
            assert_eq!(found, (vec![], false));
        }
    }
}
