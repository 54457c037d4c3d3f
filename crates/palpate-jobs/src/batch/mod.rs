//! Many records to one table, a row per hold and law.
//!
//! | file | what |
//! |---|---|
//! | `answer.rs` | what was found over all holds |
//! | `map.rs` | curves that have a position |
//! | `rows.rs` | an analysed record as rows |
//! | `parameters.rs` | its parameters as rows of a tidy table |
//! | `failures.rs` | the tests without rows |
//! | `table.rs` | the rows as files |
//! | `begun.rs` | tests that end the process |
//! | `shard.rs` | one of several slices of the files |
//! | `merge.rs` | all slices as one table |

mod answer;
mod begun;
mod failures;
mod map;
mod merge;
mod parameters;
mod rows;
mod shard;
mod table;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use palpate::analysis::{AnalysisOptions, examine};
use palpate::fit::IntervalMethod;
use palpate::forecast::CompareOptions;
use palpate::laws::{ExponentChoice, Law};
use palpate::number::counted;
use palpate::segment::HoldStart;
use palpate::watch::{Progress, Watch};
use palpate_report::document::{AnalysisDocument, Software};
use palpate_report::table::CsvLocale;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::depends::BUILD;
use crate::input::{Described, NamedFile, NamedRecords, OpenedFile, Source};
use crate::output::{Stage, is_same, keep_apart, picture, sha256, stem};
use crate::shard::{Shard, Slice};
use crate::store::{Store, beside};
use crate::threads::{Share, over_threads};
use crate::written_by_batch::is_written_by_batch;
use crate::{ErrorKind, JobError, Outcome};
use answer::Tally;
pub use answer::{BatchAnswer, Spread};
use begun::Begun;
pub use map::CurveMap;
pub(crate) use merge::merge;
use table::{Format, Out};

/// Analyse many records into one table, one row per hold and law.
///
/// It reads the records and their description. Beside the table it writes the tidy table of all parameters (`holds_parameters.csv` beside
/// `holds.csv`), one row per parameter with its unit, standard error and interval, and the finished parts from which it can resume.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Batch {
    /// Laws to fit and compare in addition to the latency law, whose exponent is estimated in the comparison.
    #[schemars(with = "Option<Vec<String>>")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LAW,…", value_delimiter = ',', value_parser = crate::typed::law,
    ))]
    pub laws: Option<Vec<Law>>,
    /// Fit only this time from the start of each hold.
    #[cfg_attr(feature = "clap", arg(
        long = "fit-until", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
    ))]
    pub fit_until_s: Option<f64>,
    /// Method of the intervals: "automatic", "curvature", "profile", or "bootstrap" with its options.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::INTERVALS),
        help = "Method of the intervals; automatic if not given",
    ))]
    pub intervals: Option<IntervalMethod>,
    /// Start of the fit in a hold: "peak", "settled", or a time in seconds after the peak.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "WHERE", value_parser = palpate_files::description::parse_hold_start,
        help = "Start of the fit in a hold: peak, settled, or \"peak + 0.5 s\"",
    ))]
    pub hold_start: Option<HoldStart>,
    /// Number of records analysed in parallel; all processors if not given. The table does not depend on it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<NonZeroUsize>,
    /// Maps over the positions of the curves, each a name or NAME=FILE: a parameter of the law recommended for the first hold, or a column of
    /// the table; v, n and E stand for `rate_coefficient_per_s`, `exponent` and `loading_modulus_pa`. Without FILE a map goes beside the table.
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "NAME[=FILE]",
            help = "Map of a quantity over the positions of the curves (.svg, .png or .pdf; beside the table if no file is given): v, n, E, a parameter of the recommended law, or a column of the table; may be repeated",
        )
    )]
    pub map: Vec<String>,
    /// Language of the readers of CSV: it decides decimal sign and separator.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LANGUAGE", value_parser = crate::typed::one_of(crate::typed::CSV_LOCALES), default_value = "en",
    ))]
    pub csv_locale: CsvLocale,
    /// Analyse all records again, and ignore earlier results.
    #[cfg_attr(feature = "clap", arg(long))]
    pub restart: bool,
    /// Analyse only this of so many slices of the files, equal in bytes, into the folder that the table is named by; `palpate merge` makes
    /// one table of all.
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "K/N",
            help = "Analyse only slice K of N, equal in bytes, into the folder OUT that all slices share; palpate merge makes one table of them",
        )
    )]
    pub shard: Option<Shard>,
}

/// A table with a row per hold and law.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Batched {
    /// What was found, over all holds.
    pub answer: BatchAnswer,
    /// How many rows it has.
    pub rows: usize,
    /// Number of tests in the files.
    pub tests: usize,
    /// The tests without rows.
    pub failures: Vec<Refused>,
    /// The curves that have a position.
    pub map: CurveMap,
}

/// A test that could not be analysed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// The file.
    pub record: String,
    /// What the file calls the test, where it holds several.
    pub part: Option<String>,
    /// What is wrong, with the path.
    pub message: String,
    /// Remedy.
    pub hint: Option<String>,
}

/// A test of a file, analysed, with its rows of the table by the names of the columns; none where it was refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BatchedTest {
    /// Its number among the tests of the file, from 0.
    pub index: usize,
    /// What the file calls it.
    pub name: Option<String>,
    /// A row per hold and law, as the table has them.
    pub rows: Vec<serde_json::Map<String, Value>>,
    /// Why it has none.
    pub refused: Option<Refused>,
}

impl BatchedTest {
    /// The names of the columns, in the order of the table.
    #[must_use]
    pub fn columns() -> Vec<String> {
        rows::fields().into_iter().map(|field| field.name).collect()
    }
}

/// What came of one file.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Entry {
    /// Rows of the table.
    rows: Vec<Vec<Value>>,
    /// Rows of the table of parameters.
    parameters: Vec<Vec<Value>>,
    /// The tests that gave none, with why.
    failures: Vec<Refused>,
    /// How many tests those are.
    tests: usize,
    /// How many there are in the file.
    of: usize,
}

impl Batch {
    /// Analyses the records to the table `out`.
    ///
    /// # Errors
    /// [`JobError`] where the table cannot be written, or the watch ends it; what is done stays to go on from. A record that fails stops no
    /// other.
    pub fn run(&self, records: NamedRecords, out: &Path, watch: &mut dyn Watch) -> Result<Outcome<Batched>, JobError> {
        if let Some(shard) = self.shard {
            let slice = Slice::of(&records.files, [shard])?.remove(0);
            return self.run_slice(&slice, &records.described, out, watch);
        }
        let started = Instant::now();
        let NamedRecords { mut files, described } = records;
        let of_parameters = table::of_parameters(out);
        let maps: Vec<(&str, PathBuf)> =
            self.map.iter().map(|map| map::named(out, map)).collect::<Result<_, JobError>>()?;
        let drawn = || maps.iter().map(|(_, path)| path.as_path());
        keep_apart(&described.path, [out, &of_parameters].into_iter().chain(drawn()))?;
        keep_apart(files.iter().filter_map(NamedFile::path), drawn())?;
        let format = Format::of(out)?;
        let options = self.options(&described);
        if !is_written_by_batch(out) {
            keep_apart(files.iter().filter_map(NamedFile::path), [out])?;
        }
        let journal = beside(out, ".journal");
        // In the folder of the records they are no records.
        let is_ours = |path: &Path| {
            is_same(path, out)
                || is_same(path, &of_parameters)
                || path.parent().is_some_and(|folder| is_same(folder, &journal))
        };
        files.retain(|file| !file.path().is_some_and(is_ours));
        let settings = settings(&options, &described)?;
        let store = Store::open(&journal, "batch", &sha256(settings.as_bytes()), self.restart)?;
        let progress = Progress::counted("analysing", 0, files.len());
        let work = Work {
            described: &described,
            options: &options,
            store: &store,
            begun: None,
        };
        let done = over_threads(files.len(), self.threads, progress, watch, |index, share| {
            let done = work.file(index, &files[index], |count| 0..count, share)?;
            share.advance(1)?;
            Ok(done)
        })?;
        let written = Out::Tables(out, (format, self.csv_locale));
        let entries = done.iter().map(|done| entry(&store, &done.place));
        let batched = table::write(written, &settings, options.compare.is_some(), |take| {
            entries.into_iter().try_for_each(|entry| take(entry?))
        })?;
        // The table is there whatever the maps lack.
        batched.draw(&maps)?;
        let before = done.iter().filter(|done| done.was_before).count();
        let (all, notes) = (batched.failures.is_empty(), batched.notes(out, files.len(), before, started));
        Ok(Outcome::of(batched).answered(all).noted(notes))
    }

    /// Analyses every test of one file without writing a table: `take` gets each as soon as it is done, in the order of the file.
    ///
    /// # Errors
    /// [`JobError`] where the watch ends it. A test that fails stops no other.
    pub fn each_test(
        &self,
        opened: &OpenedFile<'_>,
        watch: &mut dyn Watch,
        mut take: impl FnMut(BatchedTest),
    ) -> Result<Batched, JobError> {
        let (options, fields) = (self.options(opened.described), rows::fields());
        let (mut map, mut tally, mut failures) = (CurveMap::default(), Tally::new(), Vec::new());
        let (mut count, total) = (0, opened.tests.parts.len());
        for (index, part) in opened.tests.parts.iter().enumerate() {
            watch.report(Progress::counted("analysing", index, total))?;
            let mut entry = Entry::default();
            entry.take(opened, *part, document(opened, *part, &options, watch))?;
            map.add(&entry);
            tally.add(&entry);
            count += entry.rows.len();
            failures.extend_from_slice(&entry.failures);
            let named = |row: Vec<Value>| fields.iter().map(|field| field.name.clone()).zip(row).collect();
            take(BatchedTest {
                index,
                name: opened.name(*part).map(str::to_owned),
                rows: entry.rows.into_iter().map(named).collect(),
                refused: entry.failures.pop(),
            });
        }
        watch.report(Progress::counted("analysing", total, total))?;
        Ok(Batched {
            answer: tally.answer(options.compare.is_some()),
            rows: count,
            tests: total,
            failures,
            map,
        })
    }

    fn options(&self, described: &Described) -> AnalysisOptions {
        let mut options = described.options();
        options.fit_until = self.fit_until_s.or(options.fit_until);
        options.fit.intervals = self.intervals.unwrap_or(options.fit.intervals);
        options.segment.hold_start = self.hold_start.unwrap_or(options.segment.hold_start);
        options.compare = self.laws.as_ref().map(|laws| {
            let latency = Law::Latency {
                exponent: ExponentChoice::Free,
            };
            // None are all, the latency law among them.
            let added = (!laws.is_empty() && !laws.contains(&latency)).then_some(latency);
            let laws = added.into_iter().chain(laws.iter().copied()).collect();
            let mut compare = CompareOptions {
                laws,
                ..CompareOptions::default()
            };
            compare.fit.intervals = options.fit.intervals;
            compare
        });
        options
    }
}

/// What the files of a batch are analysed with.
struct Work<'a> {
    described: &'a Described,
    options: &'a AnalysisOptions,
    store: &'a Store,
    /// Says which tests are passed over.
    begun: Option<Begun<'a>>,
}

/// A file that is done.
struct Done {
    /// Where its entry lies.
    place: Range<u64>,
    /// Whether that was there before.
    was_before: bool,
    digest: Option<String>,
    /// Whether the same would come of it again.
    is_lasting: bool,
}

impl Work<'_> {
    /// Analyses those of the tests of a file that `own` picks of so many.
    fn file(
        &self,
        index: usize,
        named: &NamedFile,
        own: impl Fn(usize) -> Range<usize>,
        mut share: Share<'_>,
    ) -> Result<Done, JobError> {
        let path = named.name();
        let begin = |step| self.begun.as_ref().map_or(Ok(None), |begun| begun.begin(index, step, path));
        let mut is_lasting = true;
        let source = begin(0)?.map_or_else(|| Source::open(named), Err);
        let digest = source.as_ref().ok().and_then(|source| source.digest.get(&mut share).ok());
        let key = format!("{} {}", digest.as_deref().unwrap_or("-"), path.display());
        if let Some(place) = self.store.find(&key).filter(|_| digest.is_some()) {
            self.end(index)?;
            return Ok(Done {
                place,
                was_before: true,
                digest,
                is_lasting,
            });
        }
        let mut entry = Entry::default();
        match source.and_then(|source| OpenedFile::of(source, self.described)) {
            Ok(opened) => {
                entry.of = opened.tests.parts.len();
                for test in own(entry.of) {
                    let part = opened.tests.parts[test];
                    let analyse = || document(&opened, part, self.options, &mut share);
                    let made = begin(test + 1)?.map_or_else(analyse, Err);
                    is_lasting &= entry.take(&opened, part, made)?;
                }
                entry.tests = own(entry.of).len();
            }
            Err(error) => {
                is_lasting = error.is_lasting();
                entry.of = 1;
                entry.tests = own(entry.of).len();
                if entry.tests > 0 {
                    entry.failures.push(Refused::new(path, None, error));
                }
            }
        }
        let key = if is_lasting { key } else { format!("- {}", path.display()) };
        let place = self.store.add(&key, &serde_json::to_vec(&entry)?)?;
        self.end(index)?;
        Ok(Done {
            place,
            was_before: false,
            digest,
            is_lasting,
        })
    }

    /// Notes that a file is done, where that is noted.
    fn end(&self, index: usize) -> Result<(), JobError> {
        self.begun.as_ref().map_or(Ok(()), |begun| begun.end(index))
    }
}

/// What came of a file, from its place in the store.
fn entry(store: &Store, place: &Range<u64>) -> Result<Entry, JobError> {
    serde_json::from_slice(&store.read(place)?).map_err(|error| store.damaged(&error))
}

fn document(
    opened: &OpenedFile<'_>,
    part: usize,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<AnalysisDocument, JobError> {
    let measured = opened.measurement(part, watch)?;
    let analysis = examine(&measured.record, options, watch)
        .map_err(|error| JobError::analysis(&error, &measured.input.called()))?;
    Ok(AnalysisDocument::new(&analysis, measured.input))
}

impl Entry {
    /// Takes what came of a test, and says whether that stays so.
    fn take(
        &mut self,
        opened: &OpenedFile<'_>,
        part: usize,
        made: Result<AnalysisDocument, JobError>,
    ) -> Result<bool, JobError> {
        match made {
            Ok(document) => {
                self.rows.extend(rows::rows(&document));
                self.parameters.extend(parameters::rows(&document));
                Ok(true)
            }
            Err(error) if error.kind == ErrorKind::Cancelled => Err(error),
            Err(error) => {
                let is_lasting = error.is_lasting();
                self.failures.push(Refused::new(&opened.contents.input.name, opened.name(part), error));
                Ok(is_lasting)
            }
        }
    }
}

impl Refused {
    fn new(record: &Path, part: Option<&str>, error: JobError) -> Self {
        Self {
            record: record.display().to_string(),
            part: part.map(str::to_owned),
            message: error.to_string(),
            hint: error.hint,
        }
    }
}

/// Everything that the results depend on besides the records, as text.
fn settings(options: &AnalysisOptions, described: &Described) -> Result<String, JobError> {
    let value = serde_json::json!({
        "software": Software::this(),
        "build": BUILD,
        "test": described.shown(),
        "test_toml": described.text,
        "options": serde_json::to_value(options)?,
    });
    Ok(value.to_string())
}

impl Batched {
    /// Draws maps into their files, all of them or none.
    fn draw(&self, maps: &[(&str, PathBuf)]) -> Result<(), JobError> {
        let mut stage = Stage::default();
        for (quantity, path) in maps {
            stage.bytes(path, &picture(path, &self.map.figure(quantity, &stem(path))?)?)?;
        }
        stage.commit()
    }

    /// Says what was done, and what could not be.
    fn notes(&self, out: &Path, files: usize, before: usize, started: Instant) -> Vec<String> {
        const MOST: usize = 1000;
        let failures = &self.failures;
        let mut notes: Vec<String> =
            failures.iter().take(MOST).map(|refused| format!("failed: {}", refused.message)).collect();
        if failures.len() > MOST {
            notes.push(format!("failed: … and {} more", failures.len() - MOST));
        }
        let mut hints: Vec<&str> = failures.iter().filter_map(|failed| failed.hint.as_deref()).collect();
        hints.sort_unstable();
        hints.dedup();
        if let [hint] = hints[..] {
            notes.push(format!("hint: {hint}"));
            if failures.len() < self.tests {
                // A description or an option for the files that failed would be one for the others too.
                notes.push("hint: options and descriptions apply to all files; run files that need others as a batch of their own".to_owned());
            }
        }
        let kept = if before > 0 { format!(" ({before} done before)") } else { String::new() };
        let failed = match failures.len() {
            0 => String::new(),
            count => format!(", {count} of {} tests failed", self.tests),
        };
        notes.push(format!(
            "{} of {} in {}{kept}{failed}, {:.1} s: {}",
            counted(self.rows, "row"),
            counted(self.tests - failures.len(), "test"),
            counted(files, "file"),
            started.elapsed().as_secs_f64(),
            out.display()
        ));
        notes
    }
}
