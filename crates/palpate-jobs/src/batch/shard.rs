//! One of several slices of the files of a batch.

use std::collections::BTreeMap;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use palpate::watch::{Progress, Watch};
use palpate_report::table::CsvLocale;
use sha2::{Digest, Sha256};

use super::begun::Begun;
use super::table::{self, Out};
use super::{Batch, Batched, Done, Work, document, entry, merge, settings};
use crate::input::{Described, NamedFile, OpenedFile, Source};
use crate::output::{hexadecimal, sha256};
use crate::shard::{Cut, Manifest, Places, Slice, finished};
use crate::store::Store;
use crate::threads::over_threads;
use crate::{ErrorKind, JobError, Outcome};

impl Batch {
    /// Analyses the records of one slice into the folder `out` of all slices: its tables, and at last the manifest that says what they
    /// depend on. A slice that is finished, of the same files, options and version, is not analysed again.
    ///
    /// # Errors
    /// [`JobError`] where the tables cannot be written, maps are wanted of a slice, or the watch ends it; what is done stays to go on from.
    pub fn run_slice(
        &self,
        slice: &Slice,
        described: &Described,
        out: &Path,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Batched>, JobError> {
        let started = Instant::now();
        if !self.map.is_empty() {
            let message = "expected no map of a shard: a map shows the curves of all";
            return Err(JobError::option(message, "ask `palpate merge` for it: ⟨map⟩"));
        }
        if self.csv_locale != CsvLocale::default() {
            let message = "expected no ⟨csv_locale⟩ of a shard: its tables are Parquet";
            return Err(JobError::option(message, "ask `palpate merge` for it"));
        }
        let places = Places::new(out, slice.shard)?;
        places.check_job("batch")?;
        let options = self.options(described);
        let settings = settings(&options, described)?;
        let depends = format!("{settings} {} {}", slice.plan_sha256, slice.shard);
        let store = Store::open(&places.journal(), "batch", &sha256(depends.as_bytes()), self.restart)?;
        let manifest = Manifest {
            job: "batch".to_owned(),
            shard: slice.shard,
            settings,
            plan_sha256: slice.plan_sha256.clone(),
            total: slice.total as u64,
            inputs_sha256: None,
            tests: 0,
            rows: 0,
            failed: 0,
            compared: options.compare.is_some(),
            is_lasting: true,
            start: None,
            end: None,
            tables: BTreeMap::new(),
        };
        if !self.restart
            && let Some(found) = finished(places)
            && manifest.is_of_same(&found)
            && found.inputs_sha256 == inputs(&digests(&slice.files, watch)?)
        {
            store.remove()?;
            let mut batched =
                table::write(Out::Nowhere, &found.settings, found.compared, |take| merge::each(places, take))?;
            batched.tests = found.tests;
            return Ok(batched.of_slice(slice, out, slice.files.len(), started));
        }
        let work = Work {
            described,
            options: &options,
            store: &store,
            begun: Some(Begun::open(&store)?),
        };
        let done = work.slice(slice, self, watch);
        if let (Err(error), Some(begun)) = (&done, &work.begun)
            && error.kind == ErrorKind::Cancelled
        {
            begun.cancel()?;
        }
        let done = done?;
        let manifest = manifest.with(slice, &done, &store)?;
        let (settings, compared) = (manifest.settings.clone(), manifest.compared);
        let entries = done.iter().map(|done| entry(&store, &done.place));
        let written = Out::Slice(places, Box::new(manifest));
        let batched =
            table::write(written, &settings, compared, |take| entries.into_iter().try_for_each(|entry| take(entry?)))?;
        drop(work);
        store.remove()?;
        let before = done.iter().filter(|done| done.was_before).count();
        Ok(batched.of_slice(slice, out, before, started))
    }
}

impl Work<'_> {
    /// Analyses the files of a slice; first, each alone, those tests that an earlier process may have ended with.
    fn slice(&self, slice: &Slice, batch: &Batch, watch: &mut dyn Watch) -> Result<Vec<Done>, JobError> {
        if let Some(begun) = &self.begun {
            for ((index, step), wait) in begun.suspected() {
                waited(*wait, watch)?;
                begun.alone((*index, *step), false)?;
                self.alone(slice.files.get(*index), *step, watch)?;
                begun.alone((*index, *step), true)?;
            }
        }
        let progress = Progress::counted("analysing", 0, slice.files.len());
        over_threads(slice.files.len(), batch.threads, progress, watch, |index, share| {
            let done = self.file(index, &slice.files[index], |count| slice.tests(index, count), share)?;
            share.advance(1)?;
            Ok(done)
        })
    }

    /// Does a step of a file for what it does to this process; what comes of it is found again in its turn.
    fn alone(&self, file: Option<&NamedFile>, step: usize, watch: &mut dyn Watch) -> Result<(), JobError> {
        let opened = file.map(|file| OpenedFile::named(file, self.described));
        let Some(Ok(opened)) = opened else { return Ok(()) };
        let part = step.checked_sub(1).and_then(|test| opened.tests.parts.get(test));
        let made = part.map(|part| document(&opened, *part, self.options, watch).map(drop));
        match made {
            Some(Err(error)) if error.kind == ErrorKind::Cancelled => Err(error),
            _ => Ok(()),
        }
    }
}

/// Waits, unless the watch ends it.
fn waited(wait: Duration, watch: &mut dyn Watch) -> Result<(), JobError> {
    const LOOK: Duration = Duration::from_millis(20);
    let end = Instant::now() + wait;
    while Instant::now() < end {
        watch.report(Progress::open("waiting after a process that ended", 0))?;
        sleep(LOOK);
    }
    Ok(())
}

/// The names of files with their digests, `None` of one that cannot be read.
fn digests(files: &[NamedFile], watch: &mut dyn Watch) -> Result<Vec<Option<(String, String)>>, JobError> {
    let mut digests = Vec::with_capacity(files.len());
    for (index, file) in files.iter().enumerate() {
        watch.report(Progress::counted("digesting", index, files.len()))?;
        let digest = Source::open(file).and_then(|source| source.digest.get(watch)).ok();
        digests.push(digest.map(|digest| (file.name().display().to_string(), digest)));
    }
    Ok(digests)
}

/// The digest of all of them; none where one could not be read.
fn inputs(digests: &[Option<(String, String)>]) -> Option<String> {
    let mut all = Sha256::new();
    for digest in digests {
        let (name, sha256) = digest.as_ref()?;
        all.update(format!("{sha256} {name}\n"));
    }
    Some(hexadecimal(all.finalize()))
}

impl Manifest {
    /// Whether tables with another manifest depend on the same, but for the content of the files, and would be made so again.
    fn is_of_same(&self, found: &Self) -> bool {
        found.is_lasting
            && found.inputs_sha256.is_some()
            && (&found.job, found.shard, &found.settings) == (&self.job, self.shard, &self.settings)
            && (&found.plan_sha256, found.total) == (&self.plan_sha256, self.total)
    }

    /// The same of a slice whose files are done.
    fn with(mut self, slice: &Slice, done: &[Done], store: &Store) -> Result<Self, JobError> {
        let named = |(file, done): (&NamedFile, &Done)| Some((file.name().display().to_string(), done.digest.clone()?));
        let digests: Vec<Option<(String, String)>> = slice.files.iter().zip(done).map(named).collect();
        self.inputs_sha256 = inputs(&digests);
        self.is_lasting = done.iter().all(|done| done.is_lasting);
        let cut = |index: usize, is_end: bool| -> Result<Cut, JobError> {
            let tests = entry(store, &done[index].place)?.of;
            let own = slice.tests(index, tests);
            Ok(Cut {
                file: slice.first + index,
                sha256: done[index].digest.clone(),
                tests,
                at: if is_end { own.end } else { own.start },
            })
        };
        let [at_start, at_end] = slice.divides();
        self.start = at_start.then(|| cut(0, false)).transpose()?;
        self.end = at_end.then(|| cut(done.len() - 1, true)).transpose()?;
        Ok(self)
    }
}

impl Batched {
    /// What came of a slice: it is done whatever tests have failed, which all slices together are judged by.
    fn of_slice(self, slice: &Slice, out: &Path, before: usize, started: Instant) -> Outcome<Self> {
        let mut notes = self.notes(out, slice.files.len(), before, started);
        if let Some(last) = notes.last_mut() {
            *last = format!("shard {}: {last}", slice.shard);
        }
        Outcome::of(self).noted(notes)
    }
}
