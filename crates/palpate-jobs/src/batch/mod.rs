//! Many records to one table, a row per hold and law.
//!
//! | file | what |
//! |---|---|
//! | `answer.rs` | what was found over all holds |
//! | `map.rs` | curves that have a position |
//! | `rows.rs` | an analysed record as rows |
//! | `parameters.rs` | its parameters as rows of a tidy table |
//! | `table.rs` | the rows as files |

mod answer;
mod map;
mod parameters;
mod rows;
mod table;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use palpate::analysis::{AnalysisOptions, examine};
use palpate::fit::IntervalMethod;
use palpate::forecast::CompareOptions;
use palpate::laws::Law;
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
use crate::store::{Store, beside};
use crate::threads::{Share, over_threads};
use crate::written_by_batch::is_written_by_batch;
use crate::{ErrorKind, JobError, Outcome};
use answer::Tally;
pub use answer::{BatchAnswer, Spread};
pub use map::CurveMap;
use table::Format;

/// Analyse many records into one table, one row per hold and law.
///
/// It reads the records and their description. Beside the table it writes the tidy table of all parameters (`holds_parameters.csv` beside
/// `holds.csv`), one row per parameter with its unit, standard error and interval, and the finished parts from which it can resume.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Batch {
    /// Laws to fit in addition to the latency law.
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
    /// How many tests there are in the file.
    tests: usize,
}

impl Batch {
    /// Analyses the records to the table `out`.
    ///
    /// # Errors
    /// [`JobError`] where the table cannot be written, or the watch ends it; what is done stays to go on from. A record that fails stops no
    /// other.
    pub fn run(&self, records: NamedRecords, out: &Path, watch: &mut dyn Watch) -> Result<Outcome<Batched>, JobError> {
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
        let places = over_threads(files.len(), self.threads, progress, watch, |index, share| {
            let place = file(&files[index], &described, &options, &store, share)?;
            share.advance(1)?;
            Ok(place)
        })?;
        let how = (settings.as_str(), options.compare.is_some());
        let batched = table::write(out, (format, self.csv_locale), &store, places.iter().map(|(place, _)| place), how)?;
        // The table is there whatever the maps lack.
        let mut stage = Stage::default();
        for (quantity, path) in &maps {
            stage.bytes(path, &picture(path, &batched.map.figure(quantity, &stem(path))?)?)?;
        }
        stage.commit()?;
        let before = places.iter().filter(|(_, before)| *before).count();
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
            entry.take(document(opened, *part, &options, watch))?;
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
            let laws = laws.clone();
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

/// Where the entry of a file lies, and whether it was there before.
fn file(
    named: &NamedFile,
    described: &Described,
    options: &AnalysisOptions,
    store: &Store,
    mut share: Share<'_>,
) -> Result<(Range<u64>, bool), JobError> {
    let (path, source) = (named.name(), Source::open(named));
    let digest = source.as_ref().ok().and_then(|source| source.digest.get(&mut share).ok());
    let key = format!("{} {}", digest.as_deref().unwrap_or("-"), path.display());
    if let Some(place) = store.find(&key).filter(|_| digest.is_some()) {
        return Ok((place, true));
    }
    let (mut entry, mut is_lasting) = (Entry::default(), true);
    match source.and_then(|source| OpenedFile::of(source, described)) {
        Ok(opened) => {
            entry.tests = opened.tests.parts.len();
            for part in &opened.tests.parts {
                is_lasting &= entry.take(document(&opened, *part, options, &mut share))?;
            }
        }
        Err(error) => {
            is_lasting &= !matches!(error.kind, ErrorKind::File(_));
            entry.tests = 1;
            entry.failures.push(Refused::from(error));
        }
    }
    let key = if is_lasting { key } else { format!("- {}", path.display()) };
    Ok((store.add(&key, &serde_json::to_vec(&entry)?)?, false))
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
    /// Takes what came of a test, and says whether that stays so: what the operating system refused once it may give the next time.
    fn take(&mut self, made: Result<AnalysisDocument, JobError>) -> Result<bool, JobError> {
        match made {
            Ok(document) => {
                self.rows.extend(rows::rows(&document));
                self.parameters.extend(parameters::rows(&document));
                Ok(true)
            }
            Err(error) if error.kind == ErrorKind::Cancelled => Err(error),
            Err(error) => {
                let is_lasting = !matches!(error.kind, ErrorKind::File(_));
                self.failures.push(Refused::from(error));
                Ok(is_lasting)
            }
        }
    }
}

impl From<JobError> for Refused {
    fn from(error: JobError) -> Self {
        Self {
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
