//! Many runs of one protocol to one table.
//!
//! | file | what |
//! |---|---|
//! | `rows.rs` | what a run comes to |
//! | `chart.rs` | the table as a figure |
//! | `shard.rs` | one of several slices of the runs, and all slices as one table |

mod chart;
mod rows;
mod shard;

use std::fs::File;
use std::io::Write;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use palpate::watch::{Progress, Watch};
use palpate_files::description::{Sweep as SweptProtocol, read_sweep};
use palpate_files::parquet_table::{Field, Rows, TableError, TableReader, TableWriter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use rows::{fields as sweep_fields, simulated as sweep_rows};
pub(crate) use shard::merge;

use crate::depends::Dependencies;
use crate::output::{
    Stage, StagedFile, check_ending, check_no_folder, keep_apart, remove_left_beside, unwritten_table, write_file,
};
use crate::shard::Shard;
use crate::store::{Store, beside, depends_on};
use crate::threads::over_threads;
use crate::{JobError, Outcome};
use chart::Chart;
use rows::refusals;

/// Simulate a protocol for many values of its parameters and write one table.
///
/// It reads the protocol, and writes the table, the figure and, until the table is complete, its finished parts beside it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Sweep {
    /// Result to draw in the figure, by the name of its column.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "COLUMN", default_value_t = Sweep::default().show, requires = "figure",
    ))]
    pub show: String,
    /// Number of runs in parallel; all processors if not given. The table does not depend on it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<NonZeroUsize>,
    /// Compute all runs again, and ignore earlier results.
    #[cfg_attr(feature = "clap", arg(long))]
    pub restart: bool,
    /// Compute only this of so many slices of the runs, into the folder that the table is named by; `palpate merge` makes one table of all.
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "K/N",
            help = "Compute only slice K of N of the runs, into the folder OUT that all slices share; palpate merge makes one table of them",
        )
    )]
    pub shard: Option<Shard>,
}

impl Default for Sweep {
    fn default() -> Self {
        Self {
            show: "peak_force_n".to_owned(),
            threads: None,
            restart: false,
            shard: None,
        }
    }
}

/// A table with a row a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Swept {
    /// The table.
    pub table: PathBuf,
    /// How many runs it holds.
    pub runs: u64,
    /// How many of them were refused.
    pub refused: u64,
    /// How many of them were computed before.
    pub computed_before: u64,
}

/// Under which the table says what sweep it holds.
pub(crate) const MARK: &str = "palpate_sweep_sha256";

impl Sweep {
    /// Simulates the runs of the protocol at `path` to the table `out`; one named as the protocol in the folder at hand if none is given.
    ///
    /// # Errors
    /// [`JobError`] where the protocol has no sweep, a file cannot be written, or the watch ends it; finished parts stay to go on from.
    pub fn run(
        &self,
        path: &Path,
        out: Option<&Path>,
        figure: Option<&Path>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Swept>, JobError> {
        keep_apart([path], out.into_iter().chain(figure))?;
        self.run_protocol(&read_sweep(path)?, path, out, figure, watch)
    }

    /// Likewise, the runs of a protocol that was read already; `place` names it in messages, and the table if no other name is given.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn run_protocol(
        &self,
        sweep: &SweptProtocol,
        place: &Path,
        out: Option<&Path>,
        figure: Option<&Path>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Swept>, JobError> {
        if let Some(shard) = self.shard {
            return self.run_slice(sweep, place, shard, out, figure, watch);
        }
        let started = Instant::now();
        let out = table_of(place, out)?;
        let chart = figure.map(|figure| Chart::new(sweep, figure, &self.show)).transpose()?;
        let computed_before = self.table(sweep, place, &out, watch)?;
        if let Some(chart) = chart {
            write_file(&chart.path, &chart.draw(sweep, &out)?)?;
        }
        Swept::of(out, sweep.runs, computed_before, started)
    }

    /// Makes the table, unless it is there, and returns how many of its runs were computed before.
    fn table(&self, sweep: &SweptProtocol, path: &Path, out: &Path, watch: &mut dyn Watch) -> Result<u64, JobError> {
        let digest = digest(sweep)?;
        let folder = beside(out, ".parts");
        let found = depends_on(&folder);
        if !self.restart && is_complete(out, &digest, sweep.runs) {
            if folder.is_dir() && found.is_none_or(|found| found == digest) {
                // Killed after the table was whole: only its parts remain, or some of what was removed.
                Store::open(&folder, "sweep", &digest, false)?.remove()?;
            }
            remove_left_beside(out);
            return Ok(sweep.runs);
        }
        if !self.restart && found.is_some_and(|found| found != digest) {
            return Err(JobError::option(
                "expected parts of this sweep, found those of another: the protocol, its material or the build of palpate has changed",
                "compute all runs with ⟨restart⟩, or name another table with ⟨out⟩",
            )
            .of(folder.display()));
        }
        let store = Store::open(&folder, "sweep", &digest, self.restart)?;
        let parts = Parts {
            sweep,
            path,
            store: &store,
        };
        let (places, done) = parts.computed(0..parts.count(), self.threads, watch)?;
        let mut stage = Stage::default();
        let table = parts.written(&mut stage, out, &places, &[(MARK, &digest)])?;
        stage.take(table)?;
        stage.commit()?;
        store.remove()?;
        Ok(done)
    }
}

/// The parts that the runs of a sweep are computed in, and the store that keeps them.
struct Parts<'a> {
    sweep: &'a SweptProtocol,
    path: &'a Path,
    store: &'a Store,
}

impl Parts<'_> {
    fn count(&self) -> u64 {
        self.sweep.runs.div_ceil(part_size(self.sweep.runs))
    }

    /// The runs of a part.
    fn runs(&self, part: u64) -> Range<u64> {
        let (runs, size) = (self.sweep.runs, part_size(self.sweep.runs));
        part * size..runs.min((part + 1) * size)
    }

    /// Computes parts that are not there yet. Where all of them lie, and how many of their runs were there.
    fn computed(
        &self,
        parts: Range<u64>,
        threads: Option<NonZeroUsize>,
        watch: &mut dyn Watch,
    ) -> Result<(Vec<Range<u64>>, u64), JobError> {
        let length = |part: u64| self.runs(part).end - self.runs(part).start;
        let is_there = |part: &u64| self.store.find(&part.to_string()).is_some();
        let done: u64 = parts.clone().filter(is_there).map(length).sum();
        let fields = sweep_fields(self.sweep);
        let progress = Progress {
            task: "simulating",
            done,
            total: Some(parts.clone().map(length).sum()),
        };
        let count = usize::try_from(parts.end - parts.start).unwrap_or(usize::MAX);
        // Each part is the work of one thread, so that its bytes do not depend on how many there are.
        let places = over_threads(count, threads, progress, watch, |index, share| {
            let part = parts.start + index as u64;
            let key = part.to_string();
            if let Some(place) = self.store.find(&key) {
                return Ok(place);
            }
            let mut watch = |_: Progress<'_>| share.advance(1);
            let (rows, _) = sweep_rows(self.sweep, self.path, self.runs(part), &[], &mut watch)?;
            self.store.add(&key, &packed(&fields, rows).map_err(|error| unwritten_table(self.path, &error))?)
        })?;
        Ok((places, done))
    }

    /// Writes parts as one table that is to appear at `out`.
    fn written(
        &self,
        stage: &mut Stage,
        out: &Path,
        places: &[Range<u64>],
        marks: &[(&str, &str)],
    ) -> Result<StagedFile, JobError> {
        let refused = |error: TableError| unwritten_table(out, &error);
        let mut file = stage.open(out)?;
        let mut writer = TableWriter::new(&mut file, &sweep_fields(self.sweep)).map_err(refused)?;
        for place in places {
            unpacked(&self.store.read(place)?, |rows| writer.write(rows)).map_err(|error| match error {
                TableError::Io(_) => refused(error),
                error => self.store.damaged(&error),
            })?;
        }
        writer.finish(marks).map_err(refused)?;
        Ok(file)
    }
}

impl Swept {
    /// The table at `out`, with what to know of it.
    fn of(out: PathBuf, runs: u64, computed_before: u64, started: Instant) -> Result<Outcome<Self>, JobError> {
        let counted = File::open(&out).map_err(TableError::from).and_then(refused);
        let (refused, first) = counted.map_err(|error| unwritten_table(&out, &error))?;
        let first = first.map(|(run, reason)| format!("{refused} of {runs} runs refused, first run {run}: {reason}"));
        let before = match computed_before {
            0 => String::new(),
            all if all == runs => ", all computed before".to_owned(),
            some => format!(", {some} computed before"),
        };
        let seconds = started.elapsed().as_secs_f64();
        let done = format!("{}: {runs} runs in {seconds:.1} s{before}", out.display());
        let result = Self {
            table: out,
            runs,
            refused,
            computed_before,
        };
        Ok(Outcome::of(result).answered(refused != runs).noted(first.into_iter().chain([done]).collect()))
    }
}

/// Rows as the bytes of a table.
fn packed(fields: &[Field], rows: Rows) -> Result<Vec<u8>, TableError> {
    let mut bytes = Vec::new();
    let mut writer = TableWriter::new(&mut bytes, fields)?;
    writer.write(rows)?;
    writer.finish(&[])?;
    Ok(bytes)
}

/// Hands on the rows of such a table.
fn unpacked(bytes: &[u8], mut take: impl FnMut(Rows) -> Result<(), TableError>) -> Result<(), TableError> {
    let mut file = tempfile::tempfile()?;
    file.write_all(bytes)?;
    let table = TableReader::new(file)?;
    (0..table.groups()).try_for_each(|group| take(table.read(group)?))
}

/// Where the table goes: beside nothing else, under the name of the protocol, if nothing is stated.
fn table_of(protocol: &Path, out: Option<&Path>) -> Result<PathBuf, JobError> {
    let usual = || beside(Path::new(protocol.file_stem().unwrap_or_default()), ".parquet");
    let out = out.map_or_else(usual, Path::to_owned);
    check_ending(&out, &["parquet"], "a table ending in .parquet", "name the table FILE.parquet")?;
    check_no_folder(&out)?;
    Ok(out)
}

/// What the rows of a sweep depend on: the texts of the protocol and of the material that it names, and the build that computes them.
fn digest(sweep: &SweptProtocol) -> Result<String, JobError> {
    let material = sweep.material.as_deref();
    Dependencies::new("sweep", &())
        .text("protocol", Some(&sweep.text))
        .text("material", material)
        .sha256()
}

/// Whether the table is there and holds all of this sweep.
fn is_complete(out: &Path, digest: &str, runs: u64) -> bool {
    let table = File::open(out).map_err(TableError::from).and_then(TableReader::new);
    table.is_ok_and(|table| table.mark(MARK) == Some(digest) && table.rows() == runs)
}

/// How many runs of a table were refused, and the number and reason of the first that was.
fn refused(table: File) -> Result<(u64, Option<(i64, String)>), TableError> {
    let table = TableReader::new(table)?;
    let (mut count, mut first) = (0, None);
    for group in 0..table.groups() {
        let reasons = table.values(group, table.fields().len() - 1)?;
        let (more, reason) = refusals(&table.values(group, 0)?, &reasons);
        count += more;
        first = first.or(reason);
    }
    Ok((count, first))
}

/// Runs of a part: about a thousand parts, none of them too small to be worth a file or too large to be lost.
fn part_size(runs: u64) -> u64 {
    (runs / 1024).next_power_of_two().clamp(16, 8192)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_neither_tiny_nor_huge() {
        let sizes = [1, 450, 100_000, 1_000_000, 10_000_000].map(part_size);
        assert_eq!(sizes, [16, 16, 128, 1024, 8192]);
    }
}
