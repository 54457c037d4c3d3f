//! `palpate sweep`: many runs of one protocol to one table.
//!
//! | file | what |
//! |---|---|
//! | `rows.rs` | what a run comes to |
//! | `compute.rs` | runs over threads |
//! | `parts.rs` | finished parts, kept for a restart |
//! | `chart.rs` | the table as a figure |

mod chart;
mod compute;
mod parts;
pub(crate) mod rows;

use std::fs::File;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use palpate_files::description::{Sweep, read_sweep};
use palpate_files::parquet_table::{TableError, TableReader, TableWriter};
use sha2::{Digest, Sha256};

use crate::arguments::SweepArguments;
use crate::failure::{Failure, Outcome};
use crate::files::{place_file, write_file};
use crate::terminal::note;
use chart::Chart;
use parts::{Parts, belong, folder_of, table_failure};
use rows::{fields, refusals};

/// Under which the table says what sweep it holds.
const MARK: &str = "palpate_sweep_sha256";

pub(crate) fn run(arguments: &SweepArguments) -> Result<Outcome, Failure> {
    let started = Instant::now();
    let path = &arguments.protocol;
    let sweep = read_sweep(path).map_err(|error| {
        let hint = error.hint();
        Failure::new(error, hint)
    })?;
    let out = out(arguments)?;
    let chart = arguments.figure.as_ref().map(|figure| Chart::new(&sweep, figure, &arguments.show)).transpose()?;
    let digest = digest(&sweep);
    let fields = fields(&sweep);
    let mut taken_over = sweep.runs();
    if arguments.restart || !is_complete(&out, &digest, sweep.runs()) {
        let mut parts = Parts::open(&out, &digest, fields.clone(), sweep.runs(), arguments.restart)?;
        taken_over = parts.runs_done();
        compute::compute(&sweep, path, &mut parts, threads(arguments))?;
        // In the folder of the parts, where the next sweep clears away what a kill leaves behind.
        place_file(&out, &folder_of(&out), |file| {
            let mut writer = TableWriter::new(file, &fields)?;
            parts.each(|rows| writer.write(rows))?;
            writer.finish(&[(MARK, &digest)])
        })
        .map_err(|error| table_failure(&out, &error))?;
        parts.remove()?;
    } else if belong(&out, &digest) {
        // Killed after the table was whole: only its parts are left over.
        Parts::open(&out, &digest, fields.clone(), sweep.runs(), false)?.remove()?;
    }
    if let Some(chart) = chart {
        let picture = chart.draw(&sweep, &out)?;
        write_file(&chart.path, &picture)?;
    }
    let refused = tell(&sweep, &out, taken_over, started)?;
    Ok(if refused == sweep.runs() { Outcome::Negative } else { Outcome::Done })
}

/// Where the table goes: beside nothing else, under the name of the protocol, if nothing is said.
fn out(arguments: &SweepArguments) -> Result<PathBuf, Failure> {
    let named = |out: &PathBuf| out.extension().is_some_and(|extension| extension == "parquet");
    match &arguments.out {
        Some(out) if !named(out) => Err(Failure::of_file(
            out,
            "expected a table ending in .parquet",
            Some("name the table FILE.parquet".to_owned()),
        )),
        Some(out) if out.is_dir() => Err(Failure::of_file(
            out,
            "expected a file to write the table to, found a directory",
            Some("choose another name with --out".to_owned()),
        )),
        Some(out) => Ok(out.clone()),
        None => {
            let mut name = arguments.protocol.file_stem().unwrap_or_default().to_owned();
            name.push(".parquet");
            Ok(PathBuf::from(name))
        }
    }
}

fn threads(arguments: &SweepArguments) -> usize {
    let all = || thread::available_parallelism().map_or(1, usize::from);
    arguments.threads.map_or_else(all, usize::from)
}

/// What the rows of a sweep depend on: the text of the protocol, and who computes them.
fn digest(sweep: &Sweep) -> String {
    let mut hasher = Sha256::new();
    hasher.update(format!("palpate {} sweep 1\n", env!("CARGO_PKG_VERSION")));
    hasher.update(sweep.text());
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Whether the table is there and holds all of this sweep.
fn is_complete(out: &Path, digest: &str, runs: u64) -> bool {
    let table = File::open(out).map_err(TableError::from).and_then(TableReader::new);
    table.is_ok_and(|table| table.mark(MARK) == Some(digest) && table.rows() == runs)
}

/// Says what was done, and returns how many runs were refused.
fn tell(sweep: &Sweep, out: &Path, taken_over: u64, started: Instant) -> Result<u64, Failure> {
    let read = || -> Result<(u64, Option<(i64, String)>), TableError> {
        let table = TableReader::new(File::open(out)?)?;
        let (mut count, mut first) = (0, None);
        for group in 0..table.groups() {
            let reasons = table.values(group, table.fields().len() - 1)?;
            let (more, reason) = refusals(&table.values(group, 0)?, &reasons);
            count += more;
            first = first.or(reason);
        }
        Ok((count, first))
    };
    let (refused, first) = read().map_err(|error| table_failure(out, &error))?;
    if let Some((run, reason)) = first {
        note(&format!("{refused} of {} runs refused, first run {run}: {reason}", sweep.runs()));
    }
    let from_before = match taken_over {
        0 => String::new(),
        all if all == sweep.runs() => ", all of them computed before".to_owned(),
        some => format!(", {some} of them computed before"),
    };
    let (runs, seconds) = (sweep.runs(), started.elapsed().as_secs_f64());
    note(&format!("{}: {runs} runs in {seconds:.1} s{from_before}", out.display()));
    Ok(refused)
}
